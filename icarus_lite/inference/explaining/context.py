"""What a question is asked about: a domain, the beliefs of a cycle, and what came before."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from functools import cached_property

from icarus_lite.inference.belief_supports import BeliefSupports
from icarus_lite.inference.engine import BeliefState
from icarus_lite.inference.evaluator import Evaluator
from icarus_lite.inference.explaining.chronicle import Chronicle
from icarus_lite.inference.facts import FactStore
from icarus_lite.inference.present import PresentFacts
from icarus_lite.inference.supports import Support
from icarus_lite.language.checking.vocabulary import Origin, Vocabulary, vocabulary
from icarus_lite.language.syntax import Atom, Constant, Domain
from icarus_lite.language.wording import closest
from icarus_lite.records import dataclass, field
from icarus_lite.symbols import Belief, Percept, Value, format_value


@dataclass(frozen=True)
class Context:
    """One cycle, ready to be asked about. What costs something is worked out when first needed.

    Args:
        domain: The domain.
        state: The beliefs of the cycle.
        evaluator: Evaluates the tests of the domain.
        chronicle: What was believed before, if that is known.
        known: The names of all objects that were ever perceived; None if that is not known.
    """

    domain: Domain
    state: BeliefState
    evaluator: Evaluator = field(default_factory=Evaluator)
    chronicle: Chronicle = field(default_factory=Chronicle)
    known: Collection[str] | None = None

    @cached_property
    def facts(self) -> FactStore:
        """Percepts and beliefs, to look patterns up in."""
        state = self.state
        if isinstance(state.supports, BeliefSupports):
            concepts = frozenset(clause.head.predicate for clause in self.domain.concepts)
            return PresentFacts(state.percepts, state.lineages, state.supports, concepts)
        return state.facts()

    @cached_property
    def names(self) -> Vocabulary:
        """What the domain can perceive, conclude, assert and do."""
        return vocabulary(self.domain)

    @cached_property
    def percepts(self) -> Mapping[str, Percept]:
        """The percepts by name; of two with one name and different types, the last."""
        return {percept.name: percept for percept in self.state.percepts}

    def support(self, belief: Belief) -> Support | None:
        """Give the first support of a belief; None for a percept, or if it is not believed."""
        supports = self.state.supports.get(belief, ())
        return supports[0] if supports else None

    def origins(self, predicate: str) -> frozenset[Origin]:
        """Give where beliefs of a predicate come from; nothing for one that is unknown."""
        return frozenset(each.origin for each in self.names.predicates.get(predicate, ()))

    def is_perceived(self, predicate: str) -> bool:
        """Tell whether a predicate is a percept type."""
        if predicate in self.names.predicates:
            return Origin.PERCEPT in self.origins(predicate)
        return any(percept.type == predicate for percept in self.state.percepts)

    def remark(self, pattern: Atom) -> str:
        """Say what explains at once that nothing matches; empty if nothing does."""
        if self.is_perceived(pattern.predicate) and len(pattern.args) == 1:
            (term,) = pattern.args
            if isinstance(term, Constant):
                percept = self.percepts.get(str(term.value))
                if percept is not None:
                    return f"{term} is perceived as `{percept.type}`"
                return self.absence(term.value)
            if not self.facts.rows(pattern.predicate):
                return f"no `{pattern.predicate}` is perceived"
        elif not self.facts.rows(pattern.predicate):
            return f"nothing at all is believed of `{pattern.predicate}`"
        return ""

    def absence(self, name: Value) -> str:
        """Say that an object is not perceived, and since when."""
        shown = format_value(name)
        if self.known is not None and name in self.known:
            last = self.chronicle.last_perceived(str(name))
            since = "" if last is None else f"; it last was in cycle {last}"
            return f"{shown} is no longer perceived{since}"
        meant = closest(str(name), sorted(self.percepts)) if isinstance(name, str) else None
        hint = f"; did you mean {format_value(meant)}?" if meant else ""
        ever = "is" if self.known is None else "has ever been"
        return f"nothing named {shown} {ever} perceived{hint}"

    def strangers(self, pattern: Atom) -> Iterator[str]:
        """Give the names in a pattern of objects that are gone, or that nothing speaks of."""
        for term in pattern.args:
            name = term.value if isinstance(term, Constant) else None
            if isinstance(name, str) and (self._is_gone(name) or name not in self.spoken_of):
                yield name

    def _is_gone(self, name: str) -> bool:
        return self.known is not None and name in self.known and name not in self.percepts

    @cached_property
    def spoken_of(self) -> frozenset[Value]:
        """All names and words in percepts, in what is given and in the clauses of the domain.

        Whatever is derived speaks of these alone.
        """
        spoken: set[Value] = set(self.percepts)
        for predicate in self.names.predicates:
            if Origin.CONCEPT not in self.origins(predicate):
                for ((_, fact, _),) in self.facts.rows(predicate).values():
                    spoken.update(fact.args)
        for percept in self.state.percepts:
            spoken.update(percept.attributes.values())
        for atom in _atoms(self.domain):
            terms = (*atom.args, *(term for _, term in atom.attributes))
            spoken.update(term.value for term in terms if isinstance(term, Constant))
        return frozenset(spoken)


def _atoms(domain: Domain) -> Iterator[Atom]:
    for concept in domain.concepts:
        yield concept.head
        yield from (each.atom for each in concept.elements)
    for skill in domain.skills:
        yield skill.head
        yield from (each.atom for each in (*skill.elements, *skill.holds, *skill.effects))
