"""Give the reader and the checker a great many wrong files: none may crash it, or keep it busy.

The inputs are mutations of the shipped domains, words of the language in any order, plain bytes,
and the patterns that trip parsers up: deep nesting, endless words, rows of semicolons or quotes.
For each one it is asserted that reading ends, raises nothing, finds errors exactly when it gives
no domain, and points only at places that exist.

    python benchmarks/fuzz_language.py --inputs 100000 --seed 1 --out docs/results/fuzz.md
"""

from __future__ import annotations

import argparse
import random
import sys
import time
import traceback
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from icarus_lite.language import CODES, DomainError, check_domain, has_errors, parse_domain, render
from icarus_lite.language.reading.brackets import FORM_NAMES
from icarus_lite.language.reading.sources import decode

DOMAINS = Path(__file__).resolve().parents[1] / "domains"
SECONDS = 2.0
"""How long reading and checking one input may take; all but a few are below 20 kB."""

MARKS = ["(", ")", "(", ")", "((", "))", '"', "'", "?", "^", "*", ":", ";", "|", "#", "#|", "|#"]
ODD = ["\\", "\n", "\r", "\t", "\0", "\ufeff", "\u2028", "\ud7ff", "é", "歯", "\x1b", "1e999", "-"]
FIELDS = [":elements", ":tests", ":binds", ":while", ":actions", ":subskills", ":effects"]
FIELDS += [":timeout", ":until", ":child", ":parent", ":goal", ":percepts", ":is", ":init", ":then"]
FIELDS += [":changes", ":value", ":foo", ":expect", ":agents", ":relevance", ":priority"]
FIELDS += [":break", "on-gain", "on-failure"]
TERMS = [
    "not",
    "?x",
    "?any",
    "^type",
    "*grasp",
    "plug",
    "1.5",
    "-3",
    '"a b"',
    "attached",
    "<",
    "/=",
]
WORDS = [*MARKS, *ODD, *FIELDS, *TERMS, *FORM_NAMES]


def inputs(seed: int, count: int) -> Iterator[tuple[str, bytes]]:
    """Give inputs, each with the name of what made it; the same ones for the same seed."""
    rng = random.Random(seed)  # noqa: S311 - inputs, no secrets
    domains = [path.read_text(encoding="utf-8") for path in sorted(DOMAINS.glob("*.icr"))]
    forms = [form for text in domains for form in text.replace("\n(", "\n\0(").split("\0")]
    words = [*WORDS, *{word for text in domains for word in text.split()}]
    words.sort()
    makers: list[tuple[str, int, Callable[[], bytes]]] = [
        ("mutated forms", 60, lambda: _mutated(rng, _some_forms(rng, forms), words)),
        ("mutated domain", 3, lambda: _mutated(rng, rng.choice(domains), words)),
        ("words", 20, lambda: _words(rng, words)),
        ("bytes", 7, lambda: rng.randbytes(rng.randrange(60))),
        ("flipped bytes", 5, lambda: _flipped(rng, _some_forms(rng, forms))),
        ("patterns", 5, lambda: _pattern(rng)),
    ]
    names, weights = [name for name, _, _ in makers], [weight for _, weight, _ in makers]
    make = {name: maker for name, _, maker in makers}
    for _ in range(count):
        (name,) = rng.choices(names, weights)
        yield name, make[name]()


def _some_forms(rng: random.Random, forms: list[str]) -> str:
    return "".join(rng.choice(forms) for _ in range(rng.randint(1, 3)))


def _mutated(rng: random.Random, text: str, words: list[str]) -> bytes:
    for _ in range(rng.randint(1, 6)):
        start = rng.randrange(len(text) + 1)
        stop = min(len(text), start + rng.choice([0, 1, 1, 2, 5, 20, 100]))
        match rng.randrange(5):
            case 0:
                text = text[:start] + text[stop:]
            case 1:
                text = text[:start] + rng.choice(words) + text[stop:]
            case 2:
                text = text[:start] + rng.choice(words) + text[start:]
            case 3:
                text = text[:stop] + text[start:]
            case _:
                other = rng.randrange(len(text) + 1)
                text = text[:other] + text[start:stop] + text[other:]
    return text.encode("utf-8", errors="surrogatepass")


def _words(rng: random.Random, words: list[str]) -> bytes:
    glue = rng.choice([" ", " ", "", "\n"])
    chosen = glue.join(rng.choice(words) for _ in range(rng.randrange(40)))
    return f"{rng.choice(['', '(concepts ((p ?x) ', '(skills ((go) '])}{chosen}".encode()


def _flipped(rng: random.Random, text: str) -> bytes:
    data = bytearray(text.encode())
    for _ in range(rng.randint(1, 4)):
        data[rng.randrange(len(data))] = rng.randrange(256)
    return bytes(data)


def _pattern(rng: random.Random) -> bytes:
    many = rng.choice([10, 101, 1000, 5000])
    word = rng.choice(WORDS)
    number = iter(range(10**9))
    return rng.choice(
        [
            lambda: word * many,
            lambda: f"{word} " * many,
            lambda: "(" * many + word + ")" * rng.choice([0, many // 2, many, many + 1]),
            lambda: "(goals " + "(a b) " * many + word,
            lambda: ";" * many + "\n" + word + "\n(goals (a)))",
            lambda: '(goals (a "' + '\\"' * many + word,
            lambda: f"(goals (a {'x' * many}{word}))",
            lambda: f"(goals (a {'7' * many}{word}))",
            lambda: "".join(f"({word}{next(number)} x)\n" for _ in range(many // 5)),
            lambda: (
                "(goals" + "".join(f" (p{next(number)} {word})" for _ in range(many // 5)) + ")"
            ),
            lambda: "(concepts" + _chain(many // 5, word) + ")",
            lambda: (
                "(percepts (o ^x)) (concepts ((p) :elements ("
                + "".join(
                    f"(o ?v{next(number)}) (not (o ?w{next(number)}))" for _ in range(many // 5)
                )
                + ")))"
            ),
        ]
    )().encode("utf-8", errors="surrogatepass")


def _chain(length: int, word: str) -> str:
    """Write concepts that rest on one another, round in a circle, the last one inside `not`."""
    links = [f"((c{n}) :elements ((c{n + 1}) (not (c{n // 2}))))" for n in range(length)]
    return "".join(links) + f"((c{length}) :elements ((not (c0)) ({word})))"


def assert_sound(data: bytes) -> str:
    """Assert what holds of reading any bytes whatsoever.

    Returns:
        The worst that was said: `error`, `warning`, `note` or `nothing`.
    """
    try:
        source = decode(data, "fuzz.icr")
    except DomainError as error:
        return "error" if str(error) else "failure"
    domain, found = parse_domain(source.text, "fuzz.icr")
    assert (domain is None) == has_errors(found)
    if domain is not None:
        found = (*found, *check_domain(domain, thorough=True))
    rows = source.text.split("\n")
    for each in found:
        assert each.code in CODES
        assert render(each, source)
        assert 0 <= each.span.line <= len(rows)
        if each.span.line:
            assert 1 <= each.span.column <= len(rows[each.span.line - 1]) + 1
    severities = {each.severity.value for each in found}
    return next((name for name in ("error", "warning", "note") if name in severities), "nothing")


@dataclass(slots=True)
class Result:
    """What came of a run."""

    verdicts: Counter[tuple[str, str]] = field(default_factory=Counter)
    failures: list[tuple[bytes, str]] = field(default_factory=list)
    seconds: float = 0.0
    slowest: tuple[float, bytes] = (0.0, b"")


def fuzz(seed: int, count: int, progress: Callable[[int], None] = lambda _: None) -> Result:
    """Read many inputs; an exception, or more than `SECONDS` for one, is a failure."""
    result = Result()
    assert_sound(b"(goals (a))")  # the parser is built once
    for number, (name, data) in enumerate(inputs(seed, count)):
        begin = time.process_time()
        try:
            verdict = assert_sound(data)
        except Exception:  # noqa: BLE001 - whatever it is, it is what we are looking for
            verdict = "failure"
            result.failures.append((data, traceback.format_exc(limit=-3)))
        took = time.process_time() - begin
        result.seconds += took
        result.slowest = max(result.slowest, (took, data))
        if took > SECONDS:
            result.failures.append((data, f"took {took:.1f} s"))
        result.verdicts[name, verdict] += 1
        progress(number)
    return result


def _report(result: Result, seed: int, count: int) -> str:
    names = sorted({name for name, _ in result.verdicts})
    columns = ("error", "warning", "note", "nothing", "failure")
    rows = [
        f"| {name} | " + " | ".join(str(result.verdicts[name, each]) for each in columns) + " |"
        for name in names
    ]
    took, slowest = result.slowest
    table = "\n".join(rows)
    each = 1000 * result.seconds / count
    return f"""# Wrong files, read

Made by `make fuzz`: {count:,} inputs, seed {seed}. A failure is an exception, or more than
{SECONDS:.0f} s for one input.

| input | an error is said | a warning | a note | nothing | failures |
|---|---|---|---|---|---|
{table}

{len(result.failures)} failures. {each:.1f} ms of processor time an input; the slowest, of
{len(slowest):,} bytes, took {took:.2f} s.
"""


def main() -> None:
    """Run, report, and end with status 1 if anything failed."""
    parser = argparse.ArgumentParser(description="Read a great many wrong domain files.")
    parser.add_argument("--inputs", type=int, default=100_000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, help="where the table goes")
    options = parser.parse_args()

    def progress(number: int) -> None:
        if number % 5000 == 4999:
            print(f"{number + 1:,} read", flush=True)

    result = fuzz(options.seed, options.inputs, progress)
    for data, why in result.failures[:20]:
        print(f"{data[:500]!r}\n{why}", file=sys.stderr)
    text = _report(result, options.seed, options.inputs)
    if options.out:
        options.out.write_text(text, encoding="utf-8")
    print(text)
    sys.exit(1 if result.failures else 0)


if __name__ == "__main__":
    main()
