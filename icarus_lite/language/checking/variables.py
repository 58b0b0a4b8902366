"""Is every variable bound before it is used?

Positive elements bind variables. What occurs only inside `(not …)` is local to it and reads "there
is none". A skill's head binds as well: its arguments come from the caller.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator

from icarus_lite.language.checking.expressions import variables_in
from icarus_lite.language.checking.report import Report
from icarus_lite.language.syntax import (
    Atom,
    Call,
    ConceptClause,
    Condition,
    Constant,
    Contradiction,
    SkillClause,
    Variable,
)
from icarus_lite.records import dataclass

_ONCE_IS_FINE = ("?_", "?any")


def check_concept_variables(
    clause: ConceptClause, report: Report, *, recursive: bool = False
) -> None:
    """Check the variables of a concept clause.

    Args:
        clause: The clause.
        report: Where findings go.
        recursive: Whether the concept is used in its own definition.
    """
    perceived = _bound_by(clause.elements)
    scope = _Scope(clause.head.predicate, set(perceived), clause.elements, report)
    _check_tests(clause, scope)
    for bind in clause.binds:
        scope.require(variables_in(bind.expression), ":binds")
        if bind.variable.name in scope.bound:
            message = f"{bind.variable} has a value before :binds computes it"
            report.error(bind.variable.span, "ICR011", message, "use another variable")
        scope.bound.add(bind.variable.name)
    scope.require(_variables(clause.head), "the head")
    if recursive:
        _check_termination(clause, scope.bound - perceived, report)
    computing = [
        v for bind in clause.binds for v in (bind.variable, *variables_in(bind.expression))
    ]
    _check_loners(clause.head, clause.elements, [*_tested(clause.tests), *computing], report)


def check_skill_variables(clause: SkillClause, report: Report) -> None:
    """Check the variables of a skill clause."""
    conditions = (*clause.elements, *clause.holds)
    scope = _Scope(clause.head.predicate, _bound_by(clause.elements), conditions, report)
    if not clause.subskills:
        _note_caller_bound(clause, scope)
    scope.bound |= set(clause.head.variables)
    scope.require(_tested(clause.tests), ":tests")
    commanded = [v for action in clause.actions for v in _variables(action)]
    scope.require(commanded, ":actions")
    # A macro's calls may bind further variables, which they pass back to it.
    passed_back = [v for subskill in clause.subskills for v in _variables(subskill)]
    scope.bound |= {variable.name for variable in passed_back}
    _check_effects(clause, scope)
    effected = [v for effect in clause.effects for v in _variables(effect.atom)]
    others = [*_tested(clause.tests), *commanded, *effected, *passed_back]
    _check_loners(clause.head, conditions, others, report)


def check_contradiction_variables(clause: Contradiction, report: Report) -> None:
    """Check the variables of a contradiction; its head is matched, and binds like an element."""
    bound = {*clause.head.variables, *_bound_by(clause.elements)}
    scope = _Scope(clause.head.predicate, bound, clause.elements, report)
    tested = _tested(clause.tests)
    scope.require(tested, ":tests")
    _check_loners(clause.head, clause.elements, tested, report)


@dataclass(slots=True)
class _Scope:
    """What is bound so far in the clause under check."""

    name: str
    bound: set[str]
    conditions: Iterable[Condition]
    report: Report
    _denied: set[str] | None = None
    _symbols: set[str] | None = None

    def require(self, variables: Iterable[Variable], place: str) -> None:
        """Report each variable that is not bound."""
        for variable in variables:
            if variable.name in self.bound:
                continue
            if self._denied is None:
                negated = [c.atom for c in self.conditions if c.negated]
                self._denied = {name for atom in negated for name in atom.variables}
            inside_not = variable.name in self._denied
            label = "elsewhere it occurs only inside `not`" if inside_not else ""
            message = f"{variable} in {place} of `{self.name}` is never bound"
            hint = self._advice(variable.name)
            self.report.error(variable.span, "ICR012", message, hint, label=label)

    def _advice(self, name: str) -> str:
        """Say what to do about an unbound variable; mostly it is one of a few slips."""
        if name.endswith(","):
            return "the comma belongs to the name here: arguments are separated by blanks"
        if self._symbols is None:
            self._symbols = {
                str(term.value)
                for condition in self.conditions
                for term in condition.atom.args
                if isinstance(term, Constant)
            }
        if name[1:] in self._symbols:
            return f"`{name[1:]}` in :elements is a symbol; write {name} for the variable"
        meant = self.report.closest(name, self.bound)
        hint = "bind it in a positive pattern of :elements"
        return f"did you mean {meant}? otherwise {hint}" if meant else hint


def _variables(atom: Atom) -> Iterator[Variable]:
    for term in (*atom.args, *(value for _, value in atom.attributes)):
        if isinstance(term, Variable):
            yield term


def _tested(tests: Iterable[Call]) -> list[Variable]:
    return [variable for test in tests for variable in variables_in(test)]


def _bound_by(elements: Iterable[Condition]) -> set[str]:
    return {name for element in elements if not element.negated for name in element.atom.variables}


def _check_tests(clause: ConceptClause, scope: _Scope) -> None:
    computed = {bind.variable.name for bind in clause.binds} - scope.bound
    tested = _tested(clause.tests)
    scope.require((v for v in tested if v.name not in computed), ":tests")
    for variable in tested:
        if variable.name in computed:
            message = f"{variable} in :tests of `{scope.name}` has no value yet"
            hint = ":binds are computed after the tests; test the expression itself"
            scope.report.error(variable.span, "ICR012", message, hint)


def _check_termination(clause: ConceptClause, computed: set[str], report: Report) -> None:
    """Refuse computed arguments in recursion: each round could invent a new belief."""
    for term in clause.head.args:
        if isinstance(term, Variable) and term.name in computed:
            message = f"`{clause.head.predicate}` is recursive and computes its argument {term}"
            hint = "it may never come to an end; make the computed value an attribute: ^name ?v"
            report.error(term.span, "ICR034", message, hint)


def _note_caller_bound(clause: SkillClause, scope: _Scope) -> None:
    for variable in _variables(clause.head):
        if variable.name not in scope.bound:
            message = f"{variable} of `{scope.name}` is bound by no element"
            hint = "only a goal or a caller can give it a value; bind it in :elements"
            scope.report.note(variable.span, "ICR033", message, hint)


def _check_effects(clause: SkillClause, scope: _Scope) -> None:
    for effect in clause.effects:
        if not effect.negated:
            scope.require(_variables(effect.atom), ":effects")
            continue
        for variable in _variables(effect.atom):
            if variable.name not in scope.bound and not variable.name.startswith(_ONCE_IS_FINE):
                message = f"{variable} in a removing effect of `{scope.name}` is never bound"
                hint = "it removes every belief that matches; write ?_ if that is meant"
                scope.report.warning(variable.span, "ICR031", message, hint)


def _check_loners(
    head: Atom, conditions: Iterable[Condition], others: Iterable[Variable], report: Report
) -> None:
    """Report variables of the conditions that occur nowhere else, or only inside `not`."""
    positive: list[Variable] = []
    negative: list[Variable] = []
    for condition in conditions:
        (negative if condition.negated else positive).extend(_variables(condition.atom))
    names = Counter(variable.name for variable in (*positive, *negative))
    explained = {*head.variables, *(variable.name for variable in others)}
    for variable in positive:
        lonely = names[variable.name] == 1 and variable.name not in explained
        if lonely and not variable.name.startswith(_ONCE_IS_FINE):
            hint = "is it misspelt? name it ?_ if any value will do"
            report.warning(variable.span, "ICR029", f"{variable} occurs only once", hint)
    explained.update(variable.name for variable in positive)
    for variable in negative:
        if variable.name not in explained and not variable.name.startswith(_ONCE_IS_FINE):
            message = f"{variable} occurs only inside `not`, which reads: there is none"
            hint = "name it ?_ or ?any if that is meant; bind it outside if it is not"
            report.note(variable.span, "ICR030", message, hint)
            explained.add(variable.name)
