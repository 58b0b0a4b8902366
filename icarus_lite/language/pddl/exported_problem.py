"""The problem of an export: its goal, its objects, and the facts it begins with."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence

from icarus_lite.language.pddl.exported_conditions import Conditions
from icarus_lite.language.pddl.exported_effects import UNTOUCHED
from icarus_lite.language.pddl.scope import RefusedError
from icarus_lite.language.pddl.situation import KnownState
from icarus_lite.language.pddl.syntax import (
    OBJECT,
    And,
    Exists,
    Fact,
    Formula,
    Not,
    Typed,
    conjunction,
    variables_of,
)
from icarus_lite.language.pddl.vocabulary import PddlVocabulary, variable_name
from icarus_lite.language.syntax import Condition, Constant
from icarus_lite.records import dataclass
from icarus_lite.symbols import Value

_MOST_TUPLES = 20_000


@dataclass(frozen=True, slots=True)
class ProblemTranslation:
    """Translates the goal and the state at the start."""

    goals: Sequence[Condition]
    state: KnownState
    names: PddlVocabulary
    conditions: Conditions

    def goal(self) -> Formula:
        """Translate the goal; what it names are objects of the problem, not constants."""
        constants = dict(self.names.constants)
        try:
            body = self.conditions.body("goal", self.goals, (), ())
        except RefusedError:
            return And()  # the reason is in the report, and nothing will be written
        finally:
            self.names.constants.clear()
            self.names.constants.update(constants)
        if body is None:
            return self._impossible()
        local = tuple(Typed(variable_name(name), kind) for name, kind in body.types.items())
        mentioned = {name for part in body.parts for name in variables_of(part)}
        used = tuple(variable for variable in local if variable.name in mentioned)
        formula = conjunction(body.parts)
        return Exists(used, formula) if used else formula

    def facts(self) -> tuple[Fact, ...]:
        """Give the facts of every predicate used that no rule derives."""
        self._perceived()
        found = [
            Fact(name, tuple(map(self.names.object, row)))
            for name in self.names.used
            for row in self._rows(name)
        ]
        return (*found, *self._untouched())

    def objects(self) -> tuple[Value, ...]:
        """Give all objects: what is perceived first, then whatever else is spoken of."""
        return tuple(dict.fromkeys((*self._perceived(), *self.names.objects)))

    def _perceived(self) -> dict[Value, None]:
        types = self.names.kinds.types
        found = {fact.args[0]: None for fact in self.state.facts if fact.predicate in types}
        for value in found:
            self.names.object(value)
        return found

    def _rows(self, name: str) -> Sequence[tuple[Value, ...]]:
        if name in self.names.rows:
            return self.names.rows[name]
        source = self.names.source_of(name)
        if source is None or source in self.names.kinds.derived:
            return ()
        return [fact.args for fact in self.state.facts if fact.predicate == source]

    def _untouched(self) -> Iterator[Fact]:
        """Let everything that can be derived be derived, until an effect speaks against it."""
        for source in sorted(self.names.kinds.overruled):
            name = self.names.fresh_predicate(f"{source} {UNTOUCHED}", f"{source}-{UNTOUCHED}")
            if name not in self.names.used:
                continue
            head = self.names.kinds.definitions[source][0].head
            columns = [list(self.names.values.at(source, i)) for i in range(len(head.args))]
            if math.prod(map(len, columns)) > _MOST_TUPLES:
                hint = "export a task with fewer objects"
                message = f"`{source}` could be true of more than {_MOST_TUPLES} combinations"
                self.conditions.report.error(head.span, "PDDL007", message, hint)
                return
            for row in itertools.product(*columns):
                yield Fact(name, tuple(map(self.names.object, row)))

    def _impossible(self) -> Formula:
        """Write a goal that nothing can reach as it stands, so that the reader sees it."""
        parts: list[Formula] = []
        variables: dict[str, None] = {}
        for goal in self.goals:
            types = [
                self.names.type_of_value(t.value) if isinstance(t, Constant) else OBJECT
                for t in goal.atom.args
            ]
            terms = [
                self.names.object(t.value) if isinstance(t, Constant) else self.names.term(t)
                for t in goal.atom.args
            ]
            variables.update((term, None) for term in terms if term.startswith("?"))
            fact = self.names.fact(self.names.predicate(goal.atom.predicate), terms, types)
            parts.append(Not(fact) if goal.negated else fact)
        message = "nothing that skills can do reaches this goal from the state it is exported with"
        self.conditions.report.note(self.goals[0].span, "PDDL017", message)
        formula = conjunction(parts)
        return Exists(tuple(map(Typed, variables)), formula) if variables else formula
