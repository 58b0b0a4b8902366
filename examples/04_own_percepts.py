"""Eyes of one's own: whatever has `update` and `look` is a source of percepts.

Here a run is recorded, detection by detection, and then run again from the recording alone: the
same beliefs, the same actions. Run it from the project's folder: python examples/04_own_percepts.py
"""

import json
from collections.abc import Callable, Iterable

from aapa import Anchoring, Camera, Detection
from icarus_lite import Agent, load_domain
from runtime.cell import PERFECT, Cell, CellParameters
from runtime.cell.camera import CameraParameters, camera_at
from runtime.cell_source import CellSource, Wires
from runtime.config import load_robot
from runtime.cycle_report import CycleReport
from runtime.drivers import ArmState, Driver, DryRunDriver
from runtime.loop import Loop
from runtime.parts import load_parts
from runtime.run import anchoring_parameters
from runtime.seeing import PerceptSource

config = load_robot("ur5")


class Recording:
    """A `PerceptSource` that shows what was detected in another run, frame by frame."""

    def __init__(self, lines: Iterable[str]) -> None:
        """Take one line of JSON a frame, as they stand in a file."""
        self.frames, self.joints = map(json.loads, lines), config.look_joints

    def update(self, arm: ArmState) -> None:
        """Note where the camera is: in the hand."""
        self.joints = arm.joints

    def look(self) -> tuple[list[Detection], Camera]:
        """Give the next frame."""
        detections = [
            Detection(d["type"], tuple(d["box"]), d["score"], position=tuple(d["position"]))
            for d in next(self.frames, [])
        ]
        return detections, camera_at(config.arm, self.joints, CameraParameters())


def run(
    driver: Driver, source: PerceptSource, *observers: Callable[[CycleReport], None]
) -> tuple[list[str], str]:
    """Run the task on a virtual arm; give the actions and how it ended."""
    agent = Agent(load_domain("domains/gearbox.icr"), ["(attached hubcover case)"])
    anchoring = Anchoring(anchoring_parameters())
    result = Loop(agent, anchoring, driver, source, config, observers=observers).run()
    return [f"{each.action} {each.status}" for each in result.actions], result.reason


lines: list[str] = []


def record(report: CycleReport) -> None:
    """Keep a cycle's detections."""
    rows = [(d.type, d.box, d.score, d.position) for d in report.detections]
    frame = [dict(zip(("type", "box", "score", "position"), row, strict=True)) for row in rows]
    lines.append(json.dumps(frame))


with Cell("ur5", seed=2, parameters=CellParameters(detector=PERFECT)) as cell:
    driver = DryRunDriver(config, load_parts(), dt=0.5)
    seen = run(driver, CellSource(cell, Wires(driver.feel)), record)

again = run(DryRunDriver(config, load_parts(), dt=0.5), Recording(lines))
print("seen:    ", *seen)
print("recorded:", *again)
assert again == seen
