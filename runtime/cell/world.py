"""What the hand does to the parts: gripping, carrying, pressing, seating, dropping.

Quasi-static: nothing has mass or speed. How hard the hand presses is told from outside, by the
arm's force sensor, or follows from how far the tool is below what the held part touches.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from runtime.cell.arrangement import FIXTURE, Arrangement, PlacedPart
from runtime.cell.contact import STIFFNESS_N_M, Contact, Feeling
from runtime.cell.fingers import UPRIGHT, between_fingers, pushed_aside
from runtime.cell.insertion import Insertion
from runtime.cell.keeping import HeldPart, parts_from_json, parts_to_json
from runtime.cell.mishaps import Fate
from runtime.cell.seating import Opening
from runtime.cell.support import fall, heading
from runtime.errors import UsageError
from runtime.kinematics import Matrix
from runtime.parts import GRIPPER_OPENING_M

_PRESSES: Final = 2  # looks in a row at which a part is pressed too hard before it gives way
_SHOVED_M: Final = 0.008
_FROM_ABOVE_M: Final = 0.2
_FREE_M: Final = 0.001  # a seat is taken when something stands higher in it than this


@dataclass(frozen=True, slots=True)
class HandParameters:
    """How forgiving the hand and the parts are.

    Args:
        reach_across_m: A part's axis may be this far off the plane of the fingers.
        reach_height_m: The tool centre point may be this far off the part's grasp height.
        aside_m: A part let go within this distance of a seat's axis may be in the seat.
        press_m: How far below its seated height it may be let go and still be seated.
        drop_m: How far above it.
        press_share: The share of the seat's force with which it must have been pressed.
        turn_rad: How far a part that is not round may be turned and still fit.
        hold_n: Pressed harder than this, a part that only stands in the fixture moves aside.
    """

    reach_across_m: float = 0.012
    reach_height_m: float = 0.015
    aside_m: float = 0.0015
    press_m: float = 0.004
    drop_m: float = 0.002
    press_share: float = 0.6
    turn_rad: float = math.radians(15)
    hold_n: float = 20.0


class World:
    """The parts of the cell and the hand that moves them.

    Args:
        parts: The parts in their first places.
        fixture: The plate under the case; it can be landed on but not moved.
        hand: Tolerances.
        fate: What goes wrong; None is nothing.
    """

    def __init__(
        self,
        parts: Iterable[PlacedPart],
        fixture: PlacedPart,
        hand: HandParameters | None = None,
        fate: Fate | None = None,
    ) -> None:
        self._hand = hand or HandParameters()
        self._fate = fate or Fate()
        self.arrangement = Arrangement(parts, fixture, self._hand.turn_rad)
        self._insertion = Insertion(self.arrangement, self._fate)
        self._feeling = Feeling(self.arrangement, self._insertion)
        self._held: str | None = None
        self._grasp: Matrix = np.eye(4)
        self._closed = False
        self._slips_after_m: float | None = None
        self._pressed_looks = 0
        self._resumes: HeldPart | None = None
        self.tool: Matrix | None = None
        """(4, 4), the tool centre point at the last step."""

    @property
    def parts(self) -> Mapping[str, PlacedPart]:
        """The parts by name, always in the same order."""
        return self.arrangement.parts

    @property
    def version(self) -> int:
        """Grows whenever a part has moved."""
        return self.arrangement.version

    @property
    def held(self) -> str | None:
        """The part in the hand, if any."""
        return self._held

    @property
    def opening_m(self) -> float:
        """How far apart the fingers are now."""
        if self._held is not None:
            return self.parts[self._held].model.grip_width_m
        return 0.0 if self._closed else GRIPPER_OPENING_M

    def contact(self) -> Contact | None:
        """Give what the held part could touch around here; None if it is far from everything."""
        if self._held is None or self.tool is None or not _upright(self.tool):
            return None
        return self._feeling.contact(self._held, self.tool)

    def step(
        self, tcp: Matrix, *, closed: bool, force_n: float = 0.0, spun_rad: float = 0.0
    ) -> bool:
        """Bring the hand to a pose, (4, 4), with its close output on or off.

        Args:
            tcp: The tool centre point.
            closed: Whether the close output is on.
            force_n: How hard the tool presses down, as the arm measures it, N.
            spun_rad: How far it has turned about the vertical since the last step, whole turns
                included, within half a turn: a pose does not tell those.

        Returns:
            Whether the hand's sensor feels a part between the fingers.
        """
        before, self.tool = self.tool, tcp
        self._feeling.follow(tcp)
        if self._resumes is not None:
            resumed, self._resumes = self._resumes, None
            self.arrangement.move(resumed.name, tcp @ self._grasp)
            self._insertion.take_hold(
                resumed.name, heading(tcp), resumed.receiver, resumed.turned_rad
            )
        if self._held is not None:
            opens = self._closed and not closed
            self._carry(self._held, before, force_n, spun_rad, opens=opens)
        if closed and not self._closed:
            self._grip(tcp)
        elif self._closed and not closed:
            self._release()
        self._closed = closed
        return self._held is not None

    def place(self, name: str, x: float, y: float) -> None:
        """Put a part down at x, y, with all it carries, letting it fall from above."""
        self.arrangement.part(name)
        pose = np.eye(4)
        pose[:3, 3] = x, y, 1.0
        self._lose(name)
        self.arrangement.let_go(name)
        self.arrangement.move(name, pose)
        self.arrangement.drop(name)

    def insert(self, name: str, into: str) -> None:
        """Put a part into its seat in another part, as a person would.

        Raises:
            UsageError: No such part, or it has no seat there.
        """
        part, receiver = self.arrangement.part(name), self.arrangement.part(into)
        for seat in part.model.seats:
            if seat.into == receiver.model.type:
                self._lose(name)
                self.arrangement.sit(name, into, seat)
                return
        raise UsageError(f"A {part.model.type} has no seat in a {receiver.model.type}.")

    def is_seat_free(self, name: str, into: str) -> bool:
        """Tell whether a part could be put into its seat in another from above."""
        turned = heading(self.parts[into].pose)
        return any(
            opening.receiver == into and self._is_free(name, opening)
            for opening in self.arrangement.openings(name, turned)
        )

    def snapshot(self) -> dict[str, object]:
        """Give where everything is, ready for JSON. It stays the same while a part is carried."""
        held, turning = None, self._insertion.turning
        if self._held is not None:
            receiver = None if turning is None else turning.receiver
            turned = 0.0 if turning is None else turning.turned_rad
            held = HeldPart(self._held, self._grasp, receiver, turned)
        kept = parts_to_json(self.arrangement, held)
        return {**kept, "tried": self._insertion.snapshot(), "drawn": self._fate.counts}

    def restore(self, kept: Mapping[str, Any]) -> tuple[str, ...]:
        """Put everything where it was; give the parts that a person had in hand.

        Raises:
            UsageError: It was not written by a world with these parts.
        """
        parts, held, carried = parts_from_json(kept, self.parts)
        self.arrangement.restore(parts, kept.get("pinned", ()))
        self._insertion.restore(kept.get("tried", ()))
        self._fate.go_on_from(kept.get("drawn", {}))
        self._feeling.forget()
        self._slips_after_m = None
        self._held, self._closed, self._resumes = None, held is not None, held
        if held is not None:
            self.arrangement.take(held.name)
            self._held, self._grasp = held.name, held.grasp
        return carried

    def _grip(self, tcp: Matrix) -> None:
        hand = self._hand
        reachable = [
            (abs(across), name)
            for name, part in self.parts.items()
            if name not in self.arrangement.in_hands
            and (across := between_fingers(part, tcp, hand.reach_across_m, hand.reach_height_m))
            is not None
        ]
        if not reachable:
            return
        name = min(reachable)[1]
        was = self.parts[name]
        self._grasp = np.linalg.inv(tcp) @ was.pose
        self.arrangement.take(name)
        mouths = self._insertion.openings(name)
        self._grasp[1, 3] = pushed_aside(
            was.pose,
            tcp,
            float(self._grasp[1, 3]),
            lambda places: self.arrangement.field(name, heading(was.pose), places, mouths),
        )
        self._held = name
        self._slips_after_m = self._fate.slip_after_m()
        self._pressed_looks = 0
        self.arrangement.move(name, tcp @ self._grasp)
        self._insertion.take_hold(name, heading(tcp), was.parent, was.turned_rad)

    def _carry(
        self, name: str, before: Matrix | None, force_n: float, spun_rad: float, *, opens: bool
    ) -> None:
        tool = self.tool
        assert tool is not None, "a step brings the tool somewhere"
        self.arrangement.move(name, tool @ self._grasp)
        if not _upright(tool):
            return
        down_n = self._pressed_n()
        home_n = STIFFNESS_N_M * self._insertion.sunk_m(name)
        stays = self._insertion.follow(name, tool, max(force_n, down_n or 0.0, home_n), spun_rad)
        if stays:
            self._slip_off(name)
            return
        # The measured force may come from the walls of a hole as well.
        self._press(name, force_n if down_n is None else down_n, opens=opens)
        if before is not None and self._slips_after_m is not None:
            self._slips_after_m -= float(np.linalg.norm(tool[:3, 3] - before[:3, 3]))
            if self._slips_after_m < 0 and self._insertion.turning is None:
                self._lose(name)
                self._settle(name)

    def _pressed_n(self) -> float | None:
        """Give how hard the part is pressed down, from how far the tool is below its contact.

        None where nothing is known of what it could touch.
        """
        assert self.tool is not None, "a step brings the tool somewhere"
        contact = self.contact()
        if contact is None:
            return None
        x, y, z = self.tool[:3, 3].tolist()
        if contact.thread is None:
            return contact.press_n(x, y, z)
        turning = self._insertion.turning
        assert turning is not None, "a contact has a thread only while the part is in it"
        turned = turning.turned_rad / (2 * math.pi)
        height = contact.thread.top_z - contact.thread.pitch_m * turned
        deep: float = height - z
        return max(0.0, deep * contact.stiffness_n_m)

    def _press(self, name: str, force_n: float, *, opens: bool) -> None:
        """Move what is pressed too hard, and not held by a person, aside."""
        hard = force_n > self._hand.hold_n
        self._pressed_looks = self._pressed_looks + 1 if hard else 0
        if not hard or (self._pressed_looks < _PRESSES and not opens):
            return
        for opening in self._insertion.openings(name):
            x, y, z = self.parts[name].position
            if opening.beside_m(x, y) > opening.mouth_m or z > opening.rim_m:
                continue
            base = (opening.receiver, *self.arrangement.ancestors(opening.receiver))[-1]
            if self.parts[base].parent != FIXTURE or base in self.arrangement.pinned:
                continue
            angle = self._fate.shove_rad()
            pose = self.parts[base].pose.copy()
            pose[:2, 3] += _SHOVED_M * np.array([math.cos(angle), math.sin(angle)])
            self.arrangement.move(base, pose)
            self._pressed_looks = 0
            return

    def _slip_off(self, name: str) -> None:
        """Leave a part in its thread from which the hand was pulled away."""
        turning = self._insertion.turning
        assert turning is not None, "only a part in a thread stays behind"
        self._leave_in_thread(name, turning.receiver, turning.turned_rad)
        self._lose(name)

    def _release(self) -> None:
        name = self._held
        if name is None:
            return
        turning = self._insertion.turning
        if turning is not None:
            self._leave_in_thread(name, turning.receiver, turning.turned_rad)
            self._lose(name)
            return
        seat = self._seat_of(name)
        if seat is not None:
            self.arrangement.sit(name, seat.receiver, seat.seat)
        else:
            self._settle(name)
        self._lose(name)

    def _leave_in_thread(self, name: str, receiver: str, turned_rad: float) -> None:
        into = self.parts[receiver].model.type
        seat = next(seat for seat in self.parts[name].model.seats if seat.into == into)
        self.arrangement.sit(name, receiver, seat, turned_rad)

    def _seat_of(self, name: str) -> Opening | None:
        """Give the seat in which the part is as it is let go; None if it is in none."""
        self._set_upright(name)
        x, y, z = self.parts[name].position
        for opening in self._insertion.openings(name):
            above = z - opening.centre[2]
            if (
                opening.seat.thread is None
                and opening.beside_m(x, y) <= self._hand.aside_m
                and -self._hand.press_m <= above <= self._hand.drop_m
                and self._insertion.jam_m(name, opening) is None
                and self._insertion.press_n >= self._hand.press_share * opening.seat.press_n
                and self._is_free(name, opening)
            ):
                return opening
        return None

    def _is_free(self, name: str, opening: Opening) -> bool:
        """Tell whether nothing but the receiver is in the way of a seat."""
        part = self.parts[name]
        above = part.pose.copy()
        above[:3, 3] = *opening.centre[:2], opening.centre[2] + _FROM_ABOVE_M
        near = {opening.receiver, *self.arrangement.ancestors(opening.receiver), FIXTURE}
        others = self.arrangement.solids(name, near)
        depth, _ = fall(part.model, above, others)
        return float(above[2, 3]) - depth <= opening.centre[2] + _FREE_M

    def _settle(self, name: str) -> None:
        """Let a part go where it is not seated: it stays in the mouth of a seat, or it falls."""
        self._set_upright(name)
        x, y, z = self.parts[name].position
        for mouth in self._insertion.mouths(name):
            inside = mouth.beside_m(x, y) <= mouth.mouth_m and z < mouth.rim_m
            if inside and self._is_free(name, mouth):
                self.arrangement.stand(
                    name, mouth.receiver, max(z, mouth.floor_m), mouth.centre[:2]
                )
                return
        self.arrangement.drop(name)

    def _set_upright(self, name: str) -> None:
        part = self.parts[name]
        pose = np.eye(4)
        c, s = math.cos(heading(part.pose)), math.sin(heading(part.pose))
        pose[:2, :2] = [[c, -s], [s, c]]
        pose[:3, 3] = part.pose[:3, 3]
        self.arrangement.move(name, pose)

    def _lose(self, name: str) -> None:
        """Note that the hand no longer holds a part."""
        if self._held == name:
            self._held = None
            self._slips_after_m = None
            self._insertion.release()
            self._feeling.forget()
            self.arrangement.let_go(name)


def _upright(tool: Matrix) -> bool:
    """Tell whether a tool, (4, 4), points down closely enough to press on anything."""
    return float(tool[2, 2]) <= -UPRIGHT
