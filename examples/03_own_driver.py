"""A body of one's own: whatever has these six members carries a domain's actions out.

This one has no arm to wait for: its tool is at once where it is ordered. The cell shows what comes
of that. Run it from the project's folder: python examples/03_own_driver.py
"""

from collections.abc import Mapping, Sequence

from aapa import Anchor, Anchoring
from icarus_lite import Action, Agent, Outcome, Status, load_domain
from runtime.cell import PERFECT, Cell, CellParameters
from runtime.cell_source import CellSource, Wires
from runtime.config import load_robot
from runtime.drivers import ArmState
from runtime.drivers.limits import arm_solutions, tcp_matrix
from runtime.kinematics import matrix_to_pose
from runtime.loop import Loop
from runtime.parts import load_parts
from runtime.run import anchoring_parameters

config, parts = load_robot("ur5"), load_parts()


class JumpingArm:
    """A `Driver` whose arm jumps, one order a cycle."""

    commands = frozenset({"grasp", "insert", "rest"})

    def __init__(self) -> None:
        """Begin at the look pose: joint angles, gripper closed, force downward."""
        self.now = (config.look_joints, False, 0.0)
        self.time_s, self.gripped = 0.0, False
        self.action: Action | None = None
        self.orders: list[tuple[tuple[float, ...], bool, float]] = []

    def state(self) -> ArmState:
        """Say where the arm is."""
        joints, closed, force_n = self.now
        pose = matrix_to_pose(tcp_matrix(config, joints))
        return ArmState(joints, pose, closed, self.gripped, self.time_s, force_n)

    def start(
        self, action: Action, commands: Sequence[Action], anchors: Mapping[str, Anchor]
    ) -> None:
        """Work out where to be, cycle by cycle."""
        self.action, self.orders = action, []
        for command in commands:
            takes = command.name == "grasp"
            objects = [anchors[str(name)] for name in command.args[1:]]
            if objects:
                part, tool = parts[objects[0].type], tcp_matrix(config, config.look_joints)
                offset = (0.0, 0.0, 0.0) if takes else part.seats[0].offset
                tool[:3, 3] = [a + b for a, b in zip(objects[-1].position, offset, strict=True)]
                tool[2, 3] += part.grasp_height_m
                joints = arm_solutions(config, tool, config.look_joints)[0]
                self.orders += [(joints, not takes, 15.0), (joints, takes, 0.0)]
            self.orders.append((config.look_joints, takes, 0.0))

    def poll(self, _anchors: Mapping[str, Anchor]) -> Outcome | None:
        """Do the next order."""
        self.time_s += 0.1
        if self.orders:
            self.now = self.orders.pop(0)
            return Outcome(self.action, Status.RUNNING)
        action, self.action = self.action, None
        return None if action is None else Outcome(action)

    def stop(self) -> None:
        """Forget what was ordered."""
        self.action, self.orders = None, []

    close = stop


with Cell("ur5", seed=2, parameters=CellParameters(detector=PERFECT)) as cell:
    driver = JumpingArm()
    source = CellSource(cell, Wires(lambda on: setattr(driver, "gripped", on)))
    agent = Agent(load_domain("domains/gearbox.icr"), ["(attached hubcover case)"])
    result = Loop(agent, Anchoring(anchoring_parameters()), driver, source, config).run()
    print("achieved:" if result.achieved else "failed:", result.reason)
    print("truly seated:", dict(cell.truth.seated))
