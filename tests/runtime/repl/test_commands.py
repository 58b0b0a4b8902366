from __future__ import annotations

import json
import re
from pathlib import Path

import pytest
from recorded_runs import record
from talking import GEARBOX, ask, live

from icarus_lite import DomainError, FrameError, TraceError
from icarus_lite.trace import Recording
from runtime.repl import COMMANDS, CommandError, Session


@pytest.fixture
def session() -> Session:
    """Stand at the end of a run in which the cover was inserted."""
    session = live()
    ask(session, "step 3")
    return session


def test_every_command_is_explained_with_an_example_that_parses(session: Session) -> None:
    names = [command.name for command in COMMANDS]
    assert len(set(names)) == len(names)
    for command in COMMANDS:
        text = ask(session, f"help {command.name}")
        assert command.example in text
        assert command.example.split(" ")[0] == command.name
        assert text.startswith(command.name)
    listed = ask(session, "help")
    assert all(f" {name} " in f" {listed.replace(chr(10), ' ')} " for name in names)


def test_a_run_is_gone_through(session: Session) -> None:
    assert ask(session, "where").splitlines()[-1] == "looking at cycle 2"
    assert ask(session, "back").startswith("cycle 1\n  (pick-up hand1 hubcover) succeeded")
    assert ask(session, "back 5").splitlines()[:2] == ["this is the first cycle", "cycle 0"]
    assert ask(session, "step").startswith("cycle 1\n")
    assert "achieved: all goals are believed" in ask(session, "goto last")
    assert ask(session, "goto first").startswith("cycle 0")
    with pytest.raises(TraceError, match="has no cycle 77: its cycles are 0 to 2"):
        ask(session, "goto 77")
    with pytest.raises(CommandError, match="expected a cycle, `first` or `last`"):
        ask(session, "goto nowhere")


def test_what_is_believed(session: Session) -> None:
    assert "(attached hubcover case)" in ask(session, "beliefs").splitlines()
    assert ask(session, "(attached ?part case)").split() == [
        "?part", "(attached", "hubcover", "case)", "hubcover",
    ]  # fmt: skip
    assert ask(session, "b (free hand1)") == "(free hand1)"
    assert ask(session, "beliefs (near ?a ?b)").startswith("nothing matches (near ?a ?b)")
    assert "^type hubcover" in ask(session, "(object hubcover)")


def test_percepts(session: Session) -> None:
    text = ask(session, "percepts case")
    assert re.search(r"case +case +0.4 +-0.1 +0.03 +yes", text)
    assert "hand1" not in text
    assert "hand1" in ask(session, "percepts hand")
    assert ask(session, "percepts nobody") == "nothing of the kind is perceived in cycle 2"


def test_hierarchy(session: Session) -> None:
    text = ask(session, "hierarchy")
    assert text.splitlines()[0] == "case  perceived"
    assert "hubcover  perceived; by (insert hubcover case) in cycle 2" in text
    assert ask(session, "goto 0", "h") == "nothing is attached to anything in cycle 0"


def test_goal_plan_path_candidates(session: Session) -> None:
    assert ask(session, "goal").startswith("achieved  (attached hubcover case)")
    assert ask(session, "plan").startswith("there is no plan in cycle 2: achieved")
    assert ask(session, "goto 0", "plan").splitlines() == [
        "  1  (pick-up hand1 hubcover)",
        "  2  (insert hubcover case)",
    ]
    assert ask(session, "path").startswith(
        "for (attached hubcover case)\n  (pick-up hand1 hubcover)"
    )
    assert "* (pick-up hand1 hubcover)" in ask(session, "candidates")
    assert ask(session, "goto 1", "candidates").startswith("no choice was made in cycle 1")


def test_why_and_why_not(session: Session) -> None:
    assert ask(session, "why (attached hubcover case)").startswith(
        "(attached hubcover case)  because (insert hubcover case) succeeded, reported in cycle 2"
    )
    assert "hubcover" in ask(session, "why all (fits ?a ?b)")
    assert ask(session, "why (holding hand1 ?x)").startswith("(holding hand1 ?x) is not believed")
    assert ask(session, "why-not (insert hubcover case)").startswith(
        "(insert hubcover case) cannot start in cycle 2"
    )
    for command in ("why", "why-not", "when"):
        with pytest.raises(CommandError, match="what\\? for example"):
            ask(session, command)


def test_when_and_diff(session: Session) -> None:
    told = ask(session, "when (holding hand1 ?x)")
    assert told.startswith("(holding hand1 hubcover)  in cycle 1; (insert hubcover case) removed")
    assert ask(session, "when (attached case ?x)").endswith("ever was")
    assert ask(session, "diff 0").startswith("from cycle 0 to cycle 2\n  cycle 1: (pick-up")
    assert "+ (holding hand1 hubcover)" in ask(session, "diff 0 1")
    with pytest.raises(CommandError, match="one cycle or two"):
        ask(session, "diff")


def test_explain(session: Session) -> None:
    text = ask(session, "explain")
    assert text.startswith("(insert hubcover case) was started in cycle 1")
    assert "it succeeded in cycle 2" in text
    assert "+ (attached hubcover case)" in text
    assert ask(session, "explain (pick-up ?h ?x)").startswith(
        "(pick-up hand1 hubcover) was started"
    )
    with pytest.raises(CommandError, match="nothing that matches \\(place-down"):
        ask(session, "explain (place-down ?h ?x)")


def test_an_action_that_is_tried_again_is_told_from_the_first_try() -> None:
    session = live()
    ask(session, "step", "outcome failed it slipped", "step 2")
    text = ask(session, "goto 1", "explain")
    assert "(pick-up hand1 hubcover) was started in cycle 1" in text
    assert "it succeeded in cycle 2" in text


def test_what_is_typed_wrongly(session: Session) -> None:
    with pytest.raises(CommandError, match="no command `hierachy`; did you mean `hierarchy`"):
        ask(session, "hierachy")
    with pytest.raises(CommandError, match="nothing follows `hierarchy`"):
        ask(session, "hierarchy of all")
    with pytest.raises(DomainError, match="never closed"):
        ask(session, "beliefs (attached ?x")
    with pytest.raises(FrameError, match="expected one pattern"):
        ask(session, "beliefs (not (free hand1))")
    assert ask(session, "; a remark", "", "   ") == ""


def test_percepts_are_typed_and_outcomes_told() -> None:
    session = live()
    ask(session, "step", "outcome failed it slipped")
    assert "(pick-up hand1 hubcover) failed: it slipped" in ask(session, "step")
    ask(session, "percept (object plug ^type plug ^x 0.1)", "percept (object plug ^x 0.2)")
    assert "^type plug ^x 0.2 ^y 0" in ask(session, "percept (object plug ^y 0)")
    ask(session, "step")
    assert ask(session, "(graspable plug)") == "(graspable plug)"
    ask(session, "gone plug", "step")
    assert ask(session, "(graspable plug)").startswith("nothing matches")
    ask(session, "outcome succeeded (insert plug case)", "step")
    for wrong, message in (
        ("percept (objekt plug)", "no percept type; there are object, hand"),
        ("percept (object ?x)", "one name and values"),
        ("gone nobody", "no `nobody` is perceived"),
        ("outcome done", "expected one of succeeded, failed, running"),
    ):
        with pytest.raises(CommandError, match=re.escape(message)):
            ask(session, wrong)


def test_frames_are_loaded(tmp_path: Path) -> None:
    frames = tmp_path / "frames.jsonl"
    rows = [
        {
            "cycle": n,
            "percepts": [{"type": "hand", "name": f"h{n}", "attributes": {}}],
            "action": None,
        }
        for n in range(3)
    ]
    frames.write_text("".join(json.dumps(row) + "\n" for row in rows))
    session = live(goal="")
    ask(session, f"load {frames}")
    assert "that was the last cycle" in ask(session, "cont")
    assert [ask(session, f"goto {n}", "(free ?h)").split()[-1] for n in range(3)] == [
        "h0",
        "h1",
        "h2",
    ]
    frames.write_text("{")
    with pytest.raises(FrameError, match=r"frames.jsonl:1: "):
        ask(session, f"load {frames}")


def test_a_domain_is_reloaded(tmp_path: Path) -> None:
    file = tmp_path / "mine.icr"
    file.write_text(GEARBOX.read_text())
    session = live(file)
    ask(session, "step 2")
    assert ask(session, "reload").startswith(f"{file}: nothing has changed")
    file.write_text(
        GEARBOX.read_text().replace(
            "((hidden ?obj) :elements ((object ?obj ^seen no)))",
            "((open ?obj) :elements ((object ?obj ^seen yes)))"
            " ((hidden ?obj) :elements ((object ?obj ^seen yes)))",
        )
    )
    text = ask(session, "reload")
    assert "added: concept (open ?obj)" in text
    assert "changed: concept (hidden ?obj)" in text
    assert "+ (open case)" in text
    assert "+ (hidden hubcover)" in text
    assert ask(session, "(holding hand1 ?x)").endswith("hubcover")  # asserted facts are kept
    file.write_text("(concepts ((broken")
    text = ask(session, "reload")
    assert "mine.icr:1:1: error[ICR002]" in text
    assert text.endswith("the domain that was running goes on")
    assert "(open case)" in ask(session, "step", "beliefs")
    assert "(attached hubcover case)" in ask(session, "goal")  # the run goes on, by the new rules


def test_a_recorded_run_answers_the_same_and_takes_no_input(tmp_path: Path) -> None:
    run = record(tmp_path / "run.jsonl", seed=4, cycles=40, explained=True)
    session = Session(Recording(run.path))
    ask(session, "goto 25")
    assert set(ask(session, "beliefs").splitlines()) == set(run.believed[25])
    for belief in run.believed[25]:
        assert ask(session, f"why {belief}") == run.whys[25][belief]
    with pytest.raises(CommandError, match="this run is over"):
        ask(session, "percept (thing a)")
    assert ask(session, "goto last", "step") == "that was the last cycle"


def test_an_empty_run() -> None:
    session = live()
    for command in ("beliefs", "goal", "why (free hand1)", "hierarchy", "assume (free hand1)"):
        with pytest.raises(CommandError, match="no cycle to look at yet; `step` runs the first"):
            ask(session, command)
    assert "cycles so far: none" in ask(session, "where")


def test_quit(session: Session) -> None:
    ask(session, "quit")
    assert session.done
