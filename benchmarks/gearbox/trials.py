"""Which runs the experiment consists of."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final

NO_FAULT: Final = "none"
"""The name of the condition in which nothing goes wrong."""

CLOCK: Final = 10.0
"""Robot seconds per second, where nothing else is said."""


@dataclass(frozen=True, slots=True)
class Benchmark:
    """One of the paper's tasks, and what must be true of the world for it to be done.

    Args:
        words: Its title in the paper.
        robot: The arm it is done with.
        seated: Pairs of part types: what must really sit in what in the end. Stated here once
            more, so that it is not the domain that says whether the domain's goal was reached.
        person: Whether a person takes part.
    """

    words: str
    robot: str
    seated: tuple[tuple[str, str], ...]
    person: bool = False

    @property
    def part(self) -> str:
        """The type of the part that the robot itself handles: the last that is named."""
        return self.seated[-1][0]

    @property
    def receiver(self) -> str:
        """The type of the part that takes it."""
        return self.seated[-1][1]


TASKS: Final[Mapping[str, Benchmark]] = MappingProxyType(
    {
        "1.1": Benchmark("Attach hub cover to case", "ur5", (("hubcover", "case"),)),
        "1.2": Benchmark("Insert input subassembly to case", "ur5", (("input", "case"),)),
        "1.3": Benchmark(
            "Assemble gearbox top and bottom (collaboration)",
            "ur5",
            (("casingtop", "case"),),
            person=True,
        ),
        "1.4": Benchmark("Screw plug into case", "ur5", (("plug", "case"),)),
        "2.1": Benchmark("Insert output subassembly to case", "ur16e", (("output", "case"),)),
        "2.2": Benchmark(
            "Insert three subassemblies to case (collaboration)",
            "ur16e",
            (("input", "case"), ("transfer", "case"), ("output", "case")),
            person=True,
        ),
    }
)
"""Table II of the paper (Liang et al. 2021)."""


@dataclass(frozen=True, slots=True)
class Trial:
    """One run: everything that decides what happens in it, but for the machine's timing.

    Args:
        task: A key of `TASKS`.
        seed: Of the scene, the detector's noise, the person and the moment of the fault.
        attachments: False takes the attachment hierarchy from the anchoring, as the paper did.
        fault: The name of a kind of fault, or `NO_FAULT`.
        clock: Robot seconds per second.
    """

    task: str
    seed: int
    attachments: bool = True
    fault: str = NO_FAULT
    clock: float = CLOCK

    @property
    def key(self) -> str:
        """Its name: what finds its row again, and names its trace."""
        side = "with" if self.attachments else "without"
        return f"{self.task}-{side}-{self.fault}-seed{self.seed}-clock{self.clock:g}"


def trials(
    tasks: Sequence[str],
    seeds: Sequence[int],
    faults: Sequence[str],
    attachments: Sequence[bool],
    clock: float,
) -> Iterator[Trial]:
    """Give the runs, seed by seed, so that an interrupted experiment has a bit of everything."""
    for seed in seeds:
        for fault in faults:
            for task in tasks:
                for kept in attachments:
                    yield Trial(task, seed, kept, fault, clock)
