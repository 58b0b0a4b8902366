from __future__ import annotations

from pathlib import Path

from icarus_lite import Action, Agent, Outcome, Percept, Status, load_domain
from icarus_lite.trace import Recording, TraceWriter, cycle_record, header, tell

GEARBOX = Path(__file__).parents[3] / "domains" / "gearbox.icr"
PICK, INSERT = Action("pick-up", ("hand1", "hubcover")), Action("insert", ("hubcover", "case"))


def scene(seen: str, *, case: bool = True) -> list[Percept]:
    found = [
        Percept("hand", "hand1", {"reach": 0.85}),
        Percept(
            "object", "hubcover", {"type": "hubcover", "x": 0.4, "y": 0.1, "z": 0.0, "seen": seen}
        ),
    ]
    place = {"type": "case", "x": 0.4, "y": -0.1, "z": 0.0, "seen": "yes"}
    return [*found, Percept("object", "case", place)] if case else found


def told(tmp_path: Path, *frames: tuple[list[Percept], list[Outcome]]) -> str:
    domain = load_domain(GEARBOX)
    agent = Agent(domain, ["(attached hubcover case)"])
    path = tmp_path / "run.jsonl"
    with TraceWriter(path, header(domain, agent.goals, task="1.1")) as writer:
        for percepts, outcomes in frames:
            writer.write(cycle_record(agent.cycle(percepts, outcomes), percepts, outcomes))
    return str(tell(Recording(path)))


def test_what_it_did_what_for_and_what_it_led_to(tmp_path: Path) -> None:
    text = told(
        tmp_path,
        (scene("yes"), []),
        (scene("no"), [Outcome(PICK)]),
        (scene("no"), [Outcome(INSERT)]),
    )
    assert text.startswith(
        "Task 1.1 of gearbox: the agent was to achieve (attached hubcover case)."
    )
    assert "1. (pick-up hand1 hubcover), cycle 0 to 1: succeeded" in text
    assert "Then it was to do (insert hubcover case)." in text
    assert "From then on it believed (attached hubcover case)" in text
    assert (
        "It was to bring about (holding hand1 hubcover), which (insert hubcover case) needs."
        in text
    )
    assert "Nothing: all went as planned." in text
    assert (
        "Cycle 1 to 2: hubcover was not seen; it was attached to hand1, "
        "then it was attached to case." in text
    )
    assert text.endswith("It ended after 3 cycles with its goals achieved: all goals are believed.")


def test_what_went_otherwise_and_what_it_made_of_it(tmp_path: Path) -> None:
    text = told(
        tmp_path,
        (scene("yes", case=False), []),
        (scene("yes", case=False), []),
        (scene("yes"), []),
        (scene("yes"), [Outcome(PICK, Status.FAILED, "the fingers closed on nothing")]),
    )
    assert "Cycle 0 to 1: nothing led on: (attached hubcover case) speaks of case" in text
    assert (
        "Cycle 3: (pick-up hand1 hubcover) failed: the fingers closed on nothing; "
        "in cycle 3 it chose (pick-up hand1 hubcover) again" in text
    )
    assert "without having achieved its goals" in text


def test_a_run_of_no_cycles(tmp_path: Path) -> None:
    assert told(tmp_path).endswith("No cycle is on record.")
