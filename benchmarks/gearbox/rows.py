"""What is kept of each run: one line of JSON, from which the page can be made at any time."""

from __future__ import annotations

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass
from enum import StrEnum
from pathlib import Path
from typing import Final

import msgspec

from gearbox.trials import Trial

ROOT: Final = Path(__file__).resolve().parents[2]
_CODE: Final = ("aapa", "icarus_lite", "runtime", "domains")
_READ: Final = {".py", ".icr", ".yaml", ".lark"}


class Ending(StrEnum):
    """How a run ended; the last four are what must not happen."""

    ACHIEVED = "achieved"  # believed and true, and nothing had to be done again
    RECOVERED = "recovered"  # believed and true, after something had gone wrong
    FAILED = "failed, reason true"  # not believed, and the reason given is what happened
    MISNAMED = "failed, reason not true"  # not believed, and the reason is not what happened
    UNAWARE = "done without knowing"  # true, yet the run ended as failed
    FALSE = "believed and not true"
    BROKEN = "broken"  # the program itself came to no proper end


GOOD: Final = (Ending.ACHIEVED, Ending.RECOVERED, Ending.FAILED)
"""How a run may end, whatever happens to it."""


@dataclass(frozen=True, slots=True)
class Episode:
    """A stretch of a run in which something was believed that was not true.

    Args:
        belief: What was believed.
        cycle: When it began to be false.
        cycles: For how many cycles; at least 1.
        seconds: For how long on the arm's clock, s.
        during: The action that was under way when it began, "" if none.
        outlived: Whether it went on after that action had been reported as over. What ends with
            the report that is due anyway is the time that a report takes.
    """

    belief: str
    cycle: int
    cycles: int
    seconds: float
    during: str = ""
    outlived: bool = False


@dataclass(frozen=True, slots=True)
class Places:
    """How far anchors were from where their objects really were.

    Args:
        looked: Anchors times cycles.
        astray: Those of them farther off than an object may be to be taken for the same one.
        median_mm: Of all.
        worst_mm: In the last cycle.
        phantoms: Anchors of the last cycle that stand for nothing.
    """

    looked: int = 0
    astray: int = 0
    median_mm: float = 0.0
    worst_mm: float = 0.0
    phantoms: int = 0


@dataclass(frozen=True, slots=True)
class Trouble:
    """An action that did not end as it should, with the reason that was given."""

    cycle: int
    action: str
    reason: str


@dataclass(frozen=True, slots=True)
class Trace:
    """What became of a run's trace.

    Args:
        cycles: How many it has.
        damage: Why it cannot be read or replayed to the same; "" if it can.
    """

    cycles: int = 0
    damage: str = ""


@dataclass(frozen=True, slots=True)
class Row:
    """One run.

    Args:
        trial: What was run.
        ending: How it ended.
        achieved: Whether the run said that its goal was reached.
        true: Whether it really was.
        reason: What the run gave as the reason of its end.
        struck: What really went wrong, as its witnesses tell: the controller's journal, the cell.
        recoveries: Why the arm had stopped, each time that it was set going again.
        troubles: Actions that failed or were aborted.
        withdrawn: Beliefs that perception contradicted.
        actions: How many actions were begun.
        cycles: How many cycles it took.
        robot_s: How long on the arm's clock, s.
        wall_s: How long, from opening the workplace to closing it, s.
        cpu_s: Processor time of all its processes, s.
        false_at_end: Beliefs of the last cycle that were not true.
        episodes: What was believed without being true, at any time.
        places: Of the anchors.
        travel_rad: How far the joints turned, all in all.
        travels: How far the leading joint went after each stop and lost link, rad: what it was,
            or "noticed" for the moment in which the run learnt of it.
        unsafe: What the arm did that it must not; empty is what is wanted.
        trace: The trace.
        load: The machine's load average when it began.
        code: A digest of the code that ran.
    """

    trial: Trial
    ending: Ending
    achieved: bool
    true: bool
    reason: str
    struck: tuple[str, ...] = ()
    recoveries: tuple[str, ...] = ()
    troubles: tuple[Trouble, ...] = ()
    withdrawn: tuple[str, ...] = ()
    actions: int = 0
    cycles: int = 0
    robot_s: float = 0.0
    wall_s: float = 0.0
    cpu_s: float = 0.0
    false_at_end: tuple[str, ...] = ()
    episodes: tuple[Episode, ...] = ()
    places: Places = Places()
    travel_rad: float = 0.0
    travels: tuple[tuple[str, float], ...] = ()
    unsafe: tuple[str, ...] = ()
    trace: Trace = Trace()
    load: float = 0.0
    code: str = ""


class RowFile:
    """The rows of an experiment, appended run by run; what is in it need not be run again.

    Args:
        path: Made if need be.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        path.parent.mkdir(parents=True, exist_ok=True)
        self.rows = read_rows(path)

    def add(self, row: Row) -> None:
        """Keep a row; it is on disk when this returns. A row of the same run is replaced."""
        self.rows[row.trial.key] = row
        with self.path.open("ab") as file:
            # Begins a line of its own even where an interrupted run left half of one.
            cut = file.tell() > 0 and not self._ends_a_line()
            file.write(b"\n" * cut + msgspec.json.encode(row) + b"\n")

    def _ends_a_line(self) -> bool:
        with self.path.open("rb") as file:
            file.seek(-1, 2)
            return file.read(1) == b"\n"


def read_rows(path: Path) -> dict[str, Row]:
    """Give the rows of a file by their runs' keys, the newest of each; cut off lines are left out.

    Raises:
        SystemExit: a whole line is none of this program's; the text names it.
    """
    if not path.exists():
        return {}
    rows: dict[str, Row] = {}
    decoder = msgspec.json.Decoder(Row)
    for number, line in enumerate(path.read_bytes().splitlines(), 1):
        try:
            row = decoder.decode(line)
        except msgspec.ValidationError as error:
            message = f"{path}:{number}: is no row of this experiment: {error}; name another --rows"
            raise SystemExit(message) from None
        except msgspec.DecodeError:
            continue
        rows[row.trial.key] = row
    return rows


def code_digest(root: Path = ROOT) -> str:
    """Give a digest of all that a run's course depends on: packages, data and domains."""
    return _digest(
        path
        for folder in _CODE
        for path in sorted((root / folder).rglob("*"))
        if path.suffix in _READ
    )


def _digest(paths: Iterable[Path]) -> str:
    digest = hashlib.sha256()
    for path in paths:
        digest.update(path.name.encode() + b"\0" + path.read_bytes())
    return digest.hexdigest()[:12]
