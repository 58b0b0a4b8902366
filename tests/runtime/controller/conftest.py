from __future__ import annotations

import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from dashboard_client import DashboardClient
from rtde_control import RTDEControlInterface
from rtde_io import RTDEIOInterface
from rtde_receive import RTDEReceiveInterface

from runtime.controller import ControllerProcess

HOME = (0.0, -1.5, 1.5, -1.5, -1.5, 0.0)


def wait_for(condition: Callable[[], Any], within_s: float = 5.0) -> Any:
    """Wait until a condition holds, and fail when it does not in time."""
    deadline = time.monotonic() + within_s
    while True:
        result = condition()
        if result:
            return result
        if time.monotonic() > deadline:
            raise AssertionError("the condition did not come to hold in time")
        time.sleep(0.002)  # the client's receiver thread starves under a busy loop


class Rig:
    """A stand-in controller under a fast clock, and the real clients connected to it."""

    def __init__(self, model: str) -> None:
        clock = {"ur5": 8, "ur16e": 4}[model]  # what two busy cores keep up with
        self.process = ControllerProcess.start(model, clock=clock, joints=HOME)
        self.receive = RTDEReceiveInterface(self.process.address)
        self.control = RTDEControlInterface(self.process.address)

    def io(self) -> RTDEIOInterface:
        return RTDEIOInterface(self.process.address)

    def dashboard(self) -> DashboardClient:
        client = DashboardClient(self.process.address)
        client.connect()
        return client

    def reached(self, joints, tolerance=1e-6) -> bool:
        """Whether the state stream comes to show the joints."""
        return wait_for(
            lambda: all(
                abs(measured - wanted) <= tolerance
                for measured, wanted in zip(self.receive.getActualQ(), joints, strict=True)
            )
        )

    def state(self) -> dict[str, Any]:
        return self.process.bench({"query": "state"})

    def recover(self) -> None:
        """Bring a stopped arm back: as an operator would, from whatever it was."""
        if self.control.isProgramRunning() and self.state()["safety"] == "NORMAL":
            return
        dashboard = self.dashboard()
        self.process.bench({"fault": {"emergency_stop": False}})

        def unlocked() -> bool:
            try:
                dashboard.unlockProtectiveStop()
            except RuntimeError:
                return False
            return True

        wait_for(unlocked)
        dashboard.stop()
        wait_for(lambda: self.receive.getRuntimeState() == 1)
        dashboard.brakeRelease()
        wait_for(lambda: self.receive.getRobotMode() == 7)
        assert self.control.reuploadScript()
        wait_for(self.control.isProgramRunning)
        wait_for(lambda: not self.receive.isProtectiveStopped())
        dashboard.disconnect()

    def close(self) -> None:
        self.control.disconnect()
        self.receive.disconnect()
        self.process.close()


@pytest.fixture
def wait() -> Callable[..., Any]:
    return wait_for


@pytest.fixture(scope="module", params=["ur5", "ur16e"])
def shared_rig(request) -> Iterator[Rig]:
    """One rig of each model for a module's harmless tests."""
    rig = Rig(request.param)
    yield rig
    rig.close()


@pytest.fixture
def rig(shared_rig) -> Rig:
    """The shared rig, back at its start, its program running, whatever the test before left."""
    shared_rig.process.bench({"contact": None})
    shared_rig.recover()
    assert shared_rig.control.moveJ(HOME, 3.0, 20.0)
    assert shared_rig.reached(HOME)
    return shared_rig


@pytest.fixture(scope="module")
def shared_breakable_rig() -> Iterator[Rig]:
    rig = Rig("ur5")
    yield rig
    rig.close()


@pytest.fixture
def breakable_rig(shared_breakable_rig) -> Rig:
    """A rig whose program and safety a test may break, but not its links.

    The control client reconnects by itself in the background and may crash its process when its
    destructor meets that: links are broken under a `Watcher` only.
    """
    rig = shared_breakable_rig
    rig.recover()
    assert rig.control.moveJ(HOME, 3.0, 20.0)
    assert rig.reached(HOME)
    return rig


class Watcher:
    """A stand-in controller with nothing but a state stream taken from it."""

    def __init__(self) -> None:
        self.process = ControllerProcess.start("ur5", clock=8, joints=HOME)
        self.receive = RTDEReceiveInterface(self.process.address)

    def close(self) -> None:
        self.receive.disconnect()
        self.process.close()


@pytest.fixture
def watcher() -> Iterator[Watcher]:
    """A controller whose links a test may break."""
    watcher = Watcher()
    yield watcher
    watcher.close()
