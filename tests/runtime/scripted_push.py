"""An arm that waits for a push, and eyes that see the case: for the loop with another agent."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from scripted_assembly import CAMERA

from aapa import Anchor, Camera, Detection
from icarus_lite import Action, Outcome, Status
from icarus_lite.language import check_domain, parse_domain
from runtime.drivers import ArmState

TEXT = """
(agents human)
(percepts
  (object ^type ^x ^y ^z ^width ^height ^seen ^status)
  (hand ^x ^y ^z ^reach ^gripping))
(concepts
  ((close-by ?c) :elements ((object ?c ^type case ^y ?y)) :tests ((> ?y -0.15))))
(skills
  ((push-here ?c)
   :agent human
   :elements ((object ?c ^type case) (not (close-by ?c)))
   :effects ((close-by ?c))
   :request "please push ?c closer"
   :timeout 20)
  ((touch ?h ?c)
   :elements ((hand ?h) (close-by ?c))
   :actions ((*touch ?h ?c))
   :effects ((touched ?c))))
(task 2.2 "Touch the case" :robot ur5 :agents (human) :goal ((touched case)))
"""
DOMAIN, FOUND = parse_domain(TEXT)
assert DOMAIN is not None, FOUND
assert not check_domain(DOMAIN)
STEP = 0.02
"""How far the case is pushed between two looks, in m."""

TOUCH = "(touch hand1 case)"
PUSH = Action("push-here", ("case",))


class Body:
    """An arm at rest that needs two polls for whatever it is told."""

    commands = frozenset({"touch", "rest"})

    def __init__(self) -> None:
        self.started: list[str] = []
        self.time_s = 0.0
        self.polls = 2
        self._action: Action | None = None
        self._left = 0

    @property
    def moves(self) -> bool:
        return self._action is not None

    def state(self) -> ArmState:
        pose = (0.3, 0.0, 0.42, 0.0, 3.14159, 0.0)
        return ArmState(
            joints=(0.0,) * 6,
            tcp_pose=pose,
            gripper_closed=False,
            gripped=False,
            timestamp_s=self.time_s,
        )

    def start(
        self, action: Action, commands: Sequence[Action], anchors: Mapping[str, Anchor]
    ) -> None:
        del anchors
        assert self._action is None
        assert commands
        self.started.append(str(action))
        self._action, self._left = action, self.polls

    def poll(self, anchors: Mapping[str, Anchor]) -> Outcome | None:
        del anchors
        self.time_s += 1
        if self._action is None:
            return None
        self._left -= 1
        if self._left:
            return Outcome(self._action, Status.RUNNING)
        action, self._action = self._action, None
        return Outcome(action)

    def stop(self) -> None:
        self._action = None

    def close(self) -> None:
        self.stop()


class Eyes:
    """Sees the case where it is."""

    def __init__(self) -> None:
        self.y = -0.2

    def update(self, arm: ArmState) -> None:
        del arm

    def look(self) -> tuple[list[Detection], Camera]:
        place = (0.42, self.y, 0.04)
        u, v, _ = CAMERA.project(place)
        box = (u - 8, v - 8, u + 8, v + 8)
        return [Detection("case", box, 0.9, place, (0.04, 0.02))], CAMERA
