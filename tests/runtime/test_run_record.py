"""What a run keeps of itself: actions and how they ended, recoveries, what became of anchors."""

from __future__ import annotations

from aapa import Anchor, AnchorStatus
from icarus_lite import Action, Outcome, Status
from runtime.run_record import ActionRecord, LoopResult, RunRecord

PICK = Action("pick-up", ("hand1", "hubcover"))


def anchor(name: str, last_seen: int = 0) -> Anchor:
    return Anchor(name, name, (0, 0, 1, 1), AnchorStatus.VISIBLE, last_seen=last_seen)


def test_an_action_is_kept_with_how_it_ended() -> None:
    record = RunRecord()
    record.started(1, PICK)
    record.cycle(2, [Outcome(PICK, Status.RUNNING)], (), (), 2)
    record.cycle(3, [Outcome(PICK, Status.FAILED, "slipped")], (), (), 3)
    record.started(4, PICK, "requested")
    assert record.result("it slipped", 4, achieved=False) == LoopResult(
        achieved=False,
        reason="it slipped",
        cycles=4,
        actions=(
            ActionRecord(1, str(PICK), "failed"),
            ActionRecord(4, str(PICK), "requested"),
        ),
    )


def test_recoveries_are_kept_in_order() -> None:
    record = RunRecord()
    record.recovered("a protective stop")
    record.recovered("the link was lost")
    result = record.result("done", 9, achieved=True)
    assert result.recoveries == ("a protective stop", "the link was lost")


def test_an_anchor_that_is_gone_is_told_until_it_is_back() -> None:
    record = RunRecord()
    case, cover = anchor("case"), anchor("hubcover", last_seen=5)
    record.cycle(30, (), (case, cover), (case,), 30)
    (sentence,) = record.gone(["case", "hubcover"])
    assert sentence == (
        "hubcover is no longer anchored since cycle 30, after 25 cycles in which it was not seen "
        "and nothing said where it went"
    )
    assert record.gone(["case"]) == []
    record.cycle(31, (), (case,), (case, cover), 31)
    assert record.gone(["hubcover"]) == []
