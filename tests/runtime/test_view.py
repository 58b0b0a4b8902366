from __future__ import annotations

import io

from rich.console import Console

from aapa import Anchor, AnchorStatus
from icarus_lite import Action, Agent, Outcome, Percept, Status
from icarus_lite.language.reading.reader import parse_domain
from runtime.cycle_report import CycleReport
from runtime.drivers import ArmState
from runtime.view import RunView

DOMAIN, _ = parse_domain("""(percepts (hand) (object))
(concepts ((there ?o) :elements ((object ?o))))
(skills ((pick-up ?h ?o) :elements ((hand ?h) (there ?o)) :actions ((*grasp ?h ?o))
                         :effects ((holding ?h ?o))))""")
ARM = ArmState((0.0,) * 6, (0.3, 0.0, 0.4, 0.0, 3.14, 0.0), False, False, 0.0)  # noqa: FBT003
PICK = Action("pick-up", ("hand1", "cover"))


def anchor(name: str, status: AnchorStatus, parent: str | None = None) -> Anchor:
    kind = "hand" if name == "hand1" else "cover"
    return Anchor(name, kind, (0, 0, 1, 1), status, parent, 1.0, (0.4, 0.1, 0.0))


def play(console: Console, title: str = "task 1") -> str:
    """Show three cycles: seen, held and hidden, gone."""
    agent = Agent(DOMAIN, ["(holding hand1 cover)"])
    hand = anchor("hand1", AnchorStatus.VISIBLE)
    frames = [
        ([anchor("cover", AnchorStatus.VISIBLE)], ()),
        ([anchor("cover", AnchorStatus.ATTACHED, "hand1")], (Outcome(PICK),)),
        ([], (Outcome(PICK, Status.FAILED, "slipped"),)),
    ]
    with RunView(console, title) as view:
        view.announce("a cell")
        for anchors, outcomes in frames:
            percepts = [Percept("hand", "hand1"), *(Percept("object", a.name) for a in anchors)]
            decision = agent.cycle(percepts, outcomes)
            report = CycleReport(decision, outcomes, tuple(percepts), (hand, *anchors), (), ARM)
            view.show(report)
    return console.file.getvalue()


def test_plain_lines_where_there_is_no_terminal() -> None:
    text = play(Console(file=io.StringIO(), force_terminal=False, width=40))
    assert text == (
        "task 1\n"
        "a cell\n"
        "cycle    0  + (there cover)\n"
        "cycle    0    cover: seen\n"
        "cycle    0  (pick-up hand1 cover)\n"
        "cycle    1  (pick-up hand1 cover) succeeded\n"
        "cycle    1  + (holding hand1 cover)\n"
        "cycle    1    cover: not seen, kept: attached to hand1\n"
        "cycle    1  nothing: all goals are believed\n"
        "cycle    2  (pick-up hand1 cover) failed: slipped\n"
        "cycle    2  - (holding hand1 cover)\n"
        "cycle    2  - (there cover)\n"
        "cycle    2    cover: no longer anchored\n"
        "cycle    2  impasse: (holding hand1 cover) speaks of cover, which is not perceived\n"
    )


def test_a_terminal_gets_a_panel_and_keeps_the_milestones() -> None:
    text = play(Console(file=io.StringIO(), force_terminal=True, width=100, color_system=None))
    last = text[text.rindex("a cell") :] if text.count("a cell") > 1 else text
    assert "how it is known" in text
    for line in (
        "cycle    0  (pick-up hand1 cover)",
        "cycle    2  (pick-up hand1 cover) failed: slipped",
        "cycle    2  impasse: (holding hand1 cover) speaks of cover, which is not perceived",
    ):
        assert line in last
