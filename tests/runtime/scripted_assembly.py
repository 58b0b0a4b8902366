"""An arm and eyes that are scripted, for the loop: picks the hub cover up and inserts it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from aapa import Anchor, Camera, Detection
from icarus_lite import Action, Outcome, Status
from runtime.config import load_robot
from runtime.drivers import PARK, ArmState
from runtime.errors import DriverError

CONFIG = load_robot("ur5")
CAMERA = Camera(
    320, 240, 233.0, (0.4, 0.0, 0.6), np.array([[0.0, -1.0, 0.0], [-1.0, 0, 0], [0, 0, -1.0]])
)
PLACES = {"hubcover": (0.40, 0.10, 0.01), "case": (0.42, -0.10, 0.04)}
PICK = Action("pick-up", ("hand1", "hubcover"))
INSERT = Action("insert", ("hubcover", "case"))


class Body:
    """Does what it is told in a given number of polls; whatever is in `fails` fails."""

    commands = frozenset({"grasp", "insert", "place", "take-out", "rest"})

    def __init__(
        self,
        polls: int = 2,
        fails: Mapping[str, str] | None = None,
        quick: Sequence[str] = (),
    ) -> None:
        self.polls, self.fails, self.quick = polls, dict(fails or {}), quick
        self.started: list[str] = []
        self.stops = 0
        self.held: str | None = None
        self.inserted: set[str] = set()
        self.hand = (0.3, 0.0, 0.42)
        self.dies_at: int | None = None
        self._left, self._action, self._time = 0, None, 0.0

    def state(self) -> ArmState:
        if self.dies_at is not None and self._time >= self.dies_at:
            raise DriverError("the controller no longer answers; the arm was stopped")
        pose = (*self.hand, 0.0, 3.14159, 0.0)
        return ArmState((0.0,) * 6, pose, self.held is not None, self.held is not None, self._time)

    def start(
        self, action: Action, commands: Sequence[Action], anchors: Mapping[str, Anchor]
    ) -> None:
        assert self._action is None, "one action at a time"
        assert commands
        self.started.append(str(action))
        self._action, self._left = action, 1 if action.name in self.quick else self.polls
        self._anchors = anchors

    def poll(self, anchors: Mapping[str, Anchor]) -> Outcome | None:
        del anchors
        self._time += 1
        action, self._left = self._action, self._left - 1
        if action is None:
            return None
        if self._left > 0:
            return Outcome(action, Status.RUNNING)
        self._action = None
        if action.name in self.fails:
            return Outcome(action, Status.FAILED, self.fails[action.name])
        if action == PICK:
            self.held, self.hand = "hubcover", PLACES["hubcover"]
        elif action == INSERT:
            self.held, self.hand = None, PLACES["case"]
            self.inserted.add("hubcover")
        elif action == PARK:
            self.hand = (0.3, 0.0, 0.42)
        return Outcome(action)

    def stop(self) -> None:
        self.stops += 1
        self._action = None

    def close(self) -> None:
        self.stop()


class Eyes:
    """Sees the parts that lie open on the table; what is held or inserted is out of sight."""

    def __init__(self, body: Body, parts: Sequence[str] = ("hubcover", "case")) -> None:
        self.body, self.parts = body, list(parts)

    def update(self, arm: ArmState) -> None:
        self.hand = arm.tcp_pose[:3]

    def look(self) -> tuple[list[Detection], Camera]:
        hidden = {self.body.held, *self.body.inserted}
        return [self._see(p) for p in self.parts if p not in hidden], CAMERA

    def _see(self, part: str) -> Detection:
        u, v, _ = CAMERA.project(PLACES[part])
        return Detection(part, (u - 8, v - 8, u + 8, v + 8), 0.9, PLACES[part], (0.04, 0.02))
