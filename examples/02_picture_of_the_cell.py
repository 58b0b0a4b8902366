"""A picture of the cell: the arm picks up the hub cover, and its camera shows what is left to see.

Run it from the project's folder: python examples/02_picture_of_the_cell.py [FILE.png]
"""

import sys
from pathlib import Path

from aapa import Anchoring
from icarus_lite import Action, Status
from runtime.cell import PERFECT, Cell, CellParameters
from runtime.cell.picture import Picture, save_png
from runtime.config import load_robot
from runtime.drivers import PARK, DryRunDriver
from runtime.errors import RuntimeFault
from runtime.parts import load_parts
from runtime.percepts import hand_detection
from runtime.run import anchoring_parameters

target = Path(sys.argv[1] if len(sys.argv) > 1 else "cell.png")
config = load_robot("ur5")
driver = DryRunDriver(config, load_parts())
anchoring = Anchoring(anchoring_parameters())

with Cell("ur5", seed=6, parameters=CellParameters(detector=PERFECT)) as cell:

    def see() -> None:
        """Let the scene follow the arm, and anchor what the camera sees."""
        arm = driver.state()
        driver.feel(cell.update(arm.joints, arm.gripper_closed))
        detections, camera = cell.look()
        anchoring.update([*detections, hand_detection(arm, camera, config)], (), camera)

    def carry_out(action: Action, *commands: Action) -> None:
        """Start an action and wait for its end."""
        driver.start(action, commands, {a.name: a for a in anchoring.anchors})
        while (outcome := driver.poll({})) is not None:
            see()
            if outcome.status is not Status.RUNNING:
                print(outcome.action, outcome.status, outcome.reason)
                break

    for _ in range(5):
        see()
    pick_up = Action("pick-up", ("hand1", "hubcover"))
    carry_out(pick_up, Action("grasp", pick_up.args))
    carry_out(PARK, Action("rest", ("hand1",)))
    try:
        with Picture(cell) as picture:
            save_png(picture.portrait(cell.look()[0]), target)
        print("picture:", target)
    except RuntimeFault as reason:
        print("no picture:", reason)
