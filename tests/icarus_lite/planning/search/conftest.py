"""Problems without variables, written by hand or drawn at random, and a search that is sure."""

from __future__ import annotations

import random
from collections import deque

import pytest

from icarus_lite.inference import change_of
from icarus_lite.language.syntax import Atom, SkillClause
from icarus_lite.planning.ground_task import GroundAtom, GroundOperator, GroundRule, GroundTask
from icarus_lite.planning.steps import PlanStep
from icarus_lite.symbols import Action, Belief


class Problems:
    """Makes problems, follows plans, and knows the shortest ones of small problems."""

    @staticmethod
    def of(initial, goal, operators, rules=(), **more):
        """Build a problem: operators are (name, conditions, adds, deletes), all in words."""
        words = sorted(
            {*initial.split(), *goal.split()}
            | {word for op in operators for field in op[1:] for word in field.split()}
            | {word for head, body in rules for word in (head, *body.split())}
        )
        number = {word: position for position, word in enumerate(words)}

        def numbers(text):
            return tuple(number[word] for word in text.split())

        def mask(text):
            return sum(1 << each for each in set(numbers(text)))

        full = (1 << len(words)) - 1
        return GroundTask(
            tuple(GroundAtom(Belief(word)) for word in words),
            mask(initial),
            numbers(goal),
            tuple(
                GroundOperator(
                    Problems.step(name),
                    numbers(wants),
                    mask(adds),
                    full & ~mask(deletes) | mask(adds),
                    mask(adds),
                )
                for name, wants, adds, deletes in operators
            ),
            tuple(GroundRule(number[head], numbers(body)) for head, body in rules),
            **more,
        )

    @staticmethod
    def step(name):
        clause = SkillClause(Atom(name))
        return PlanStep(Action(name), (Action(name),), clause, (), change_of((), {}))

    @staticmethod
    def drawn(seed):
        """Draw a problem of eight atoms and a dozen operators; some have no plan."""
        chance = random.Random(seed)
        atoms = [f"a{number}" for number in range(8)]

        def some(least, most):
            return " ".join(chance.sample(atoms, chance.randint(least, most)))

        operators = [(f"o{n}", some(0, 3), some(1, 2), some(0, 3)) for n in range(12)]
        return Problems.of(some(0, 3), some(1, 3), operators)

    @staticmethod
    def blocks(seed, count):
        """Draw a problem of the blocks world: towers to be built from other towers."""
        chance = random.Random(seed)
        names = [f"b{number}" for number in range(count)]

        def towers():
            order = chance.sample(names, count)
            facts = []
            for position, name in enumerate(order):
                under = order[position - 1] if position and chance.random() < 0.7 else None
                facts.append((name, under))
            return facts

        start, end = towers(), towers()
        covered = {under for _, under in start}
        initial = ["hand", *(f"clear-{name}" for name in names if name not in covered)]
        initial += [f"{name}-on-{under}" if under else f"table-{name}" for name, under in start]
        goal = [f"{name}-on-{under}" if under else f"table-{name}" for name, under in end]
        operators = []
        for a in names:
            operators += [
                (
                    f"take-{a}",
                    f"clear-{a} table-{a} hand",
                    f"held-{a}",
                    f"hand table-{a} clear-{a}",
                ),
                (f"put-{a}", f"held-{a}", f"hand table-{a} clear-{a}", f"held-{a}"),
            ]
            for b in names:
                if a != b:
                    on, lifted = f"{a}-on-{b}", f"held-{a} clear-{b}"
                    rest = f"hand {on} clear-{a}"
                    operators += [
                        (f"lift-{a}-{b}", rest, lifted, rest),
                        (f"stack-{a}-{b}", lifted, rest, lifted),
                    ]
        return Problems.of(" ".join(initial), " ".join(goal), operators)

    @staticmethod
    def balls(count):
        """Give the problem of carrying balls to another room with two hands."""
        operators = [("to-b", "in-a", "in-b", "in-a"), ("to-a", "in-b", "in-a", "in-b")]
        for ball in range(count):
            for hand in ("left", "right"):
                for room in "ab":
                    there, held = f"ball{ball}-{room}", f"ball{ball}-{hand}"
                    operators += [
                        (
                            f"take-{held}-{room}",
                            f"in-{room} {there} {hand}",
                            held,
                            f"{there} {hand}",
                        ),
                        (f"drop-{held}-{room}", f"in-{room} {held}", f"{there} {hand}", held),
                    ]
        initial = " ".join(["in-a left right", *(f"ball{ball}-a" for ball in range(count))])
        return Problems.of(initial, " ".join(f"ball{ball}-b" for ball in range(count)), operators)

    @staticmethod
    def leads_to_the_goal(task, plan):
        """Follow a plan; tell whether each step can start and the goal holds in the end."""
        state = task.initial
        for step in plan:
            operator = task.operators[step]
            if not all(state >> atom & 1 for atom in operator.conditions):
                return False
            state = task.after(state, operator)
        return task.reached(state)

    @staticmethod
    def shortest(task):
        """Give the length of a shortest plan, by looking at everything; None if there is none."""
        depth = {task.initial: 0}
        line = deque([task.initial])
        while line:
            state = line.popleft()
            if task.reached(state):
                return depth[state]
            for operator in task.operators:
                if all(state >> atom & 1 for atom in operator.conditions):
                    following = task.after(state, operator)
                    if following not in depth:
                        depth[following] = depth[state] + 1
                        line.append(following)
        return None


@pytest.fixture(scope="session")
def problems():
    """Give the maker of problems."""
    return Problems
