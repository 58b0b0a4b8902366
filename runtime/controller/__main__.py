"""`python -m runtime.controller`: the stand-in controller alone."""

from __future__ import annotations

import argparse
import ipaddress
import logging
import math
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path

from runtime.controller.arm import HOME
from runtime.controller.controller import Controller, Settings
from runtime.controller.faults import load_faults
from runtime.controller.ports import BANNER
from runtime.controller.versions import VERSIONS, version_for
from runtime.errors import RuntimeFault, UsageError
from runtime.kinematics import JOINT_LIMIT, MODELS, Joints


def main(argv: Sequence[str] | None = None) -> int:
    """Run a stand-in controller until it is told to stop.

    Prints `ready <model> <address>` on standard output once all ports listen.

    Args:
        argv: The arguments; None takes the command line's.

    Returns:
        0 after an orderly end, 1 if the bench told it to die, 2 if it could not start; the
        reason is then on standard error.
    """
    given = _parser().parse_args(argv)
    try:
        settings = _settings(given)
        _start_log(given.log)
        with _journal(given.journal) as write, Controller(settings, write) as controller:
            controller.stop_on_signals()
            sys.stdout.write(f"ready {settings.model.name} {settings.address}\n")
            sys.stdout.flush()
            return controller.run()
    except RuntimeFault as fault:
        sys.stderr.write(f"{fault}\n")
        return 2


def _parser() -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        prog="python -m runtime.controller",
        description=f"A {BANNER} for the real ur-rtde client.",
    )
    parser.add_argument("--model", choices=sorted(MODELS), default="ur5", help="which arm")
    parser.add_argument(
        "--address",
        type=_loopback,
        default="127.0.0.2",
        help="loopback address to listen on (%(default)s)",
    )
    parser.add_argument(
        "--clock",
        type=_clock,
        default=1.0,
        metavar="N",
        help="control cycles of robot time per control period of wall time (%(default)s)",
    )
    parser.add_argument(
        "--joints",
        type=_joints,
        default=HOME,
        metavar="q1,…,q6",
        help="where the arm stands at first, rad",
    )
    parser.add_argument(
        "--version",
        metavar="X.Y",
        help="the PolyScope version to play ("
        + ", ".join(f"{m} {v}" for m, v in VERSIONS.items())
        + ")",
    )
    parser.add_argument("--faults", type=Path, metavar="FILE", help="what is to go wrong, as YAML")
    parser.add_argument("--seed", type=int, default=0, help="of what the faults leave to chance")
    parser.add_argument(
        "--journal", type=Path, metavar="FILE", help="write what was witnessed, as JSON lines"
    )
    parser.add_argument("--log", type=Path, metavar="FILE", help="write a log")
    parser.add_argument("--parent", type=int, metavar="PID", help="end when this process has ended")
    return parser


def _settings(given: argparse.Namespace) -> Settings:
    """Give the settings the arguments ask for. Raises RuntimeFault for what cannot be."""
    return Settings(
        MODELS[given.model],
        given.address,
        given.clock,
        given.joints,
        given.parent,
        version_for(given.model, given.version),
        () if given.faults is None else load_faults(given.faults, given.seed),
    )


@contextmanager
def _journal(path: Path | None) -> Iterator[Callable[[str], None] | None]:
    """Open the journal's file, if there is one. Raises UsageError if it cannot be written."""
    if path is None:
        yield None
        return
    try:
        file = path.open("w", encoding="utf-8", buffering=1)
    except OSError as error:
        raise UsageError(
            f"the journal {path} cannot be written: {error.strerror}; choose another"
        ) from error
    with file:
        yield lambda line: print(line, file=file)


def _start_log(path: Path | None) -> None:
    """Log to a file if there is one; what a person should look at also to standard error.

    Raises:
        UsageError: The file cannot be written.
    """
    form = logging.Formatter(f"%(asctime)s {BANNER}: %(message)s")
    log = logging.getLogger("runtime.controller")
    log.propagate = False
    warnings = logging.StreamHandler()
    warnings.setLevel(logging.WARNING)
    warnings.setFormatter(form)
    log.addHandler(warnings)
    if path is None:
        return
    try:
        record = logging.FileHandler(path, encoding="utf-8")
    except OSError as error:
        raise UsageError(
            f"the log {path} cannot be written: {error.strerror}; choose another"
        ) from error
    record.setFormatter(form)
    log.addHandler(record)
    log.setLevel(logging.INFO)


def _loopback(text: str) -> str:
    """Take loopback addresses only: nobody on the network may take this for a robot."""
    try:
        loopback = ipaddress.IPv4Address(text).is_loopback
    except ValueError:
        loopback = False
    if not loopback:
        raise argparse.ArgumentTypeError(
            f"'{text}' is not a loopback address; choose one from 127.0.0.1 to 127.255.255.254"
        )
    return text


def _clock(text: str) -> float:
    value = _number(text)
    if not 0 < value <= 1000:
        raise argparse.ArgumentTypeError(f"{text} is not above 0 and up to 1000")
    return value


def _joints(text: str) -> Joints:
    values = [_number(word) for word in text.split(",")]
    if len(values) != 6:
        raise argparse.ArgumentTypeError(f"six angles are expected, not {len(values)}")
    if any(abs(value) > JOINT_LIMIT for value in values):
        raise argparse.ArgumentTypeError("every angle must lie within +-2 pi rad")
    q1, q2, q3, q4, q5, q6 = values
    return q1, q2, q3, q4, q5, q6


def _number(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        raise argparse.ArgumentTypeError(f"'{text}' is not a number") from None
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"'{text}' is not a finite number")
    return value


if __name__ == "__main__":
    sys.exit(main())
