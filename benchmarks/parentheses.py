"""Forget each parenthesis of the shipped domains once, and double each once: what is said of it?

    python benchmarks/parentheses.py --out docs/results/parentheses.md

For each of these files it is counted whether the first error names the line in which the
parenthesis is missing or doubled, and how many further remarks are made, each of them a false one.
"""

from __future__ import annotations

import argparse
import re
import time
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from icarus_lite.language import Diagnostic, Severity, diagnose_text, render
from icarus_lite.language.reading.indentation import tokens

DOMAINS = Path(__file__).resolve().parents[1] / "domains"
_HEADER = """\
# A parenthesis forgotten, or one too many

Made by `make parentheses`. Every single parenthesis of the shipped domains is removed once and
doubled once. *Right line*: the message sends the reader to the line in which that was done. *One
off*: to the line above or below. *Further remarks* are all that is said besides it; the domains
themselves give none, so each one is false. What seems wrong in the very line of the parenthesis is
not told before that is mended.

The domains are laid out by `icarus fmt`. One of them is measured in two other layouts as well: two
blanks for each open parenthesis, and every line at the margin, where nothing but the grammar helps;
and with another mistake in it, a misspelt field, which is the one further remark there should be.
The last row sums up the layout of `icarus fmt`.

| domain | slip | files | right line | one off | no further remark | one | more |
| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |
""".splitlines()
_LINE = re.compile(r"line (\d+)\Z")


@dataclass(frozen=True, slots=True)
class Slip:
    """A text with one parenthesis too few or too many.

    Args:
        kind: What was done, in words.
        text: The text.
        line: The line in which it was done, counted from 1.
    """

    kind: str
    text: str
    line: int


@dataclass(slots=True)
class Tally:
    """What was said of slips of one kind."""

    slips: int = 0
    right: int = 0
    neighbours: int = 0
    further: Counter[int] = field(default_factory=Counter)
    wrong: list[tuple[Slip, tuple[Diagnostic, ...]]] = field(default_factory=list)
    slowest: float = 0.0

    def add(self, slip: Slip, found: tuple[Diagnostic, ...]) -> None:
        """Count one slip."""
        self.slips += 1
        errors = [each for each in found if each.severity is Severity.ERROR]
        about = [each for each in errors if each.code in ("ICR002", "ICR003")]
        first = next(iter(about or errors), None)
        distance = abs(named_line(first) - slip.line) if first else None
        self.right += distance == 0
        self.neighbours += distance == 1
        self.further[max(len(found) - 1, 0)] += 1
        if distance != 0 or len(found) > 1:
            self.wrong.append((slip, found))


def slips(text: str) -> Iterator[Slip]:
    """Give the text with each of its parentheses removed, and doubled, one at a time."""
    for token in tokens(text):
        if token.text in ("(", ")"):
            line = token.line + 1
            without = text[: token.offset] + text[token.offset + 1 :]
            yield Slip(f'"{token.text}" forgotten', without, line)
            twice = text[: token.offset] + token.text + text[token.offset :]
            yield Slip(f'"{token.text}" doubled', twice, line)


def by_depth(text: str) -> str:
    """Lay a text out as many an editor does: two blanks for each parenthesis that is open."""
    return _indented(text, lambda depth: "  " * depth)


def not_at_all(text: str) -> str:
    """Lay a text out with every line at the margin."""
    return _indented(text, lambda _: "")


def misspelt(text: str) -> str:
    """Give a text that has another mistake, which the parser stumbles over as well."""
    place = text.rindex(":tests")
    return text[:place] + ":tset" + text[place + len(":tests") :]


def _indented(text: str, indentation: Callable[[int], str]) -> str:
    depth = 0
    depths: dict[int, int] = {}
    for token in tokens(text):
        if token.is_first:
            depths[token.line] = depth
        depth += (token.text == "(") - (token.text == ")")
    lines = text.split("\n")
    for line, open_there in depths.items():
        lines[line] = indentation(open_there) + lines[line].lstrip()
    return "\n".join(lines)


def named_line(found: Diagnostic) -> int:
    """Give the line that a message sends the reader to."""
    match = _LINE.search(found.hint)
    return int(match[1]) if match else found.span.line


def measure(text: str, path: str) -> dict[str, Tally]:
    """Make every slip in a text and count what is said of it."""
    tallies: dict[str, Tally] = {}
    for slip in slips(text):
        begin = time.process_time()
        _, _, found = diagnose_text(slip.text, path)
        tally = tallies.setdefault(slip.kind, Tally())
        tally.slowest = max(tally.slowest, time.process_time() - begin)
        tally.add(slip, found)
    return tallies


def report(results: dict[str, dict[str, Tally]]) -> str:
    """Write the results as a page."""
    lines = [*_HEADER]
    total = Tally()
    for path, tallies in results.items():
        for kind, tally in tallies.items():
            lines.append(_row(path, kind, tally))
            if "," in path:
                continue
            total.slips += tally.slips
            total.right += tally.right
            total.neighbours += tally.neighbours
            total.further += tally.further
            total.slowest = max(total.slowest, tally.slowest)
    lines += [_row("**all**", "", total), ""]
    lines.append(f"The slowest file took {total.slowest:.2f} s of processor time to be checked.")
    return "\n".join(lines) + "\n"


def _row(path: str, kind: str, tally: Tally) -> str:
    more = sum(count for number, count in tally.further.items() if number > 1)
    cells = [
        path,
        kind,
        str(tally.slips),
        _share(tally.right, tally.slips),
        _share(tally.neighbours, tally.slips),
        _share(tally.further[0], tally.slips),
        _share(tally.further[1], tally.slips),
        _share(more, tally.slips),
    ]
    return f"| {' | '.join(cells)} |"


def _share(count: int, total: int) -> str:
    return f"{100 * count / total:.1f} %"


def main() -> None:
    """Measure the shipped domains and write the page; show what was told wrongly on request."""
    parser = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    parser.add_argument("--out", type=Path)
    parser.add_argument("--domain", action="append", help="only this one, such as gearbox")
    parser.add_argument("--wrong", type=int, default=0, help="how many wrong messages to show")
    options = parser.parse_args()
    results = {}
    for path in sorted(DOMAINS.glob("*.icr")):
        if not options.domain or path.stem in options.domain:
            text = path.read_text(encoding="utf-8")
            results[path.name] = measure(text, path.name)
            if path.stem == "gearbox":
                results["gearbox.icr, indented by depth"] = measure(by_depth(text), path.name)
                results["gearbox.icr, with a field misspelt"] = measure(misspelt(text), path.name)
                results["gearbox.icr, not indented"] = measure(not_at_all(text), path.name)
    page = report(results)
    if options.out:
        options.out.write_text(page, encoding="utf-8")
    print(page)
    wrong = [each for tallies in results.values() for t in tallies.values() for each in t.wrong]
    for slip, found in wrong[: options.wrong]:
        print(f"=== {slip.kind} in line {slip.line}")
        for each in found:
            print(render(each, slip.text))


if __name__ == "__main__":
    main()
