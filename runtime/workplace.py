"""A workplace: a driver with its arm, and a source of percepts, put together for one run."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from runtime.addresses import is_loopback
from runtime.cell import Cell, CellParameters
from runtime.cell.contact import Contact
from runtime.cell_source import CellSource, Wires
from runtime.config import RobotConfig, load_robot
from runtime.controller.bench_client import BenchClient, BenchTeller
from runtime.controller.process import ControllerProcess
from runtime.drivers import Driver, DryRunDriver, UrDriver
from runtime.errors import ControllerError, UsageError
from runtime.kinematics import Joints
from runtime.parts import PartModel, load_parts

_FELT_WITHIN_S: Final = 5.0
_FEEL_EVERY_S: Final = 0.01


@dataclass(frozen=True, slots=True)
class Workplace:
    """What a run needs of the world.

    Args:
        driver: The body.
        source: Where percepts come from.
        cell: The simulated cell, whose ground truth may judge a run and never enters it.
        controller: The stand-in controller that was started for the run, or None.
        words: A sentence that says what this is, for the person who watches.
    """

    driver: Driver
    source: CellSource
    cell: Cell
    words: str
    controller: ControllerProcess | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class Setting:
    """What the simulated part of a workplace is like.

    Args:
        seed: Of the scene and the detector's noise.
        clock: Robot seconds per second of the stand-in that is started.
        cell: Everything else about the cell; None for the usual.
        faults: What goes wrong with the stand-in, and when: see `runtime.controller.faults`.
        joints: Where the arm stands at first, rad; None for its look pose.
        gripper_closed: Whether its gripper is closed at first.
        world: Where the cell's things are at first, as `Cell.snapshot` gave it; None for the
            layout of the seed.
    """

    seed: int = 0
    clock: float = 1.0
    cell: CellParameters | None = None
    faults: Sequence[Mapping[str, object]] = ()
    joints: Joints | None = None
    gripper_closed: bool = False
    world: Mapping[str, object] | None = None


@contextmanager
def open_workplace(
    config: RobotConfig,
    parts: Mapping[str, PartModel],
    *,
    address: str | None = None,
    live: bool = False,
    setting: Setting | None = None,
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
        setting: What the simulated part is like.
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
        setting = setting or Setting()
        cell = stack.enter_context(_closing(Cell(config.model, setting.seed, setting.cell)))
        if setting.world is not None:
            cell.restore(setting.world)
        body = _body(stack, config, parts, address, setting, log)
        stack.callback(body.driver.close)
        source = CellSource(cell, body.wires)
        if setting.gripper_closed:
            _feel_first(body.driver, source)
        yield Workplace(body.driver, source, cell, body.words, body.controller)


def _feel_first(driver: Driver, source: CellSource) -> None:
    """Wait until the gripper's sensor shows what closed fingers hold, before anybody looks.

    Raises:
        ControllerError: the sensor does not show it.
    """
    source.update(driver.state())
    deadline = time.monotonic() + _FELT_WITHIN_S
    while driver.state().gripped != source.gripped:
        if time.monotonic() > deadline:
            raise ControllerError(
                "the gripper's sensor does not show what the fingers hold; is the controller "
                "overloaded?"
            )
        time.sleep(_FEEL_EVERY_S)


@dataclass(frozen=True, slots=True)
class _Body:
    """A driver, the wires from the cell to what it drives, and a sentence on what that is."""

    driver: Driver
    wires: Wires
    words: str
    controller: ControllerProcess | None = None


def _body(
    stack: ExitStack,
    config: RobotConfig,
    parts: Mapping[str, PartModel],
    address: str | None,
    setting: Setting,
    log: Path | None,
) -> _Body:
    joints = config.look_joints if setting.joints is None else setting.joints
    if address is not None and not is_loopback(address):
        dry = DryRunDriver(config, parts, joints=joints)
        words = f"dry run: a virtual {config.model}; nothing is sent to {address}"
        return _Body(dry, Wires(dry.feel), words)
    controller, bench = None, None
    if address is None:
        controller = stack.enter_context(
            ControllerProcess.start(
                config.model,
                clock=setting.clock,
                joints=joints,
                faults=setting.faults,
                seed=setting.seed,
                log=None if log is None else log.with_suffix(".controller.log"),
            )
        )
        address, bench = controller.address, controller.bench
    else:
        client = BenchClient(address)
        stack.callback(client.close)
        bench = client.request
    if setting.gripper_closed:
        bench({"outputs": {f"tool_digital_out_{config.gripper.output}": True}})
    note = None if log is None else stack.enter_context(_log_file(log.with_suffix(".driver.log")))
    driver = UrDriver(address, config, parts, log=note)
    teller = BenchTeller(address, {"followed": True})
    stack.callback(teller.close)
    words = f"simulated cell; stand-in controller (not a robot) at {address}"
    return _Body(driver, _wires(bench, teller, config), words, controller)


def _wires(
    bench: Callable[[Mapping[str, object]], object], teller: BenchTeller, config: RobotConfig
) -> Wires:
    """Wire the cell to a stand-in controller's bench."""
    sensor = f"tool_digital_in_{config.gripper.input}"

    def feel(on: bool) -> None:  # noqa: FBT001 - a sensor's level
        bench({"inputs": {sensor: on}})

    def touch(contact: Contact | None) -> None:
        bench({"contact": None if contact is None else contact.request()})

    return Wires(feel, touch, teller.tell)


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
