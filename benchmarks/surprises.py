"""Plans in worlds that others change: how many survive how many surprises?

    python benchmarks/surprises.py --runs 200 --out docs/results/surprises.md

An adversary changes the world with a given probability in each cycle, between one action of the
agent and the next: in the blocks world it moves a block that nothing stands on, in the corridor a
ball that nobody holds. A share of its moves is what the agent itself would have to do. Percepts
follow from the physics of the worlds below, which know nothing of plans, effects or beliefs.
"""

from __future__ import annotations

import argparse
import random
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Protocol

from icarus_lite import Action, Agent, DecisionKind, Outcome, Percept, Status, load_domain
from icarus_lite.language.syntax import Domain

DOMAINS = Path(__file__).resolve().parents[1] / "domains"
SIZE_M = 0.05
_HEADER = """\
# Plans and surprises

Made by `make bench-surprises`: {runs} runs a row, seeds 0 to {last}, an adversary that acts with
probability {probability:g} in each cycle, at most {cycles} cycles a run. All goals stay reachable
whatever it does. *Helpful*: the share of its moves that the agent would have had to make itself.

A *surprise* is a cycle, with nothing under way, in which beliefs are not as the plan has them.
*Kept*: the plan goes on as it is; *repaired*: it goes on from a later step, from an earlier one, or
without the steps that are done or cannot start and are not needed any longer;
*replanned*: no rest of it works. Without monitoring each surprise would cost a plan. *Survived* is
the share of surprises that did not.

""".splitlines()
_COLUMNS = (
    "world",
    "helpful",
    "reached",
    "moves",
    "surprises",
    "kept",
    "repaired",
    "replanned",
    "survived",
    "plans",
    "actions a run",
    "ms a cycle",
)


class World(Protocol):
    """A world with an agent's body in it, and somebody else."""

    goals: Sequence[str]

    def percepts(self) -> list[Percept]:
        """Give what is seen."""

    def carry_out(self, command: Action) -> bool:
        """Carry a command out; tell whether physics allows it."""

    def meddle(self, rng: random.Random, *, helpful: bool) -> bool:
        """Let somebody change something; tell whether there was anything to change."""


@dataclass
class Blocks:
    """Towers on a table and one hand; a tower with the blocks of the goal in order is wanted."""

    towers: list[list[str]]
    held: str | None = None
    goals: Sequence[str] = ("(on a b)", "(on b c)")

    @classmethod
    def drawn(cls, rng: random.Random) -> Blocks:
        """Put six blocks anyhow."""
        towers: list[list[str]] = []
        names = list("abcdef")
        rng.shuffle(names)
        for name in names:
            if towers and rng.random() < 0.6:
                rng.choice(towers).append(name)
            else:
                towers.append([name])
        return cls(towers)

    def percepts(self) -> list[Percept]:
        """Give the blocks with their places, the table and the hand."""
        holding = {} if self.held is None else {"holding": self.held}
        seen = [Percept("table", "t", {"y": 0.0}), Percept("hand", "hand1", holding)]
        places = {
            block: (0.1 * column, SIZE_M * row)
            for column, tower in enumerate(self.towers)
            for row, block in enumerate(tower)
        }
        if self.held is not None:
            places[self.held] = (-1.0, 1.0)
        for block, (x, y) in sorted(places.items()):
            seen.append(Percept("block", block, {"x": x, "y": y, "height": SIZE_M}))
        return seen

    def carry_out(self, command: Action) -> bool:
        """Grasp a block from the top of a tower, or place the one that is held."""
        _, block, *place = map(str, command.args)
        if command.name == "grasp":
            if self.held is not None or not self._lift(block):
                return False
            self.held = block
            return True
        if self.held != block or not self._put(block, place[0]):
            return False
        self.held = None
        return True

    def meddle(self, rng: random.Random, *, helpful: bool) -> bool:
        """Move a block from the top of a tower, where the goal wants it or anywhere else."""
        tops = [tower[-1] for tower in self.towers]
        if not tops:
            return False
        block, place = rng.choice(tops), "t"
        others = [top for top in tops if top != block]
        if rng.random() < 0.7 and others:
            place = rng.choice(others)
        if helpful:
            wanted = [(b, p) for b, p in (("b", "c"), ("a", "b")) if {b, p} <= set(tops)]
            if not wanted:
                return False
            block, place = wanted[0]
        return self._lift(block) and self._put(block, place)

    def _lift(self, block: str) -> bool:
        for tower in self.towers:
            if tower[-1] == block:
                tower.pop()
                self.towers = [each for each in self.towers if each]
                return True
        return False

    def _put(self, block: str, place: str) -> bool:
        if place == "t":
            self.towers.append([block])
            return True
        for tower in self.towers:
            if tower[-1] == place:
                tower.append(block)
                return True
        return False


@dataclass
class Corridor:
    """Two rooms, balls, and a robot with two grippers."""

    balls: dict[str, str]
    room: str = "hall"
    held: dict[str, str] = field(default_factory=dict)
    goals: Sequence[str] = tuple(f"(lies-in ball{i} kitchen)" for i in range(1, 5))

    @classmethod
    def drawn(cls, rng: random.Random) -> Corridor:
        """Put four balls anyhow."""
        rooms = ("hall", "kitchen")
        return cls({f"ball{i}": rng.choice(rooms) for i in range(1, 5)}, rng.choice(rooms))

    def percepts(self) -> list[Percept]:
        """Give rooms, robot, grippers and balls."""
        middle = {"hall": 2.0, "kitchen": 6.0}
        seen = [
            Percept("room", "hall", {"left": 0, "right": 4}),
            Percept("room", "kitchen", {"left": 4.1, "right": 8}),
            Percept("robot", "robby", {"x": middle[self.room]}),
            Percept("gripper", "left"),
            Percept("gripper", "right"),
        ]
        return [*seen, *(Percept("ball", b, {"x": middle[r]}) for b, r in self.balls.items())]

    def carry_out(self, command: Action) -> bool:
        """Drive, close a gripper on a ball, or open it."""
        if command.name == "drive":
            self.room = str(command.args[1])
            for ball in self.held.values():
                self.balls[ball] = self.room
            return True
        gripper = str(command.args[0])
        if command.name == "open":
            return self.held.pop(gripper, None) is not None
        ball = str(command.args[1])
        free = gripper not in self.held and ball not in self.held.values()
        if not free or self.balls[ball] != self.room:
            return False
        self.held[gripper] = ball
        return True

    def meddle(self, rng: random.Random, *, helpful: bool) -> bool:
        """Carry a ball that nobody holds to the other room: from the hall, if that helps."""
        lying = [ball for ball in self.balls if ball not in self.held.values()]
        if helpful:
            lying = [ball for ball in lying if self.balls[ball] == "hall"]
        if not lying:
            return False
        ball = rng.choice(lying)
        self.balls[ball] = "kitchen" if self.balls[ball] == "hall" else "hall"
        return True


@dataclass
class Tally:
    """What came of all runs of a row."""

    runs: int = 0
    reached: int = 0
    moves: int = 0
    surprises: int = 0
    kept: int = 0
    repaired: int = 0
    replanned: int = 0
    plans: int = 0
    actions: int = 0
    cycles: int = 0
    seconds: float = 0.0

    def row(self, world: str, helpful: float) -> str:
        """Give the row of the table."""
        survived = (self.kept + self.repaired) / max(self.surprises, 1)
        cells = [
            world,
            f"{helpful:.0%}",
            f"{self.reached} of {self.runs}",
            f"{self.moves:,}",
            f"{self.surprises:,}",
            f"{self.kept:,}",
            f"{self.repaired:,}",
            f"{self.replanned:,}",
            f"{survived:.0%}",
            f"{self.plans:,}",
            f"{self.actions / max(self.runs, 1):.1f}",
            f"{1e3 * self.seconds / max(self.cycles, 1):.1f}",
        ]
        return f"| {' | '.join(cells)} |"


def run(
    domain: Domain, world: World, rng: random.Random, tally: Tally, options: argparse.Namespace
) -> None:
    """Let an agent pursue the goals of a world until it reaches them, or is out of cycles."""
    agent, outcome = Agent(domain, world.goals), None
    tally.runs += 1
    for _ in range(options.cycles):
        seen, begin = world.percepts(), time.process_time()
        decision = agent.cycle(seen, outcome)
        tally.seconds += time.process_time() - begin
        tally.cycles += 1
        outcome = None
        if decision.kind is DecisionKind.ACHIEVED:
            tally.reached += 1
            break
        if decision.action is not None:
            (command,) = decision.commands
            tally.actions += 1
            done = world.carry_out(command)
            status = Status.SUCCEEDED if done else Status.FAILED
            outcome = Outcome(decision.action, status, "" if done else "it cannot be done")
        if rng.random() < options.probability:
            helpful = rng.random() < options.helpful
            tally.moves += world.meddle(rng, helpful=helpful)
    counts = agent.plan_counts
    tally.plans += counts.made
    tally.surprises += counts.surprises
    tally.kept += counts.kept
    tally.repaired += counts.repaired
    tally.replanned += counts.replanned


def main() -> None:
    """Run everything and write the page."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--runs", type=int, default=200)
    parser.add_argument("--probability", type=float, default=0.2)
    parser.add_argument("--cycles", type=int, default=400)
    parser.add_argument("--out", type=Path)
    options = parser.parse_args()
    lines = [
        line.format(
            runs=options.runs,
            last=options.runs - 1,
            probability=options.probability,
            cycles=options.cycles,
        )
        for line in _HEADER
    ]
    lines += [f"| {' | '.join(_COLUMNS)} |", "|---" + "|---:" * (len(_COLUMNS) - 1) + "|"]
    missed = 0
    for file, kind in (("blocks.icr", Blocks), ("gripper.icr", Corridor)):
        domain = load_domain(DOMAINS / file)
        for helpful in (0.0, 0.5, 1.0):
            options.helpful = helpful
            tally = Tally()
            for seed in range(options.runs):
                rng = random.Random(f"{file} {helpful} {seed}")  # noqa: S311 - repeatable on purpose
                run(domain, kind.drawn(rng), rng, tally, options)
            lines.append(tally.row(kind.__name__.lower(), helpful))
            missed += tally.runs - tally.reached
            print(lines[-1], flush=True)
    lines += ["", f"{missed} runs did not reach their goals." if missed else "Every run did."]
    if options.out is not None:
        options.out.write_text("\n".join(lines) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
