"""PolyScope versions: which of them each arm has, and what came with which.

Sources: Universal Robots, "RTDE Guide", "Dashboard Server, CB-Series" and "Dashboard Server,
e-Series" (their columns "since").
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, Self

from runtime.errors import UsageError

_TEXT: Final = re.compile(r"(\d+)\.(\d+)(?:\.(\d+))?(?:\.(\d+))?")


@dataclass(frozen=True, slots=True)
class Version:
    """A PolyScope version, as far as clients ask for it."""

    major: int
    minor: int
    bugfix: int
    build: int

    @classmethod
    def parse(cls, text: str) -> Self:
        """Read "5.17" or "3.15.8" or "3.15.8.106339". Raises UsageError for anything else."""
        found = _TEXT.fullmatch(text)
        if found is None:
            raise UsageError(f"'{text}' is not a PolyScope version, such as 5.17.3")
        major, minor, bugfix, build = (int(number or 0) for number in found.groups())
        return cls(major, minor, bugfix, build)

    def __str__(self) -> str:
        return f"{self.major}.{self.minor}.{self.bugfix}.{self.build}"

    @property
    def is_e_series(self) -> bool:
        """Whether it is of the e-Series; otherwise of the CB3 series."""
        return self.major >= 5

    def is_at_least(self, minors: Mapping[int, int]) -> bool:
        """Whether something that came with a minor version of each series is there already."""
        return self.major in minors and self.minor >= minors[self.major]


VERSIONS: Final[Mapping[str, Version]] = MappingProxyType(
    {"ur5": Version(3, 15, 8, 0), "ur16e": Version(5, 17, 3, 0)}
)
"""The PolyScope version played for each arm model unless another is asked for."""

SCRIPT_SINCE: Final[Mapping[str, Mapping[int, int]]] = MappingProxyType(
    {
        "force_mode_set_damping": {3: 5, 5: 0},
        "force_mode_set_gain_scaling": {5: 0},
        "get_actual_joint_positions_history": {5: 4},
        "get_inverse_kin_has_solution": {3: 15, 5: 10},
        "get_steptime": {5: 4},
        "get_tcp_offset": {3: 6, 5: 0},
        "protective_stop": {3: 8, 5: 0},
        "set_target_payload": {5: 10},
        "tool_contact": {5: 4},
    }
)
"""The minor versions that some URScript functions came with; all others have always been there."""

_MINORS: Final[Mapping[str, tuple[int, int, int]]] = MappingProxyType(
    {"ur5": (3, 0, 15), "ur16e": (5, 0, 25)}
)


def version_for(model: str, text: str | None) -> Version:
    """Give the version a controller of this arm is to play.

    Args:
        model: The arm's name.
        text: The version asked for; None takes the usual one.

    Raises:
        UsageError: It is no version, or not one of this arm's series.
    """
    if text is None:
        return VERSIONS[model]
    version = Version.parse(text)
    major, least, most = _MINORS[model]
    if version.major != major or not least <= version.minor <= most:
        raise UsageError(
            f"PolyScope {text} is not played for the {model}; "
            f"choose one from {major}.{least} to {major}.{most}"
        )
    return version
