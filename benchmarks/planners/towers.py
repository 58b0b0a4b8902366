"""Blocks problems carried out by skills alone: an agent, a simulated table, and its actions."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path

from icarus_lite import Action, Agent, DecisionKind, Outcome, Percept, Status, load_domain
from icarus_lite.language.fragments import parse_atom
from planners.validation import part, read

DOMAIN = Path(__file__).with_name("towers.icr")
MOST_CYCLES = 2_000
HAND, TABLE = "hand1", "table"


@dataclass
class Table:
    """What stands on what; physics that knows nothing of skills.

    Args:
        under: What each block stands on; a block that is held is missing.
        held: The block in the hand.
        done: The actions carried out, in the words of the PDDL domain.
    """

    under: dict[str, str]
    held: str | None = None
    done: list[tuple[str, ...]] = field(default_factory=list)

    def percepts(self, blocks: list[str]) -> list[Percept]:
        """Give the table, the hand and the blocks."""
        hand = {} if self.held is None else {"holding": self.held}
        seen = [Percept("table", TABLE), Percept("hand", HAND, hand)]
        for block in blocks:
            on = {"on": self.under[block]} if block in self.under else {}
            seen.append(Percept("block", block, on))
        return seen

    def carry_out(self, command: Action) -> None:
        """Carry a command out.

        Raises:
            ValueError: physics does not allow it.
        """
        block, *place = map(str, command.args)
        if command.name in ("unstack", "pick-up"):
            where = self.under.get(block)
            free = self.held is None and block not in self.under.values()
            if not free or where != (place[0] if place else TABLE):
                raise ValueError(f"{command} cannot be done")
            self.held = block
            del self.under[block]
        else:
            where = place[0] if place else TABLE
            taken = where != TABLE and (where not in self.under or where in self.under.values())
            if self.held != block or taken:
                raise ValueError(f"{command} cannot be done")
            self.held = None
            self.under[block] = where
        self.done.append((command.name, *map(str, command.args)))


def by_skills(problem: Path) -> list[tuple[str, ...]]:
    """Let an agent solve a PDDL problem of the blocks world by its skills; give its actions.

    Raises:
        RuntimeError: the agent ended without reaching the goal, or asked planning.
    """
    sections = read(problem)[2:]
    start = [tuple(map(str, fact)) for fact in part(sections, ":init")]
    goal = [tuple(map(str, fact)) for fact in part(sections, ":goal")[0][1:]]
    table = Table({fact[1]: fact[2] for fact in start if fact[0] == "on"})
    table.under |= {fact[1]: TABLE for fact in start if fact[0] == "ontable"}
    blocks = sorted(table.under)
    places = [fact[1:] for fact in goal if fact[0] == "on"]
    places += [(fact[1], TABLE) for fact in goal if fact[0] == "ontable"]
    belongs = [parse_atom(f"(belongs {block} {place})") for block, place in places]
    agent = Agent(load_domain(DOMAIN), goals=[f"(in-order {HAND})"], given=belongs)
    outcome: Outcome | None = None
    for _ in range(MOST_CYCLES):
        decision = agent.cycle(table.percepts(blocks), outcome)
        if decision.kind is DecisionKind.ACHIEVED:
            return table.done
        if decision.action is None or decision.plan is not None:
            raise RuntimeError(f"{problem}: {decision.kind.value}, {decision.reason}")
        for command in decision.commands:
            table.carry_out(command)
        outcome = Outcome(decision.action, Status.SUCCEEDED)
    raise RuntimeError(f"{problem}: not done after {MOST_CYCLES} cycles")
