from __future__ import annotations

from pathlib import Path

import pytest
from talking import GEARBOX, ask, live

from runtime.repl import CommandError


@pytest.mark.parametrize(
    ("stop", "why", "cycle"),
    [
        ("(holding hand1 ?x)", "(holding hand1 hubcover) is believed now", 1),
        ("gained (attached ?x case)", "(attached hubcover case) is believed now", 2),
        ("lost (free ?h)", "(free hand1) is no longer believed", 1),
        ("(insert ?a ?b)", "(insert hubcover case) is started", 1),
        ("started (pick-up ?a ?b)", "(pick-up hand1 hubcover) is started", 0),
        ("(grasp ?a ?b)", "(grasp hand1 hubcover) is started", 0),
        ("succeeded (insert ?a ?b)", "(insert hubcover case) succeeded", 2),
        ("goal", "all goals are believed", 2),
        ("lost (free ?h) if (object case ^seen yes)", "(free hand1) is no longer believed", 1),
    ],
)
def test_a_run_stops(stop: str, why: str, cycle: int) -> None:
    session = live()
    ask(session, f"break {stop}")
    text = ask(session, "cont 9")
    assert text.startswith(f"stopped: {why}  [")
    assert session.cycle == cycle


def test_a_condition_that_does_not_hold_lets_it_go_on() -> None:
    session = live()
    ask(session, "break lost (free ?h) if (object case ^seen no)")
    assert not ask(session, "cont 6").startswith("stopped")
    assert session.cycle == 3


def test_failures_and_impasses() -> None:
    session = live()
    ask(session, "break failure", "step", "outcome failed it slipped")
    assert ask(session, "cont").startswith("stopped: (pick-up hand1 hubcover) failed")
    ask(session, "unbreak all", "break impasse", "gone case")
    assert ask(session, "cont").startswith("stopped: impasse: ")
    ask(session, "unbreak 1", "break failed (pick-up ?h ?x)")
    ask(session, "percept (object case ^type case ^x 0.4 ^y 0 ^z 0)", "step")
    ask(session, "outcome failed (pick-up hand1 hubcover) again")
    assert ask(session, "cont").startswith("stopped: (pick-up hand1 hubcover) failed")


def test_breakpoints_are_listed_and_removed() -> None:
    session = live()
    assert ask(session, "break").startswith("there are no breakpoints")
    ask(session, "break goal", "break lost (free ?h) if (holding ?h plug)")
    assert ask(session, "break").splitlines() == [
        "1  goal",
        "2  lost (free ?h) if (holding ?h plug)",
    ]
    assert ask(session, "unbreak 1") == "1  lost (free ?h) if (holding ?h plug)"
    for wrong in ("unbreak 5", "unbreak x", "break sometimes", "break lost"):
        with pytest.raises(CommandError):
            ask(session, wrong)


def test_what_the_domain_declares(tmp_path: Path) -> None:
    file = tmp_path / "mine.icr"
    file.write_text(GEARBOX.read_text() + "\n(break (attached ?x case) (place-down ?h ?x))\n")
    session = live(file)
    assert "gained (attached ?x case)  (line " in ask(session, "break")
    assert ask(session, "cont").startswith("stopped: (attached hubcover case) is believed now")


def test_a_live_run_does_not_go_on_for_ever_where_nothing_changes() -> None:
    session = live()
    assert ask(session, "cont").startswith("nothing changes any more until you say")
    assert session.cycle == 3
    assert ask(session, "until (holding ?h case)").startswith("nothing changes any more")
    ask(session, "gone case")
    assert ask(session, "cont").startswith("nothing changes any more")
    assert session.cycle > 4


def test_until() -> None:
    session = live()
    assert ask(session, "until (attached hubcover case)").startswith("cycle 2")
    ask(session, "goto 0")
    assert ask(session, "until (holding ?h hubcover)").startswith("cycle 1")
