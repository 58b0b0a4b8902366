"""A workplace: a driver with its arm, and a source of percepts, put together for one run."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path

from aapa import Camera, Detection
from runtime.addresses import is_loopback
from runtime.cell import Cell
from runtime.config import RobotConfig, load_robot
from runtime.controller.bench_client import BenchClient
from runtime.controller.process import ControllerProcess
from runtime.drivers import ArmState, Driver, DryRunDriver, UrDriver
from runtime.errors import UsageError
from runtime.parts import PartModel, load_parts


class CellSource:
    """Percepts from the simulated cell, which follows the arm's measured joints.

    Args:
        cell: The cell.
        feel: Tells the gripper's sensor whether a part is between the fingers.
    """

    def __init__(self, cell: Cell, feel: Callable[[bool], None]) -> None:
        self._cell = cell
        self._feel = feel
        self._gripped = False

    def update(self, arm: ArmState) -> None:
        """Move the scene to where the arm is, and the gripper's sensor with it."""
        gripped = self._cell.update(arm.joints, arm.gripper_closed)
        if gripped != self._gripped:
            self._feel(gripped)
            self._gripped = gripped

    def look(self) -> tuple[list[Detection], Camera]:
        """Give the next frame's detections and the camera that took it."""
        return self._cell.look()


@dataclass(frozen=True, slots=True)
class Workplace:
    """What a run needs of the world.

    Args:
        driver: The body.
        source: Where percepts come from.
        cell: The simulated cell, whose ground truth may judge a run and never enters it.
        words: A sentence that says what this is, for the person who watches.
    """

    driver: Driver
    source: CellSource
    cell: Cell
    words: str


@contextmanager
def open_workplace(
    config: RobotConfig,
    parts: Mapping[str, PartModel],
    *,
    address: str | None = None,
    live: bool = False,
    seed: int = 0,
    clock: float = 1.0,
    log: Path | None = None,
) -> Iterator[Workplace]:
    """Put a workplace together, and take it apart again whatever happens.

    Without an address, the simulated cell gets a stand-in controller of its own. A loopback
    address is a stand-in that somebody else has started. Any other address may be a real arm:
    it is left alone, and the run is a dry run on a virtual arm.

    Args:
        config: The robot.
        parts: The part models that cell and driver share.
        address: Host of a controller, or None.
        live: Whether a real arm may move. There is no source of percepts for a real cell yet, and
            an arm is never moved on simulated beliefs, so this is refused.
        seed: Of the scene and the detector's noise.
        clock: Robot seconds per second of the stand-in this starts.
        log: Beside this path the controller and the driver write what they have to say.

    Raises:
        UsageError: `live` with an address that is not loopback; the cell's extra is missing.
        ControllerError: the controller does not start, or nobody answers.
    """
    with ExitStack() as stack:
        if address is not None and live and not is_loopback(address):
            raise UsageError(
                f"--live would move the arm at {address}, but the percepts would come from the "
                "simulated cell. A real arm is never moved on simulated beliefs: leave --live out "
                "for a dry run, or give a loopback address for a stand-in controller"
            )
        cell = stack.enter_context(_closing(Cell(config.model, seed)))
        driver, feel, words = _body(stack, config, parts, address, clock, log)
        stack.callback(driver.close)
        yield Workplace(driver, CellSource(cell, feel), cell, words)


def _body(
    stack: ExitStack,
    config: RobotConfig,
    parts: Mapping[str, PartModel],
    address: str | None,
    clock: float,
    log: Path | None,
) -> tuple[Driver, Callable[[bool], None], str]:
    """Give the driver, the wire to its gripper's sensor, and a sentence on what it drives."""
    if address is not None and not is_loopback(address):
        dry = DryRunDriver(config, parts)
        return dry, dry.feel, f"dry run: a virtual {config.model}; nothing is sent to {address}"
    if address is None:
        controller = stack.enter_context(
            ControllerProcess.start(
                config.model,
                clock=clock,
                joints=config.look_joints,
                log=None if log is None else log.with_suffix(".controller.log"),
            )
        )
        address, wire = controller.address, controller.set_tool_input
    else:
        bench = BenchClient(address)
        stack.callback(bench.close)
        wire = bench.set_tool_input
    note = None if log is None else stack.enter_context(_log_file(log.with_suffix(".driver.log")))
    driver = UrDriver(address, config, parts, log=note)
    words = f"simulated cell; stand-in controller (not a robot) at {address}"
    return driver, lambda on: wire(config.gripper.input, on), words


@contextmanager
def _log_file(path: Path) -> Iterator[Callable[[str], None]]:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="utf-8", buffering=1) as file:
        yield lambda line: print(line, file=file)


@contextmanager
def _closing(cell: Cell) -> Iterator[Cell]:
    try:
        yield cell
    finally:
        cell.close()


def connect(
    address: str,
    robot: str | Path = "ur5",
    *,
    live: bool = False,
    log: Callable[[str], None] | None = None,
) -> Driver:
    """Give the driver for the controller at an address. Close it when done.

    Args:
        address: The controller's host. Behind an address that is not loopback may be a real arm.
        robot: A robot's name or configuration file.
        live: Say so if a real arm is to move; without it, such an address gets a dry run.
        log: Called with each line the client or the driver has to say.

    Raises:
        ConfigError: the robot's configuration is wrong.
        DriverError: nobody answers, or the controller is not fit to be driven.
    """
    config, parts = load_robot(robot), load_parts()
    if live or is_loopback(address):
        return UrDriver(address, config, parts, log=log)
    return DryRunDriver(config, parts)
