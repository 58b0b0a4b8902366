"""The figures of the page, as SVG."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, field
from html import escape
from typing import Final

from gearbox.rows import Ending, Row
from gearbox.statistics import Rate
from gearbox.trials import TASKS

COLOURS: Final = {
    Ending.ACHIEVED: "#1b7f79",
    Ending.RECOVERED: "#7cc4bd",
    Ending.FAILED: "#c9c4b8",
    Ending.UNAWARE: "#e2b13c",
    Ending.MISNAMED: "#e07b39",
    Ending.FALSE: "#c0392b",
    Ending.BROKEN: "#5b2c6f",
}
_WITH, _WITHOUT = "#1b7f79", "#b0aa9d"
_INK, _GRID = "#333333", "#dddddd"
_LEFT, _WIDTH, _RIGHT = 190, 460, 110
_FONT: Final = "font-family='DejaVu Sans, Helvetica, Arial, sans-serif'"


@dataclass(slots=True)
class Drawing:
    """An SVG that grows downwards.

    Args:
        title: Read out by screen readers.
    """

    title: str
    parts: list[str] = field(default_factory=list)
    height: float = 16.0

    def text(self, x: float, y: float, words: str, anchor: str = "start", size: int = 13) -> None:
        """Write words; y is the base line."""
        self.parts.append(
            f"<text x='{x:g}' y='{y:g}' font-size='{size}' text-anchor='{anchor}' "
            f"fill='{_INK}'>{escape(words)}</text>"
        )

    def bar(self, x: float, y: float, width: float, height: float, colour: str) -> None:
        """Draw a filled bar."""
        self.parts.append(
            f"<rect x='{x:.2f}' y='{y:.2f}' width='{width:.2f}' height='{height:g}' "
            f"fill='{colour}'/>"
        )

    def line(self, x0: float, y0: float, x1: float, y1: float, colour: str = _INK) -> None:
        """Draw a line."""
        self.parts.append(
            f"<line x1='{x0:.2f}' y1='{y0:.2f}' x2='{x1:.2f}' y2='{y1:.2f}' stroke='{colour}'/>"
        )

    def scale(self, rows: int, step: float) -> None:
        """Draw the lines at 0, 25, ... 100 % behind so many rows, and their figures below."""
        bottom = self.height + rows * step
        for percent in (0, 25, 50, 75, 100):
            x = _LEFT + _WIDTH * percent / 100
            self.line(x, self.height, x, bottom, _GRID)
            self.text(x, bottom + 15, f"{percent} %", "middle", 11)

    def svg(self) -> str:
        """Give the file's text."""
        width = _LEFT + _WIDTH + _RIGHT
        inner = "\n".join(self.parts)
        return (
            f"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 {width} {self.height:g}' "
            f"width='{width}' height='{self.height:g}' role='img' {_FONT}>\n"
            f"<title>{escape(self.title)}</title>\n"
            f"<rect width='100%' height='100%' fill='white'/>\n{inner}\n</svg>\n"
        )


def successes(rows: Sequence[Row]) -> str:
    """Draw how often each task was done, with and without attachments, with 95 % intervals."""
    drawing = Drawing("How often each task was really done, with and without attachments")
    tasks = [task for task in TASKS if any(row.trial.task == task for row in rows)]
    step = 46.0
    drawing.scale(len(tasks), step)
    for task in tasks:
        drawing.text(_LEFT - 10, drawing.height + 28, f"{task}  {TASKS[task].robot}", "end")
        for place, (attachments, colour) in enumerate(((True, _WITH), (False, _WITHOUT))):
            some = [r for r in rows if r.trial.task == task and r.trial.attachments is attachments]
            if some:
                y = drawing.height + 6 + 18 * place
                _rate_bar(
                    drawing, y, Rate(sum(r.achieved and r.true for r in some), len(some)), colour
                )
        drawing.height += step
    drawing.height += 30
    _legend(drawing, (("with attachments", _WITH), ("without", _WITHOUT)))
    return drawing.svg()


def _rate_bar(drawing: Drawing, y: float, rate: Rate, colour: str) -> None:
    drawing.bar(_LEFT, y, max(_WIDTH * rate.share, 1.0), 14, colour)
    low, high = (_LEFT + _WIDTH * share for share in rate.interval)
    drawing.line(low, y + 7, high, y + 7)
    for x in (low, high):
        drawing.line(x, y + 3, x, y + 11)
    drawing.text(_LEFT + _WIDTH + 10, y + 11, f"{rate.hits} of {rate.runs}", size=12)


def endings(groups: Iterable[tuple[str, Sequence[Row]]]) -> str:
    """Draw how the runs of each group ended, as shares of a bar."""
    drawing = Drawing("How runs ended, by what went wrong")
    listed = [(name, rows) for name, rows in groups if rows]
    step = 24.0
    drawing.scale(len(listed), step)
    met: set[Ending] = set()
    for name, rows in listed:
        drawing.text(_LEFT - 10, drawing.height + 16, name, "end")
        drawing.text(_LEFT + _WIDTH + 10, drawing.height + 16, f"{len(rows)} runs", size=12)
        x = float(_LEFT)
        for ending, count in _counted(rows):
            met.add(ending)
            width = _WIDTH * count / len(rows)
            drawing.bar(x, drawing.height + 3, width, 18, COLOURS[ending])
            x += width
        drawing.height += step
    drawing.height += 30
    _legend(drawing, [(str(ending), COLOURS[ending]) for ending in Ending if ending in met])
    return drawing.svg()


def _counted(rows: Sequence[Row]) -> Iterator[tuple[Ending, int]]:
    for ending in Ending:
        count = sum(row.ending is ending for row in rows)
        if count:
            yield ending, count


def _legend(drawing: Drawing, entries: Iterable[tuple[str, str]]) -> None:
    x = 24.0
    for words, colour in entries:
        width = 34 + 7.2 * len(words)
        if x + width > _LEFT + _WIDTH + _RIGHT:
            x, drawing.height = 24.0, drawing.height + 20
        drawing.bar(x, drawing.height, 14, 14, colour)
        drawing.text(x + 20, drawing.height + 12, words, size=12)
        x += width
    drawing.height += 28
