"""The page on semantics: each example on it means what it says."""

from __future__ import annotations

import doctest
import json
import re
from dataclasses import dataclass, field
from pathlib import Path

import pytest

from icarus_lite.errors import IcarusError
from icarus_lite.inference import Chronicle, Context, InferenceEngine, Memory, explain, why_not
from icarus_lite.language import diagnose_file, load_domain, parse_conditions, render
from icarus_lite.symbols import Belief
from icarus_lite.testing import run_tests
from icarus_lite.trace import beliefs_line, read_frames

PAGE = Path(__file__).parents[1] / "docs" / "reference" / "semantics.md"
BLOCKS = re.findall(
    r"^```(\w+) ?([^\n]*)\n(.*?)^```$", PAGE.read_text("utf-8"), re.MULTILINE | re.DOTALL
)


@dataclass
class Example:
    """A domain, and the blocks below it that belong to it."""

    number: int
    info: str
    text: str
    parts: dict[str, str] = field(default_factory=dict)


def read_examples() -> list[Example]:
    examples: list[Example] = []
    for kind, info, text in BLOCKS:
        if kind == "lisp":
            examples.append(Example(len(examples), info, text))
        elif kind != "python":
            assert info not in examples[-1].parts
            examples[-1].parts[info] = text
    return examples


EXAMPLES = read_examples()
TOLD = [e for e in EXAMPLES if "frames" in e.parts]


def cases(examples):
    return [pytest.param(each, id=f"{each.number}-{each.text.split()[0]}") for each in examples]


def written(example: Example, folder: Path) -> Path:
    path = folder / "example.icr"
    path.write_text(example.text, encoding="utf-8")
    return path


@pytest.mark.parametrize("example", cases(EXAMPLES))
def test_every_example_loads_or_has_the_fault_it_shows(example, tmp_path):
    _, source, found = diagnose_file(written(example, tmp_path))
    said = "\n".join(render(each, source) for each in found)
    if example.info:
        assert {each.code for each in found} == {example.info}, said
    else:
        assert [each for each in found if each.severity != "note"] == [], said


@pytest.mark.parametrize("example", cases(e for e in EXAMPLES if not e.info))
def test_every_example_is_tested_and_passes(example, tmp_path):
    outcomes = run_tests(load_domain(written(example, tmp_path)))
    assert outcomes or "frames" in example.parts, "nothing shows what this example says"
    assert [str(d) for outcome in outcomes for d in outcome.differences] == []


class Run:
    """The frames of an example, as `icarus infer` goes through them."""

    def __init__(self, example: Example, folder: Path) -> None:
        self.domain = load_domain(written(example, folder))
        self.engine = InferenceEngine(self.domain)
        self.memory = Memory()
        self.chronicle = Chronicle()
        self.beliefs: list[str] = []
        self.said: list[str] = []
        frames = folder / "frames.jsonl"
        frames.write_text(example.parts["frames"], encoding="utf-8")
        try:
            for frame in read_frames(frames):
                self.step(frame)
        except IcarusError as error:
            self.said.append(str(error).replace(str(frames), "frames.jsonl"))
        self.said = [line.replace(str(folder / "example.icr"), "example.icr") for line in self.said]

    def step(self, frame) -> None:
        before = self.memory.state
        try:
            self.memory = self.engine.step(self.memory, frame.percepts, frame.outcomes)
        except IcarusError as error:
            raise type(error)(f"frames.jsonl:{frame.line}: {error}") from error
        now = self.memory.state
        self.said += [f"frames.jsonl:{frame.line}: {note}" for note in now.notes]
        self.beliefs.append(beliefs_line(frame.cycle, now.beliefs))
        self.chronicle.record(
            now.cycle,
            [b for b in now.beliefs if b not in before],
            [b for b in before.beliefs if b not in now],
            frame.outcomes,
            [percept.name for percept in now.percepts],
            now.withdrawn,
        )

    def answer(self, question: str) -> str:
        kind, _, asked = question.partition(" ")
        if kind == "why":
            (condition,) = parse_conditions(asked)
            args = tuple(term.value for term in condition.atom.args)
            belief = Belief(condition.atom.predicate, args)
            return str(explain(belief, self.memory.state, chronicle=self.chronicle))
        assert kind == "why-not"
        context = Context(
            self.domain,
            self.memory.state,
            self.engine.evaluator,
            self.chronicle,
            self.memory.known,
        )
        return str(why_not(asked, context))


@pytest.mark.parametrize("example", cases(TOLD))
def test_the_frames_give_what_stands_below_them(example, tmp_path):
    run = Run(example, tmp_path)
    told = set(example.parts) - {"frames"}
    assert told, "nothing stands below the frames"
    if "beliefs" in told:
        expected = [json.loads(line) for line in example.parts["beliefs"].splitlines()]
        assert [json.loads(line) for line in run.beliefs] == expected
    said = example.parts.get("notes", example.parts.get("error", ""))
    assert run.said == said.splitlines()
    for question in told - {"beliefs", "notes", "error"}:
        assert run.answer(question) == example.parts[question].rstrip("\n"), question


@pytest.mark.parametrize("session", [text for kind, _, text in BLOCKS if kind == "python"])
def test_every_session_goes_as_shown(session):
    said: list[str] = []
    found = doctest.DocTestParser().get_doctest(session, {}, "semantics.md", str(PAGE), 0)
    runner = doctest.DocTestRunner(verbose=False)
    assert runner.run(found, out=said.append).failed == 0, "".join(said)


def test_questions_of_both_kinds_are_shown():
    asked = [part for example in TOLD for part in example.parts if part.startswith("why")]
    assert {part.partition(" ")[0] for part in asked} == {"why", "why-not"}
