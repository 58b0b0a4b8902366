"""Compile a domain, once, into an executable network."""

from __future__ import annotations

from icarus_lite.inference.evaluator import Evaluator, Functions
from icarus_lite.inference.network import kernels
from icarus_lite.inference.network.changes import Budget
from icarus_lite.inference.network.design import Design, design_of, place_of
from icarus_lite.inference.network.generation.module import Module, generate
from icarus_lite.inference.network.groups import groups_of
from icarus_lite.inference.network.network import Network
from icarus_lite.inference.network.plans import ClausePlan, plans_of
from icarus_lite.inference.network.vocabulary import Vocabulary
from icarus_lite.language.syntax import Domain
from icarus_lite.records import dataclass, field


@dataclass(frozen=True, slots=True)
class Compiled:
    """The network of a domain for some choice of concepts that are given as well.

    Args:
        design: Its design.
        module: The generated module.
        places: Where each clause stands, with its head.
        groups: For each percept type the pair rules that are followed together when it moves.
    """

    design: Design
    module: Module
    places: tuple[str, ...]
    groups: tuple[kernels.GroupProgram, ...]


@dataclass(frozen=True, slots=True)
class CompiledDomain:
    """A domain, ready to run: immutable, and shared by as many networks as one likes.

    Args:
        domain: The domain.
        evaluator: Evaluates its tests and binds.

    A concept is compiled as defined by its clauses alone. Where such a belief is asserted
    nevertheless, a second form of the network is compiled that allows for it, and kept here.
    """

    domain: Domain
    evaluator: Evaluator
    _forms: dict[frozenset[str], Compiled] = field(default_factory=dict, repr=False, compare=False)

    @property
    def source(self) -> str:
        """The generated Python, for a person to read."""
        return self.form(frozenset()).module.source

    @property
    def pair_source(self) -> str:
        """The generated Python of pair rules that are followed together, for a person to read."""
        return "\n\n".join(group.source.text for group in self.form(frozenset()).groups)

    @property
    def plans(self) -> tuple[ClausePlan, ...]:
        """How each clause is joined, in the order of the text."""
        form = self.form(frozenset())
        return plans_of(form.design, form.module.wiring)

    def form(self, given: frozenset[str]) -> Compiled:
        """Give the network that lets some concepts be given as well.

        Raises:
            NotStratifiedError: a concept depends on its own negation.
            InferenceError: a variable of a head is never bound.
        """
        if given not in self._forms:
            design = design_of(self.domain, Vocabulary.of(self.domain, self.evaluator, given))
            places = tuple(
                f"{place_of(clause, self.domain)}: {clause.head}" for clause in self.domain.concepts
            )
            self._forms[given] = Compiled(design, generate(design), places, groups_of(design))
        return self._forms[given]

    def network(self, budget: Budget | None = None) -> Network:
        """Give a network that believes nothing yet.

        Args:
            budget: What one cycle may cost, by default five million beliefs a concept and half
                a minute, and how many changes of past cycles to keep.
        """
        return Network(self, budget)


def compile_domain(domain: Domain, functions: Functions | None = None) -> CompiledDomain:
    """Compile a domain.

    Args:
        domain: A checked domain.
        functions: Python functions that its tests and binds may call by name. They must be pure.

    Raises:
        NotStratifiedError: a concept depends on its own negation.
        InferenceError: a variable of a head is never bound.

    Example:
        >>> from icarus_lite import Percept
        >>> from icarus_lite.inference.network import Delta
        >>> from icarus_lite.language import parse_domain
        >>> domain, _ = parse_domain("(percepts (lamp ^lit)) (concepts ((dark ?l)"
        ...     " :elements ((lamp ?l ^lit no))))")
        >>> network = compile_domain(domain).network()
        >>> network.update(Delta(percepts=(Percept("lamp", "l1", {"lit": "no"}),))).added
        (Belief(predicate='dark', args=('l1',), attributes={}),)
        >>> network.move("lamp", ["l1"], {"lit": ["yes"]}).removed
        (Belief(predicate='dark', args=('l1',), attributes={}),)
    """
    made = CompiledDomain(domain, Evaluator(functions or {}, domain.source.path))
    made.form(frozenset())
    return made
