"""The cell written down as JSON, and set up again as it was: what a run needs that was cut off.

What is in the robot's hand is told by how it lies in the hand, so that nothing changes while it is
carried. What a person had in hand is found on their own side again; what they were asked and had
not done is forgotten.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from runtime.cell.arrangement import Arrangement, PlacedPart
from runtime.errors import UsageError
from runtime.kinematics import Matrix

_DIGITS: Final = 7


@dataclass(frozen=True, slots=True, eq=False)
class HeldPart:
    """What is in the robot's hand.

    Args:
        name: The part.
        grasp: (4, 4), the part's centre in the frame of the tool centre point.
        receiver: The part whose thread it is in, if any.
        turned_rad: How far it is screwed in there.
    """

    name: str
    grasp: Matrix
    receiver: str | None = None
    turned_rad: float = 0.0


def parts_to_json(arrangement: Arrangement, held: HeldPart | None) -> dict[str, object]:
    """Give where the parts are.

    Args:
        arrangement: The parts.
        held: What is in the robot's hand.
    """
    rows = {}
    for name, part in arrangement.parts.items():
        row: dict[str, object] = {"parent": part.parent, "seated": part.seated}
        row["turned_rad"] = round(part.turned_rad, _DIGITS)
        if held is not None and name == held.name:
            row["grasp"] = _rows(held.grasp)
            row["thread"] = held.receiver
            row["turned_rad"] = round(held.turned_rad, 2)
        elif held is not None and held.name in arrangement.ancestors(name):
            carrier = arrangement.part(held.name).pose
            row["in_hand"] = _rows(np.linalg.inv(carrier) @ part.pose)
        elif name not in arrangement.in_hands:
            row["pose"] = _rows(part.pose)
        rows[name] = row
    return {"parts": rows, "pinned": sorted(arrangement.pinned)}


def parts_from_json(
    kept: Mapping[str, Any], parts: Mapping[str, PlacedPart]
) -> tuple[dict[str, PlacedPart], HeldPart | None, tuple[str, ...]]:
    """Read where the parts were.

    Args:
        kept: What `parts_to_json` gave.
        parts: The same parts in any places.

    Returns:
        The parts, what was in the robot's hand, and the names of those that a person had in hand.

    Raises:
        UsageError: It was not written by a cell with these parts.
    """
    try:
        rows = kept["parts"]
        if set(rows) != set(parts):
            raise UsageError(
                f"A cell with the parts {', '.join(sorted(rows))} was written down; here are"
                f" {', '.join(sorted(parts))}. Take the same cell and parts."
            )
        held, carried = None, []
        found = {}
        for name, part in parts.items():
            row = rows[name]
            pose = np.eye(4)
            if "grasp" in row:
                held = HeldPart(name, _matrix(row["grasp"]), row["thread"], row["turned_rad"])
            elif "in_hand" in row:
                pose = _matrix(
                    row["in_hand"]
                )  # the held part is at the origin until the first step
            elif "pose" in row:
                pose = _matrix(row["pose"])
            else:
                carried.append(name)
            found[name] = replace(
                part,
                pose=pose,
                parent=row["parent"],
                seated=bool(row["seated"]),
                turned_rad=float(row["turned_rad"]),
            )
    except (KeyError, TypeError, ValueError, AttributeError) as error:
        raise UsageError(f"This is no cell that was written down: {error!r}.") from None
    return found, held, tuple(carried)


def _rows(pose: Matrix) -> list[list[float]]:
    rows: list[list[float]] = np.round(pose[:3], _DIGITS).tolist()
    return rows


def _matrix(rows: object) -> Matrix:
    pose = np.eye(4)
    pose[:3] = np.asarray(rows, dtype=np.float64).reshape(3, 4)
    # Rounding has bent the axes a little.
    left, _, right = np.linalg.svd(pose[:3, :3])
    pose[:3, :3] = left @ right
    return pose
