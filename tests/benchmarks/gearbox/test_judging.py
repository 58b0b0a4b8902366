from __future__ import annotations

from dataclasses import dataclass, field
from types import SimpleNamespace

import pytest
from gearbox.endings import ending
from gearbox.faults import WITHOUT_ATTACHMENTS, true_reasons
from gearbox.judging import Judge, identities, is_done, kind_of, taken_away
from gearbox.rows import Ending
from gearbox.trials import TASKS, Trial

from aapa import Anchor, AnchorStatus
from icarus_lite import Action, Belief, DecisionKind, Outcome, Status

HAND = "hand1"


@dataclass
class Part:
    name: str
    position: tuple[float, float, float]


@dataclass
class Truth:
    """A world of a cover, a case and two bearings, to be told what is where."""

    parts: dict[str, Part] = field(
        default_factory=lambda: {
            "hubcover-1": Part("hubcover-1", (0.4, 0.1, 0.01)),
            "case-1": Part("case-1", (0.4, -0.1, 0.03)),
            "bearing-1": Part("bearing-1", (0.3, 0.2, 0.01)),
            "bearing-2": Part("bearing-2", (0.5, 0.2, 0.01)),
        }
    )
    held: str | None = None
    person: SimpleNamespace = field(
        default_factory=lambda: SimpleNamespace(doing=None, holds=None, carries=None)
    )
    seated: dict[str, str] = field(default_factory=dict)


def anchor(name, position):
    return Anchor(name, kind_of(name), (0, 0, 1, 1), AnchorStatus.VISIBLE, position=position)


def seen(truth, **names):
    """Anchor each part where it is; `names` says which symbol stands for which part."""
    stand_for = {"hubcover": "hubcover-1", "case": "case-1", **names}
    return tuple(anchor(name, truth.parts[part].position) for name, part in stand_for.items())


class Run:
    """Tells a judge of one cycle after the other."""

    def __init__(self, truth):
        self.truth = truth
        self.judge = Judge(TASKS["1.1"], truth, HAND)
        self.number = 0
        self.gripper_closed = False

    def cycle(self, *, attached=(), holding=(), held=(), act=None, outcomes=(), anchors=None):
        persist = [Belief("holding", (HAND, name)) for name in holding]
        persist += [Belief("held", (name,)) for name in held]
        state = SimpleNamespace(
            hierarchy=SimpleNamespace(pairs=lambda: tuple(attached)),
            asserted=lambda: iter([(belief, None) for belief in persist]),
        )
        step = None if act is None else SimpleNamespace(action=act)
        decision = SimpleNamespace(
            cycle=self.number,
            state=state,
            kind=DecisionKind.CONTINUE if act is None else DecisionKind.ACT,
            step=step,
        )
        report = SimpleNamespace(
            decision=decision,
            outcomes=tuple(outcomes),
            anchors=seen(self.truth) if anchors is None else anchors,
            arm=SimpleNamespace(
                timestamp_s=100.0 + 0.5 * self.number, gripper_closed=self.gripper_closed
            ),
        )
        self.number += 1
        self.judge(report)
        return self.judge.verdict()


PICK_UP = Action("pick-up", (HAND, "hubcover"))
INSERT = Action("insert", ("hubcover", "case"))


def test_what_is_true_is_no_false_belief():
    run = Run(Truth())
    run.cycle(act=PICK_UP)
    run.truth.held = "hubcover-1"
    run.cycle()  # held, and not yet believed: nothing is claimed
    done = Outcome(PICK_UP, Status.SUCCEEDED)
    verdict = run.cycle(attached=[("hubcover", HAND)], holding=["hubcover"], outcomes=[done])
    assert verdict.episodes == ()
    assert verdict.false_at_end == ()
    assert verdict.actions == 1
    assert verdict.robot_s == pytest.approx(1.0)


def test_what_is_believed_until_the_report_does_not_outlive_its_action():
    run = Run(Truth(held="hubcover-1"))
    run.cycle(attached=[("hubcover", HAND)], act=INSERT)
    run.truth.held, run.truth.seated["hubcover-1"] = None, "case-1"  # the fingers have opened
    verdict = run.cycle(attached=[("hubcover", HAND)])
    assert verdict.false_at_end == ("(attached hubcover hand1)",)
    verdict = run.cycle(
        attached=[("hubcover", "case")], outcomes=[Outcome(INSERT, Status.SUCCEEDED)]
    )
    assert verdict.false_at_end == ()
    (episode,) = verdict.episodes
    assert (episode.cycle, episode.cycles, episode.seconds) == (1, 1, 0.5)
    assert episode.during == str(INSERT)
    assert not episode.outlived
    assert verdict.true


def test_what_goes_on_after_the_report_has_outlived_its_action():
    run = Run(Truth(held="hubcover-1"))
    run.cycle(attached=[("hubcover", HAND)], holding=["hubcover"], act=INSERT)
    run.truth.held = None  # it slipped
    run.cycle(attached=[("hubcover", HAND)], holding=["hubcover"])
    slipped = Outcome(INSERT, Status.FAILED, "the gripper no longer feels the part it held")
    run.cycle(attached=[("hubcover", HAND)], holding=["hubcover"], outcomes=[slipped])
    verdict = run.cycle(attached=[("hubcover", HAND)])
    found = {episode.belief: episode for episode in verdict.episodes}
    assert found["(attached hubcover hand1)"].outlived
    assert found["(attached hubcover hand1)"].cycles == 3
    assert found["(holding hand1 hubcover)"].cycles == 2
    assert verdict.false_at_end == ("(attached hubcover hand1)",)
    assert [trouble.reason for trouble in verdict.troubles] == [slipped.reason]
    assert not verdict.true


def test_what_the_person_holds_is_a_belief_like_others():
    run = Run(Truth())
    assert run.cycle(held=["case"]).false_at_end == ("(held case)",)
    run.truth.person.holds = "case-1"
    assert run.cycle(held=["case"]).false_at_end == ()


def test_a_part_that_leaves_the_closed_fingers_has_slipped():
    run = Run(Truth(held="hubcover-1"))
    run.gripper_closed = True
    run.cycle()
    run.truth.held = None
    run.cycle()
    assert run.cycle().events == ("slipped: hubcover-1",)


def test_a_part_that_is_put_down_has_not_slipped():
    run = Run(Truth(held="hubcover-1"))
    run.gripper_closed = True
    run.cycle()
    run.gripper_closed, run.truth.held = False, None
    assert run.cycle().events == ()


def test_a_part_that_is_elsewhere_without_the_robot_was_moved_by_hand():
    run = Run(Truth(held="hubcover-1"))
    run.cycle()
    run.truth.parts["bearing-2"].position = (0.45, 0.0, 0.01)
    run.truth.parts["hubcover-1"].position = (0.4, 0.0, 0.3)  # carried by the robot
    run.truth.parts["case-1"].position = (0.401, -0.1, 0.03)  # a nudge
    run.cycle()
    run.truth.held = None
    run.truth.parts["hubcover-1"].position = (0.4, 0.0, 0.01)  # put down by it
    assert run.cycle().events == ("moved by hand: bearing-2",)


def test_what_the_person_does_is_seen_as_long_as_it_lasts():
    run = Run(Truth())
    for doing in (None, "reach-in", "reach-in", None, "take-away"):
        run.truth.person.doing = doing
        verdict = run.cycle()
    assert verdict.events == ("person: reach-in", "person: take-away")


def test_a_part_on_the_case_is_not_a_part_in_it():
    run = Run(Truth())
    assert run.cycle(attached=[("hubcover", "case")]).false_at_end == ("(attached hubcover case)",)
    run.truth.seated["hubcover-1"] = "case-1"
    assert run.cycle(attached=[("hubcover", "case")]).false_at_end == ()


def test_symbols_stand_for_the_nearest_parts_of_their_type():
    # The anchoring numbers bearings as it meets them, the cell as it lays them out.
    truth = Truth(held="bearing-2")
    run = Run(truth)
    crossed = seen(truth, **{"bearing-1": "bearing-2", "bearing-2": "bearing-1"})
    assert run.cycle(attached=[("bearing-1", HAND)], anchors=crossed).false_at_end == ()
    verdict = run.cycle(attached=[("bearing-2", HAND)], anchors=crossed)
    assert verdict.false_at_end == ("(attached bearing-2 hand1)",)


def test_a_symbol_no_longer_anchored_stands_for_what_it_stood_for():
    truth = Truth(held="hubcover-1")
    run = Run(truth)
    run.cycle(attached=[("hubcover", HAND)])
    assert run.cycle(attached=[("hubcover", HAND)], anchors=()).false_at_end == ()


def test_one_anchor_too_many_stands_for_nothing():
    truth = Truth()
    anchors = [
        anchor("bearing-1", (0.3, 0.2, 0.01)),
        anchor("bearing-2", (0.5, 0.21, 0.01)),
        anchor("bearing-3", (0.9, 0.9, 0.0)),
    ]
    found = identities(anchors, truth.parts.values())
    assert {name: part.name for name, (part, _) in found.items()} == {
        "bearing-1": "bearing-1",
        "bearing-2": "bearing-2",
    }
    assert found["bearing-2"][1] == pytest.approx(0.01)
    run = Run(truth)
    assert run.cycle(anchors=tuple(anchors)).places.phantoms == 1


def test_anchors_far_from_their_objects_are_astray():
    truth = Truth()
    run = Run(truth)
    run.cycle()
    lost = (anchor("hubcover", (0.4, 0.2, 0.01)), anchor("case", truth.parts["case-1"].position))
    places = run.cycle(anchors=lost).places
    assert (places.looked, places.astray) == (4, 1)
    assert places.worst_mm == pytest.approx(100)
    assert places.median_mm == 0


def test_a_task_is_done_when_all_is_seated_and_the_hand_holds_none_of_it():
    task = TASKS["2.2"]
    truth = Truth(seated={"input-1": "case-1", "output-1": "case-1"})
    assert not is_done(task, truth)
    truth.seated["transfer-1"] = "case-1"
    assert is_done(task, truth)
    truth.held = "input-1"
    assert not is_done(task, truth)
    truth.held = "bearing-2"
    assert is_done(task, truth)


@pytest.mark.parametrize(
    ("achieved", "true", "troubled", "reason", "expected"),
    [
        (True, True, False, "all goals are believed", Ending.ACHIEVED),
        (True, True, True, "all goals are believed", Ending.RECOVERED),
        (True, False, False, "all goals are believed", Ending.FALSE),
        (True, False, True, "all goals are believed", Ending.FALSE),
        (False, False, True, "the arm is in a protective stop: find its cause", Ending.FAILED),
        (False, True, True, "the arm is in a protective stop: find its cause", Ending.FAILED),
        (False, False, True, "the arm is in an emergency stop", Ending.MISNAMED),
        (False, True, False, "hubcover is no longer anchored", Ending.UNAWARE),
    ],
)
def test_endings(achieved, true, troubled, reason, expected):
    reasons = true_reasons(Trial("1.1", 0, fault="protective_stop"))
    assert (
        ending(achieved=achieved, true=true, troubled=troubled, reason=reason, reasons=reasons)
        is expected
    )


def test_without_attachments_a_lost_part_is_a_true_reason():
    reason = "(attached hubcover case) speaks of hubcover, which is not perceived"
    asked = {"achieved": False, "true": False, "troubled": False, "reason": reason}
    assert ending(**asked, reasons=()) is Ending.MISNAMED
    assert ending(**asked, reasons=WITHOUT_ATTACHMENTS) is Ending.FAILED


NOT_SEEN = (
    "(in-reachable-pose ?hand ?obj) needs (object hubcover ^x 0.4 ^y 0.1 ^z 0.03 ^seen yes)",
    "(attached hubcover case) speaks of hubcover, which is not perceived",
    "no plan; hubcover is no longer anchored since cycle 9, after 23 cycles without a sign",
)


@pytest.mark.parametrize("reason", NOT_SEEN)
def test_a_part_that_is_not_seen_is_a_true_reason_only_while_the_person_has_it(reason):
    truth, task = Truth(), TASKS["1.1"]
    asked = {"achieved": False, "true": False, "troubled": True, "reason": reason}
    for fault, expected in (
        ("taken", Ending.FAILED),
        ("taken_silently", Ending.FAILED),
        ("kept", Ending.FAILED),
        ("moved", Ending.MISNAMED),
        ("reaches_in", Ending.MISNAMED),
    ):
        trial = Trial("1.1", 0, fault=fault)
        truth.person.carries = "hubcover-1"
        assert taken_away(task, truth) == {"hubcover"}
        reasons = true_reasons(trial, taken_away(task, truth))
        assert ending(**asked, reasons=reasons) is expected
        truth.person.carries = None  # it is back on the table, where it can be seen
        assert taken_away(task, truth) == set()
        reasons = true_reasons(trial, taken_away(task, truth))
        assert ending(**asked, reasons=reasons) is Ending.MISNAMED


def test_it_has_to_be_the_part_that_was_taken():
    reasons = true_reasons(Trial("2.2", 0, fault="kept"), {"output"})
    asked = {"achieved": False, "true": False, "troubled": True}
    other = "(in-place input case) speaks of input, which is not perceived"
    assert ending(**asked, reason=other, reasons=reasons) is Ending.MISNAMED
    own = "(attached output case) speaks of output, which is not perceived"
    assert ending(**asked, reason=own, reasons=reasons) is Ending.FAILED


def test_what_lies_on_the_persons_own_side_is_away():
    truth = Truth()
    truth.parts["hubcover-1"] = Part("hubcover-1", (0.98, -0.36, 0.01))
    truth.parts["bearing-1"] = Part("bearing-1", (0.98, -0.2, 0.01))  # not asked for
    assert taken_away(TASKS["1.1"], truth) == {"hubcover"}
    run = Run(truth)
    assert run.cycle().away == ("hubcover",)


def test_a_hand_that_goes_slowly_has_moved_a_part_too():
    run = Run(Truth())
    run.cycle()
    for step in range(1, 6):
        run.truth.parts["bearing-2"] = Part("bearing-2", (0.5 + 0.01 * step, 0.2, 0.01))
        verdict = run.cycle(anchors=())
    assert verdict.events == ("moved by hand: bearing-2",)
