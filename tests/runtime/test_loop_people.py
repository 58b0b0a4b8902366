"""The loop among people: a colleague who is asked and tells, an operator who sets the arm going."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest
from scripted_assembly import CONFIG, INSERT, PICK, PLACES, Body, Eyes
from scripted_push import DOMAIN, PUSH
from scripted_push import Body as StandingBody
from scripted_push import Eyes as CaseEyes

from aapa import Anchor, Anchoring
from icarus_lite import Action, Agent, Outcome, Status, load_domain
from icarus_lite.trace import RESUMED, Recording, TraceWriter, header, read_trace, replay
from runtime.errors import DriverError
from runtime.loop import Loop, TakenUp
from runtime.people import Nobody, People
from runtime.run import anchoring_parameters


class Pusher:
    """Hears a request, and reports the push some calls later."""

    def __init__(self, eyes: CaseEyes, patience: int = 4, answer: Outcome | None = None) -> None:
        self.eyes, self.left = eyes, patience
        self.heard: list[tuple[str, str, tuple[str, ...]]] = []
        self.answer = answer or Outcome(PUSH)

    def ask(self, action: Action, sentence: str, anchors: Mapping[str, Anchor]) -> None:
        self.heard.append((str(action), sentence, tuple(sorted(anchors))))

    def reports(self, _anchors: Mapping[str, Anchor]) -> tuple[Outcome, ...]:
        if not self.heard or self.left < 0:
            return ()
        self.left -= 1
        if self.left >= 0:
            return ()
        if self.answer.status is Status.SUCCEEDED:
            self.eyes.y = -0.1
        return (self.answer,)


def push(pusher: Pusher, body: StandingBody, **options: object):
    task = DOMAIN.tasks[0]
    agent = Agent(DOMAIN, task.goals, others=task.agents)
    people = People(pusher)
    anchoring = Anchoring(anchoring_parameters())
    return Loop(agent, anchoring, body, pusher.eyes, CONFIG, people=people, **options).run()


def test_a_colleague_is_asked_once_and_told_where_things_are():
    pusher = Pusher(CaseEyes())
    result = push(pusher, StandingBody())
    assert result.achieved, result.reason
    assert pusher.heard == [("(push-here case)", "please push case closer", ("case", "hand1"))]
    assert [(each.action, each.status) for each in result.actions] == [
        (str(PUSH), "succeeded"),
        ("(touch hand1 case)", "succeeded"),
    ]


def test_a_colleague_may_refuse():
    refusal = Outcome(PUSH, Status.FAILED, "my hands are full")
    result = push(Pusher(CaseEyes(), answer=refusal), StandingBody())
    assert not result.achieved
    assert "my hands are full" in result.reason


def test_what_is_done_unasked_is_known_when_it_is_told(tmp_path):
    class Helpful(Nobody):
        def __init__(self) -> None:
            self.calls = 0

        def reports(self, _anchors: Mapping[str, Anchor]) -> tuple[Outcome, ...]:
            self.calls += 1
            return (Outcome(Action("touch", ("hand1", "case"))),) if self.calls == 6 else ()

    task = DOMAIN.tasks[0]
    agent = Agent(DOMAIN, task.goals, others=task.agents)
    with TraceWriter(tmp_path / "t.jsonl", header(DOMAIN, task.goals)) as trace:
        loop = Loop(
            agent,
            Anchoring(anchoring_parameters()),
            StandingBody(),
            CaseEyes(),
            CONFIG,
            people=People(Helpful()),
            trace=trace,
        )
        assert loop.run().achieved
    told = [row["outcomes"] for row in read_trace(tmp_path / "t.jsonl").cycles if row["outcomes"]]
    assert told[0][0]["name"] == "touch"


class Falling(Body):
    """Is lost at a given time, and can be set going again a number of times."""

    def __init__(self, dies_at: int, times: int = 1, *, hopeless: bool = False) -> None:
        super().__init__(polls=6)
        self.dies_at, self.times, self.hopeless = dies_at, times, hopeless
        self.recovered = 0

    def recover(self) -> None:
        if self.hopeless:
            raise DriverError("the emergency stop is still pressed")
        self.recovered += 1
        self._action = None
        self.dies_at = None if self.recovered >= self.times else int(self._time) + 5


def gearbox_loop(body: Body, gearbox: Path, people: People, **options: object) -> Loop:
    agent = Agent(load_domain(gearbox), ["(attached hubcover case)"])
    return Loop(
        agent,
        Anchoring(anchoring_parameters()),
        body,
        Eyes(body),
        CONFIG,
        people=people,
        **options,
    )


@pytest.mark.parametrize("closed", [True, False])
def test_what_the_fingers_hold_after_a_grasp_that_was_broken_off_is_held(
    gearbox: Path, *, closed: bool
):
    class Closing(Falling):
        def recover(self) -> None:
            super().recover()
            if closed:  # the arm was stopped after its fingers had closed on the part
                self.held, self.hand = "hubcover", PLACES["hubcover"]

    body = Closing(dies_at=6)
    result = gearbox_loop(body, gearbox, People(operator=lambda _reason: True)).run()
    assert result.achieved, result.reason
    assert body.started.count(str(PICK)) == (1 if closed else 2)
    assert body.started.count(str(INSERT)) == 1


@pytest.mark.parametrize("times", [1, 2])
def test_with_the_operators_word_the_run_goes_on_to_its_goal(gearbox: Path, tmp_path, times):
    asked: list[str] = []

    def operator(reason: str) -> bool:
        asked.append(reason)
        return True

    domain = load_domain(gearbox)
    body = Falling(dies_at=12, times=times)
    with TraceWriter(tmp_path / "t.jsonl", header(domain, ["(attached hubcover case)"])) as trace:
        result = gearbox_loop(body, gearbox, People(operator=operator), trace=trace).run()
    assert result.achieved, result.reason
    assert body.recovered == times
    assert result.recoveries == tuple(asked)
    assert "no longer answers" in asked[0]
    assert replay(Recording(tmp_path / "t.jsonl")).decisions is None


def test_without_a_word_nothing_moves_again(gearbox: Path):
    for people in (People(), People(operator=lambda _reason: False)):
        body = Falling(dies_at=12)
        result = gearbox_loop(body, gearbox, people).run()
        assert not result.achieved
        assert body.recovered == 0
        assert result.reason == "the controller no longer answers; the arm was stopped"


def test_what_cannot_be_set_going_again_is_said(gearbox: Path):
    body = Falling(dies_at=12, hopeless=True)
    result = gearbox_loop(body, gearbox, People(operator=lambda _reason: True)).run()
    assert not result.achieved
    assert result.reason.endswith(
        "the arm could not be set going again: the emergency stop is still pressed"
    )
    assert result.recoveries == ()


def test_a_run_that_ends_with_the_arm_replays_to_the_same(gearbox: Path, tmp_path):
    domain = load_domain(gearbox)
    with TraceWriter(tmp_path / "t.jsonl", header(domain, ["(attached hubcover case)"])) as trace:
        gearbox_loop(Falling(dies_at=12), gearbox, People(), trace=trace).run()
    assert replay(Recording(tmp_path / "t.jsonl")).decisions is None
    last = read_trace(tmp_path / "t.jsonl").cycles[-1]
    assert last["lost"] == last["decision"]["reason"]
    assert last["decision"]["kind"] == "impasse"


def test_a_run_that_is_taken_up_says_so_and_fails_what_was_under_way(gearbox: Path, tmp_path):
    interrupted = Outcome(PICK, Status.FAILED, "the run was cut off while it was under way")
    domain = load_domain(gearbox)
    with TraceWriter(tmp_path / "t.jsonl", header(domain, ["(attached hubcover case)"])) as trace:
        result = gearbox_loop(
            Body(), gearbox, People(), trace=trace, taken_up=TakenUp((), interrupted)
        ).run()
    assert result.achieved, result.reason
    rows = read_trace(tmp_path / "t.jsonl").cycles
    assert [bool(row.get(RESUMED)) for row in rows] == [True] + [False] * (len(rows) - 1)
    assert rows[0]["outcomes"][0]["reason"] == interrupted.reason
