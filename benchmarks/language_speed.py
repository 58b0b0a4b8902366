"""How long reading, checking and explaining a domain takes, for 1, 10 and 100 kB.

    python benchmarks/language_speed.py --out docs/results/language.md

The text is a small domain over and over, each time with names of its own. It is measured as it
is, and once more with a mistake in its last form, which costs a second pass over the forms.
"""

from __future__ import annotations

import argparse
import platform
import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

from icarus_lite.language import check_domain, parse_domain, render

SIZES = (1_000, 10_000, 100_000)
PERCEPTS = """(percepts (object ^type ^x ^y ^z) (hand ^x ^y ^z ^reach))

"""
UNIT = """; What lies near, and how it is put away.
(concepts
  ((near-$ ?a ?b)
   :elements ((object ?a ^x ?xa ^y ?ya) (object ?b ^x ?xb ^y ?yb))
   :tests ((/= ?a ?b) (< (distance ?xa ?ya ?xb ?yb) 0.05)))
  ((free-$ ?hand) :elements ((hand ?hand) (not (holding-$ ?hand ?any)))))

(skills
  ((pick-up-$ ?hand ?obj)
   :elements ((free-$ ?hand)
              (object ?obj ^type output)
              (not (near-$ ?obj ?any)))
   :actions ((*grasp ?hand ?obj))
   :effects ((holding-$ ?hand ?obj))
   :timeout 60)
  ((put-away-$ ?hand ?obj)
   :elements ((holding-$ ?hand ?obj))
   :while ((holding-$ ?hand ?obj))
   :actions ((*place ?hand ?obj))
   :effects ((not (holding-$ ?hand ?obj)) (away-$ ?obj))))

(task put-away-$ "Tidy" :goal ((away-$ o1)))

"""


def domain_text(size: int) -> str:
    """Give a sound domain of about that many characters: `UNIT` over and over."""
    units, length = [], len(PERCEPTS)
    while length < size or not units:
        units.append(UNIT.replace("$", str(len(units))))
        length += len(units[-1])
    return PERCEPTS + "".join(units)


def with_mistake(text: str) -> str:
    """Give the text with a form at its end that cannot be read."""
    return f"{text}\n(taks 1.1 :goal ((attached hubcover case)))\n"


def with_forgotten(text: str) -> str:
    """Give the text with a parenthesis forgotten in the middle of its last form but one."""
    place = text.rindex("((put-away-")
    end = text.index(")\n", text.index(":elements", place))
    return text[:end] + text[end + 1 :]


def milliseconds(work: Callable[[], object], repeats: int) -> float:
    """Give the median processor time of some work."""
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
    return 1000 * statistics.median(times)


def row(size: int, repeats: int) -> tuple[int, float, float, float, float]:
    """Measure one size: its characters, then ms to parse, to check, and to explain two mistakes."""
    text = domain_text(size)
    domain, problems = parse_domain(text, "domain.icr")
    assert domain is not None, problems
    assert not [each for each in check_domain(domain) if each.severity == "error"]
    wrong, forgotten = with_mistake(text), with_forgotten(text)

    def explain(wrong: str) -> list[str]:
        return [render(each, wrong) for each in parse_domain(wrong, "domain.icr")[1]]

    assert len(explain(wrong)) == len(explain(forgotten)) == 1
    return (
        len(text),
        milliseconds(lambda: parse_domain(text, "domain.icr"), repeats),
        milliseconds(lambda: check_domain(domain), repeats),
        milliseconds(lambda: explain(wrong), repeats),
        milliseconds(lambda: explain(forgotten), repeats),
    )


def first_use() -> float:
    """Give the ms that a fresh process needs to import the language and build its parser."""
    code = (
        "import time; a = time.process_time(); import icarus_lite.language as l;"
        "l.parse_domain('(goals (a))'); print(time.process_time() - a)"
    )
    command = [sys.executable, "-c", code]
    outputs = [
        subprocess.run(command, capture_output=True, check=True, text=True).stdout  # noqa: S603
        for _ in range(3)
    ]
    return 1000 * min(map(float, outputs))


def report(repeats: int) -> str:
    """Measure everything and write it as a page."""
    rows = [row(size, repeats) for size in SIZES]
    lines = [
        f"| {size / 1000:.1f} kB | {parse:.1f} | {check:.1f} | {wrong:.1f} | {forgotten:.1f} |"
        for size, parse, check, wrong, forgotten in rows
    ]
    growth = rows[2][1] / rows[1][1], rows[2][2] / rows[1][2]
    table = "\n".join(lines)
    larger = f"from {rows[1][0] / 1000:.0f} to {rows[2][0] / 1000:.0f} kB"
    return f"""# Reading and checking domains: how long it takes

Made by `make bench-language`: median of {repeats} runs, processor time in ms,
Python {platform.python_version()}.

| text | parse | check | parse, with a mistake in the last form | with a parenthesis forgotten |
|---|---|---|---|---|
{table}

Ten times the text, {larger}, takes {growth[0]:.1f} times as long to parse and {growth[1]:.1f} times
as long to check. Importing the language and building its parser takes {first_use():.0f} ms, once a
process.
"""


def main() -> None:
    """Measure and report."""
    parser = argparse.ArgumentParser(description="How long reading and checking a domain takes.")
    parser.add_argument("--repeats", type=int, default=9)
    parser.add_argument("--out", type=Path, help="where the page goes")
    options = parser.parse_args()
    text = report(options.repeats)
    if options.out:
        options.out.write_text(text, encoding="utf-8")
    print(text)


if __name__ == "__main__":
    main()
