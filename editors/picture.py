"""Draws how an editor shows a domain with mistakes in it: `python editors/picture.py OUT.svg`.

Colours are those of the Pygments lexer, the waves those of `icarus check`: nothing is made up.
"""  # noqa: INP001 - a script, no package

from __future__ import annotations

import sys
from html import escape
from itertools import count
from pathlib import Path

from pygments.styles import get_style_by_name

from icarus_lite.language import Diagnostic, Severity, diagnose_text
from icarus_lite.language.highlighting import IcarusLexer

TEXT = """\
; What the hand can take, and what takes it.
(percepts
  (object ^type ^x ^y ^z)
  (hand ^x ^y ^z ^reach))

(concepts
  ; ?any occurs only inside the not: there is none.
  ((free ?hand)
   :elements ((hand ?hand) (not (holding ?hand ?any))))
  ((near ?a ?b)
   :elements ((object ?a ^x ?xa) (object ?b ^x ?xb ^y ?yb))
   :tests ((< (distanse ?xa ?xb) 0.05)))
  ((in-reach ?hand ?obj)
   :percepts ((hand ?hand ^reech ?reach) (object ?obj ^z ?z))
   :tests ((< ?z ?reach))))

(skills
  ((pick-up ?hand ?obj)
   :elements ((free ?hand) (in-reech ?hand ?obj))
   :actions ((*grasp ?hand ?obj))
   :effects ((holding ?hand ?obj))
   :timeout 60))

(task 1.1 "Hold the cover" :robot ur5 :goal ((holding ?hand hubcover)))
"""

PATH = "cell.icr"
CELL_WIDTH, LINE_HEIGHT, FONT_SIZE = 8.4, 19.0, 14
FONTS = "DejaVu Sans Mono, Menlo, Consolas, monospace"
LEFT, TOP = 58.0, 60.0
WIDTH = 940
BACKGROUND, PANEL, FAINT, PLAIN = "#1e1f26", "#17181d", "#6b7080", "#c8ccd4"
SEVERITY_COLOURS = {
    Severity.ERROR: "#f0606a",
    Severity.WARNING: "#e0b050",
    Severity.NOTE: "#5aa6e8",
}


def picture() -> str:
    """Give the drawing as SVG."""
    _, _, found = diagnose_text(TEXT, PATH)
    lines = TEXT.split("\n")[:-1]
    bottom = TOP + len(lines) * LINE_HEIGHT + 14
    height = bottom + (len(found) + 1.6) * LINE_HEIGHT + 8
    parts = [
        (
            f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height:.0f}" '
            f'width="{WIDTH}" height="{height:.0f}" font-family="{FONTS}">'
        ),
        f'<rect width="{WIDTH}" height="{height:.0f}" rx="8" fill="{BACKGROUND}"/>',
        f'<path d="M0 34V8Q0 0 8 0H{WIDTH - 8}Q{WIDTH} 0 {WIDTH} 8V34Z" fill="{PANEL}"/>',
        f'<path d="M0 34V8Q0 0 8 0H116V34Z" fill="{BACKGROUND}"/>',
        text(18, 21, PATH, PLAIN),
        *numbers(len(lines)),
        *code(),
        *(wave(each) for each in found),
        (
            f'<rect y="{bottom:.1f}" width="{WIDTH}" height="{height - bottom:.1f}" rx="8" '
            f'fill="{PANEL}"/>'
        ),
        text(18, bottom + 21, "PROBLEMS", FAINT),
        *problems(found, bottom + 2.4 * LINE_HEIGHT),
        "</svg>",
    ]
    return "\n".join(parts) + "\n"


def code() -> list[str]:
    """Draw the coloured text."""
    style = get_style_by_name("one-dark")
    drawn: list[str] = []
    line, column = 0, 0
    for _, kind, piece in IcarusLexer().get_tokens_unprocessed(TEXT):
        for row in piece.splitlines(keepends=True):
            shown = row.rstrip("\n")
            if shown.strip():
                look = style.style_for_token(kind)
                colour = f"#{look['color']}" if look["color"] else PLAIN
                place = x_of(column), TOP + line * LINE_HEIGHT
                drawn.append(text(*place, shown, colour, italic=look["italic"]))
            column += len(row)
            if row.endswith("\n"):
                line, column = line + 1, 0
    return drawn


def wave(found: Diagnostic) -> str:
    """Draw the wave under what a diagnostic is about."""
    span = found.span
    start = x_of(span.column - 1)
    stop = x_of(span.end_column - 1 if span.end_line == span.line else len(line_of(span.line)))
    y = TOP + (span.line - 1) * LINE_HEIGHT + 4.5
    points, up = [], False
    for step in count():
        x = start + 3 * step
        if x > stop:
            break
        points.append(f"{x:.1f},{y - 1.5 if up else y + 1.5:.1f}")
        up = not up
    colour = SEVERITY_COLOURS[found.severity]
    return f'<polyline points="{" ".join(points)}" fill="none" stroke="{colour}"/>'


def problems(found: tuple[Diagnostic, ...], top: float) -> list[str]:
    """Write what the diagnostics say."""
    drawn = []
    for row, each in enumerate(found):
        y = top + row * LINE_HEIGHT
        colour = SEVERITY_COLOURS[each.severity]
        place = f"{each.span.line}:{each.span.column}"
        drawn.append(f'<circle cx="25" cy="{y - 5:.1f}" r="4.5" fill="{colour}"/>')
        drawn.append(text(40, y, f"{each.message}  ", PLAIN, size=12))
        after = 40 + (len(each.message) + 2) * CELL_WIDTH * 12 / FONT_SIZE
        hint, question, _ = each.hint.partition("? ")
        hint = f"{hint}{question.strip()}  " if len(each.message) + len(hint) < 100 else ""
        drawn.append(text(after, y, f"{hint}{each.code} [{place}]", FAINT, size=12))
    return drawn


def numbers(last: int) -> list[str]:
    """Write the line numbers."""
    return [
        text(LEFT - 20 - CELL_WIDTH * len(str(n)), TOP + (n - 1) * LINE_HEIGHT, str(n), FAINT)
        for n in range(1, last + 1)
    ]


def text(
    x: float, y: float, words: str, colour: str, *, italic: bool = False, size: int = FONT_SIZE
) -> str:
    """Write words at a place, as wide as the editor's cells are."""
    length = len(words) * CELL_WIDTH * size / FONT_SIZE
    slant = ' font-style="italic"' if italic else ""
    return (
        f'<text x="{x:.1f}" y="{y:.1f}" fill="{colour}" font-size="{size}"{slant} '
        f'textLength="{length:.1f}" xml:space="preserve">{escape(words)}</text>'
    )


def x_of(column: int) -> float:
    """Give the place of a column, counted from 0."""
    return LEFT + column * CELL_WIDTH


def line_of(line: int) -> str:
    """Give a line of the text, counted from 1."""
    return TEXT.split("\n")[line - 1]


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(picture(), encoding="utf-8")
