"""Small worlds in which skills are carried out: percepts change by physics, not by effects.

None of them knows the domain, the engine or its effects. A command that the world's physics does
not allow changes nothing and is reported as failed.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from icarus_lite import Action, Agent, Decision, DecisionKind, Outcome, Percept, Status

SIZE = 0.05
"""Height of a block in m."""


@dataclass
class BlocksWorld:
    """Towers on one table, and one hand (`hand1`) over it; a block lifted is up in the air."""

    towers: list[list[str]]
    held: str | None = None
    done: list[str] = field(default_factory=list)

    def percepts(self) -> list[Percept]:
        seen = [Percept("table", "t", {"y": 0.0})]
        seen.append(Percept("hand", "hand1", {"holding": self.held} if self.held else {}))
        places = {
            block: (0.1 * column, SIZE * row)
            for column, tower in enumerate(self.towers)
            for row, block in enumerate(tower)
        }
        if self.held:
            places[self.held] = (-1.0, 1.0)
        for block, (x, y) in sorted(places.items()):
            seen.append(Percept("block", block, {"x": x, "y": y, "height": SIZE}))
        return seen

    def carry_out(self, commands: Sequence[Action]) -> bool:
        """Carry commands out; tell whether physics allowed it."""
        (command,) = commands
        self.done.append(str(command))
        _, block, *place = command.args
        if command.name == "grasp":
            return self.lift(str(block))
        return self.held == block and self.set_down(str(place[0]))

    def lift(self, block: str) -> bool:
        column = self.column_of(block)
        if self.held is not None or column is None or self.towers[column][-1] != block:
            return False
        self.towers[column].pop()
        self.held = block
        return True

    def set_down(self, place: str) -> bool:
        if self.held is None:
            return False
        if place == "t":
            free = [i for i, tower in enumerate(self.towers) if not tower]
            column = free[0] if free else len(self.towers)
            self.towers[column : column + 1] = [[self.held]]
        else:
            under = self.column_of(place)
            if under is None or self.towers[under][-1] != place:
                return False
            self.towers[under].append(self.held)
        self.held = None
        return True

    def column_of(self, block: str) -> int | None:
        return next((i for i, tower in enumerate(self.towers) if block in tower), None)


@dataclass
class PegsWorld:
    """Disks on three pegs; physics lets no disk be set on a smaller one."""

    pegs: dict[str, list[int]]
    done: list[str] = field(default_factory=list)

    def percepts(self) -> list[Percept]:
        xs = {peg: 0.2 * i for i, peg in enumerate(sorted(self.pegs))}
        seen = [Percept("peg", peg, {"x": x}) for peg, x in xs.items()]
        for peg, disks in sorted(self.pegs.items()):
            seen += [
                Percept("disk", f"disk{d}", {"x": xs[peg], "diameter": 0.02 + 0.03 * d})
                for d in disks
            ]
        return seen

    def carry_out(self, commands: Sequence[Action]) -> bool:
        (command,) = commands
        self.done.append(str(command))
        disk, source, target = map(str, command.args)
        size = int(disk.removeprefix("disk"))
        if self.pegs[source][-1:] != [size]:
            return False
        if self.pegs[target] and self.pegs[target][-1] < size:
            return False
        self.pegs[target].append(self.pegs[source].pop())
        return True


@dataclass
class HandWorld:
    """A hand over a block; each step lowers it by 2, unless the block is in the way."""

    y: int = 20
    top: int = 10
    done: list[str] = field(default_factory=list)

    def percepts(self) -> list[Percept]:
        return [Percept("hand", "h", {"y": self.y}), Percept("block", "b", {"top": self.top})]

    def carry_out(self, commands: Sequence[Action]) -> bool:
        self.done.extend(map(str, commands))
        if self.y - 2 < self.top:
            return False
        self.y -= 2
        return True


@dataclass
class CorridorWorld:
    """A robot with one gripper and two rooms; what the gripper holds moves with the robot."""

    balls: dict[str, float]
    x: float = 1.0
    held: dict[str, str] = field(default_factory=dict)
    done: list[str] = field(default_factory=list)

    def percepts(self) -> list[Percept]:
        seen = [Percept("room", "hall", {"left": 0, "right": 4})]
        seen.append(Percept("room", "kitchen", {"left": 4.1, "right": 8}))
        seen.append(Percept("robot", "robby", {"x": self.x}))
        seen.append(Percept("gripper", "left"))
        return [*seen, *(Percept("ball", b, {"x": x}) for b, x in sorted(self.balls.items()))]

    def carry_out(self, commands: Sequence[Action]) -> bool:
        (command,) = commands
        self.done.append(str(command))
        if command.name == "drive":
            self.x = 6.0 if command.args[1] == "kitchen" else 2.0
            for ball in self.held.values():
                self.balls[ball] = self.x
            return True
        if command.name == "open":
            self.held.pop(str(command.args[0]), None)
            return True  # a gripper that is empty opens all the same
        gripper, ball = map(str, command.args)
        if self.held or (self.balls[ball] < 4) is not (self.x < 4):
            return False
        self.held[gripper] = ball
        return True


def run(
    world, agent: Agent, *, reports: bool = True, cycles: int = 200, meddle=None, forestall=None
):
    """Let an agent act in a world until it is done or stuck; give all its decisions.

    Args:
        world: One of the worlds above.
        agent: The agent.
        reports: Whether the body reports what became of an action. Without, a step of the
            action is carried out each cycle, as in the classical environments.
        cycles: The most cycles.
        meddle: Called with the world after each action: what others do meanwhile.
        forestall: Called with the world between a decision and its action, which may then no
            longer be possible.
    """
    decisions: list[Decision] = []
    outcome: Outcome | None = None
    for _ in range(cycles):
        decision = agent.cycle(world.percepts(), outcome)
        decisions.append(decision)
        outcome = None
        if decision.kind in (DecisionKind.ACHIEVED, DecisionKind.IMPASSE):
            break
        if forestall is not None:
            forestall(world)
        if decision.action is not None:
            allowed = world.carry_out(decision.commands)
            if reports:
                status = Status.SUCCEEDED if allowed else Status.FAILED
                outcome = Outcome(decision.action, status, "" if allowed else "it cannot be done")
        elif reports and decision.step is not None:
            outcome = Outcome(decision.step.action, Status.FAILED, "stopped")
        if meddle is not None:
            meddle(world)
    return decisions
