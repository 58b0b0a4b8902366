"""Concepts as derived predicates: one rule for each clause."""

from __future__ import annotations

from collections.abc import Iterator

from icarus_lite.language.pddl.exported_conditions import Body, Conditions
from icarus_lite.language.pddl.exported_effects import ASSERTED, CIRCLE, UNTOUCHED
from icarus_lite.language.pddl.scope import RefusedError
from icarus_lite.language.pddl.syntax import (
    And,
    Equal,
    Exists,
    Fact,
    Formula,
    Rule,
    Typed,
    conjunction,
)
from icarus_lite.language.pddl.vocabulary import PddlVocabulary, variable_name
from icarus_lite.language.syntax import ConceptClause, Constant
from icarus_lite.records import dataclass
from icarus_lite.symbols import ATTACHED


@dataclass(frozen=True, slots=True)
class Rules:
    """Translates the concepts that actions and the goal have asked for."""

    names: PddlVocabulary
    conditions: Conditions

    def all(self) -> tuple[Rule, ...]:
        """Give the rules of all derived predicates that are used, directly or through others."""
        rules: list[Rule] = []
        done: set[str] = set()
        waiting = True
        while waiting:
            waiting = False
            for used in self.names.used:
                source = self.names.source_of(used)
                if used in done or source not in self.names.kinds.derived:
                    continue
                done.add(used)
                waiting = True
                for clause in self.names.kinds.definitions[source]:
                    try:
                        rules += self._rule(used, clause)
                    except RefusedError:
                        continue  # so that everything that cannot be exported is told at once
                if source in self.names.kinds.overruled:
                    rules += self._asserted(used, source)
        return (*rules, *self._circle_rules())

    def _rule(self, name: str, clause: ConceptClause) -> Iterator[Rule]:
        head = clause.head
        if clause.binds or head.attributes:
            message = f"`{head.predicate}` depends on what skills change and has an attribute"
            raise self.conditions.refuse(head, message, "PDDL cannot say it; use an argument")
        body = self.conditions.body(head.predicate, clause.elements, clause.tests, head.variables)
        if body is None:
            return
        parameters, equations = self._head(clause, body)
        parts = [*equations, *body.parts]
        if head.predicate in self.names.kinds.overruled:
            key = f"{head.predicate} {UNTOUCHED}"
            fresh = self.names.fresh_predicate(key, f"{head.predicate}-{UNTOUCHED}")
            parts.append(
                self.names.fact(fresh, [p.name for p in parameters], [p.type for p in parameters])
            )
        self.names.fact(name, [p.name for p in parameters], [p.type for p in parameters])
        bound = {p.name for p in parameters}
        local = tuple(
            Typed(variable_name(v), t)
            for v, t in body.types.items()
            if variable_name(v) not in bound
        )
        formula = conjunction(tuple(parts))
        yield Rule(name, parameters, Exists(local, formula) if local else formula)

    def _head(self, clause: ConceptClause, body: Body) -> tuple[tuple[Typed, ...], list[Formula]]:
        """Give a rule's parameters, all different, and what that makes necessary."""
        parameters: list[Typed] = []
        equations: list[Formula] = []
        for place, term in enumerate(clause.head.args):
            name = self.names.term(term)
            kind = (
                self.names.type_of_value(term.value)
                if isinstance(term, Constant)
                else body.types[term.name]
            )
            if isinstance(term, Constant) or name in {p.name for p in parameters}:
                fresh = f"?arg{place + 1}"
                equations.append(Equal(fresh, name))
                name = fresh
            parameters.append(Typed(name, kind))
        return tuple(parameters), equations

    def _asserted(self, name: str, source: str) -> Iterator[Rule]:
        """Let what an effect has stated hold until another effect ends it."""
        key = f"{source} {ASSERTED}"
        fresh = self.names.fresh_predicate(key, f"{source}-{ASSERTED}")
        if fresh not in self.names.used:
            return
        declared = next(p for p in self.names.predicates() if p.name == fresh).parameters
        terms, types = [p.name for p in declared], [p.type for p in declared]
        self.names.fact(name, terms, types)
        yield Rule(name, declared, Fact(fresh, tuple(terms)))

    def _circle_rules(self) -> Iterator[Rule]:
        name = self.names.fresh_predicate(CIRCLE, CIRCLE)
        if name not in self.names.used:
            return
        types = self.names.values
        child = self.names.type_of_values(types.at(ATTACHED, 0))
        parent = self.names.type_of_values(types.at(ATTACHED, 1))
        wide = self.names.common_type([child, parent])
        attached = self.names.predicate(ATTACHED)
        head = (Typed("?a", child), Typed("?b", parent))
        between = Typed("?c", wide)
        self.names.fact(name, ("?a", "?b"), (child, parent))
        self.names.fact(name, ("?c", "?b"), (wide, parent))
        direct = self.names.fact(attached, ("?a", "?b"), (child, parent))
        first = self.names.fact(attached, ("?a", "?c"), (child, wide))
        yield Rule(name, head, direct)
        yield Rule(name, head, Exists((between,), And((first, Fact(name, ("?c", "?b"))))))
