"""A pair rule compiled, once a domain: what its tests are, and which way to keep the relation."""

from __future__ import annotations

from collections.abc import Sequence

from icarus_lite.errors import InferenceError
from icarus_lite.inference.network.kernels.analysis import (
    Axis,
    Order,
    Reach,
    Sides,
    axes_of,
    fold,
    is_numeric,
    is_symmetric,
    order_of,
    swapped,
    terms_of,
)
from icarus_lite.inference.network.kernels.columns import Columns
from icarus_lite.inference.network.kernels.costs import Costs, OneWay
from icarus_lite.inference.network.kernels.exact import (
    ExactTest,
    PairSide,
    exact_test,
    in_turn,
    variables_of,
)
from icarus_lite.inference.network.kernels.matrix import MatrixRelation
from icarus_lite.inference.network.kernels.order import OrderPlan, OrderRelation
from icarus_lite.inference.network.kernels.program import Inputs, Program, write_program
from icarus_lite.inference.network.kernels.ranges import choose_limit, is_guarded
from icarus_lite.inference.network.kernels.relation import Bound, PairRelation
from icarus_lite.inference.network.kernels.side import Gate, SidePlan
from icarus_lite.inference.network.kernels.tester import AxisPlan, MatrixPlan
from icarus_lite.language.syntax import Call, Constant, Expression, Variable
from icarus_lite.records import dataclass, replace


@dataclass(frozen=True, slots=True)
class PairKernel:
    """A compiled pair rule.

    Args:
        sides: The left and the right pattern.
        tests: The tests in the order in which they are asked, `(/= ?a ?b)` included where written.
        gates: Those about one object alone, of the left and of the right side.
        distinct: Whether an object is never paired with itself.
        path: The domain file, to name it in errors.
        source: The generated code, for a person to read.
        limit: The greatest magnitude of an attribute with which the fast ways are trusted.
        order: The comparison of two keys that the rule is, or None.
        axes: The bounds on the distance of a pair.
        symmetric: Whether (b, a) holds whenever (a, b) does.
        plan: What the relations are made with.
        paired: The tests that are about both objects, constant parts computed.
    """

    sides: tuple[PairSide, PairSide]
    tests: tuple[Call, ...]
    gates: tuple[tuple[Call, ...], tuple[Call, ...]]
    distinct: bool
    path: str
    source: str
    limit: float
    order: Order | None
    axes: tuple[Axis, ...]
    symmetric: bool
    plan: OrderPlan | MatrixPlan
    paired: tuple[Call, ...]

    @property
    def summary(self) -> str:
        """Say in one sentence how the relation is kept."""
        if self.order is not None:
            return (
                f"implicit: keys {self.order.left} {self.order.comparison} {self.order.right}, "
                "kept in order"
            )
        words = "a byte a pair, symmetric" if self.symmetric else "a byte a pair"
        if not self.axes:
            return f"{words}; rows by list or array"
        bounds = "; ".join(map(str, self.axes))
        return f"{words}; rows by list or array, neighbours by sweep: {bounds}"

    def instance(self, left: Columns, right: Columns) -> PairRelation:
        """Give a relation over the objects of two columns, which may be the same; it is empty.

        Args:
            left: Its attributes include those of the left pattern.
            right: Likewise for the right one.
        """
        if isinstance(self.plan, OrderPlan):
            return OrderRelation(self.plan, (left, right), self._bind)
        return MatrixRelation(self.plan, (left, right), self._bind)

    def only_by(self, way: str) -> PairKernel:
        """Give a kernel that always goes one way, where it can: see `OneWay`."""
        costs = OneWay(self.plan.costs.operations, way)
        return replace(self, plan=replace(self.plan, costs=costs))

    def _bind(self, columns: tuple[Columns, Columns]) -> Bound:
        exact = exact_test(self.sides, columns, self.tests, self.path)
        gates = [
            self._gate(place, own, tests)
            for place, (own, tests) in enumerate(zip(columns, self.gates, strict=True))
        ]
        return exact, (gates[0], gates[1])

    def _gate(self, place: int, columns: Columns, tests: tuple[Call, ...]) -> Gate | None:
        if not tests:
            return None
        nobody = PairSide(None, ())
        if place == 0:
            ask = exact_test((self.sides[0], nobody), (columns, columns), tests, self.path)
            # A join asks this before it looks for a partner, so that an error is one in any case.
            return lambda slot: ask(slot, 0)
        return _tentative(exact_test((nobody, self.sides[1]), (columns, columns), tests, self.path))


def _tentative(ask: ExactTest) -> Gate:
    """Ask about a right object alone; what cannot be told is left to the pairs with it."""

    def gate(slot: int) -> bool | None:
        try:
            return ask(0, slot)
        except InferenceError:
            return None

    return gate


def compile_pair(
    left: PairSide,
    right: PairSide,
    tests: tuple[Call, ...],
    distinct: bool,  # noqa: FBT001 # the fourth part of what a pair rule is
    *,
    path: str = "",
) -> PairKernel | None:
    """Compile a pair rule.

    The relation holds exactly the pairs for which `evaluate` finds all tests true, asked in the
    order of a join: first those about the left object alone, then the others as written. Where a
    test that is reached has no value, an update raises the InferenceError of `evaluate`.

    Args:
        left: The first pattern. Variables that both patterns bind are the caller's business.
        right: The second one.
        tests: The tests; `(/= ?a ?b)` of the two objects may stand among them.
        distinct: Whether an object is never paired with itself, which is then asked first.
        path: The domain file, to name it in errors.

    Returns:
        The kernel; None where the tests are not purely numeric, or none is about both objects.
    """
    ordered = in_turn(left, tests)
    apart = {Call("/=", pair) for pair in _name_pairs(left, right)}
    numeric = [test for test in ordered if test not in apart]
    names = frozenset(name for name in (left.name, right.name) if name is not None)
    sides = Sides(left, right)
    if not all(is_numeric(test, names) for test in numeric):
        return None
    known = left.variables | right.variables
    if any(not variables_of(test) <= known for test in numeric):
        return None
    paired = [fold(test) for test in numeric if sides.reach(test) is Reach.BOTH]
    if not paired:
        return None
    limit = choose_limit(paired)
    gates = _gates(numeric, sides)
    symmetric = is_symmetric(numeric, sides) and not any(is_guarded(t, limit) for t in paired)
    inputs = _inputs(paired, sides, symmetric=symmetric)
    if inputs is None:
        symmetric = False
        inputs = _inputs(paired, sides, symmetric=False)
    assert inputs is not None, "only a mirrored side may not fit"
    title = f"pairs of {left.name or 'one'} and {right.name or 'another'}"
    program = write_program(paired, *inputs, limit, title)
    order = order_of(paired[0], sides) if len(paired) == 1 else None
    axes = tuple(_axes(paired, sides, limit))
    distinct_first = distinct or not _is_asked_late(ordered, apart, sides)
    distinct = distinct or len(numeric) < len(ordered)
    plans = _side_plans((left, right), inputs, program, limit)
    costs = Costs.of(paired, [*inputs[0].terms, *inputs[1].terms])
    plan: OrderPlan | MatrixPlan
    if order is not None:
        ascending, strict = order.comparison in ("<", "<="), order.comparison in ("<", ">")
        plan = OrderPlan(*plans, ascending, strict, distinct, distinct_first, costs)
    else:
        placed = tuple(_placed(axis, inputs) for axis in axes)
        plan = MatrixPlan(*plans, program.mask, placed, symmetric, distinct, distinct_first, costs)
    return PairKernel(
        (left, right), ordered, gates, distinct, path, program.source, limit, order, axes,
        symmetric, plan, tuple(paired),
    )  # fmt: skip


def _name_pairs(left: PairSide, right: PairSide) -> list[tuple[Expression, ...]]:
    if left.name is None or right.name is None:
        return []
    a, b = Variable(left.name), Variable(right.name)
    return [(a, b), (b, a)]


def _is_asked_late(ordered: Sequence[Call], apart: set[Call], sides: Sides) -> bool:
    """Tell whether `(/= ?a ?b)` stands behind another test about the right object."""
    paired = [test for test in ordered if sides.reach(test) in (Reach.BOTH, Reach.RIGHT)]
    return paired[0] not in apart


def _gates(tests: Sequence[Call], sides: Sides) -> tuple[tuple[Call, ...], tuple[Call, ...]]:
    alone = (Reach.LEFT, Reach.NEITHER)
    return (
        tuple(test for test in tests if sides.reach(test) in alone),
        tuple(test for test in tests if sides.reach(test) is Reach.RIGHT),
    )


def _inputs(
    tests: Sequence[Call], sides: Sides, *, symmetric: bool
) -> tuple[Inputs, Inputs] | None:
    """Give the inputs of both sides; mirrored, if both are the same; None if they do not mirror."""
    left = _sorted_terms(terms_of(tests, sides, Reach.LEFT))
    right = _sorted_terms(terms_of(tests, sides, Reach.RIGHT))
    if symmetric:
        mirrored = tuple(swapped(term, sides) for term in left)
        if set(mirrored) != set(right):
            return None
        right = mirrored
    return Inputs(left, _variables(left)), Inputs(right, _variables(right))


def _sorted_terms(terms: Sequence[Expression]) -> tuple[Expression, ...]:
    """Put attributes before what is derived from them."""
    plain = [term for term in terms if isinstance(term, Variable)]
    return (*plain, *(term for term in terms if not isinstance(term, Variable)))


def _variables(terms: Sequence[Expression]) -> tuple[str, ...]:
    names: dict[str, None] = {}
    for term in terms:
        names.update(dict.fromkeys(sorted(variables_of(term))))
    return tuple(names)


def _side_plans(
    sides: tuple[PairSide, PairSide],
    inputs: tuple[Inputs, Inputs],
    program: Program,
    limit: float,
) -> tuple[SidePlan, SidePlan]:
    made = []
    for side, own, functions in zip(sides, inputs, (program.left, program.right), strict=True):
        attribute_of = dict(side.attributes)
        attributes = tuple(dict.fromkeys(attribute_of.values()))
        sources = tuple(attribute_of[name] for name in own.variables)
        made.append(SidePlan(attributes, own, sources, functions, limit))
    return made[0], made[1]


def _axes(tests: Sequence[Call], sides: Sides, limit: float) -> list[Axis]:
    """Give the bounds by tests that are asked before any that may fail."""
    found: list[Axis] = []
    for test in tests:
        if is_guarded(test, limit):
            break
        found += axes_of(test, sides)
    return found


def _placed(axis: Axis, inputs: tuple[Inputs, Inputs]) -> AxisPlan:
    left, right = inputs
    limit: float | tuple[int, int]
    if isinstance(axis.limit, Constant):
        assert not isinstance(axis.limit.value, str), "limits are numbers"
        limit = float(axis.limit.value)
    elif axis.limit in left.terms:
        limit = (0, left.terms.index(axis.limit))
    else:
        limit = (1, right.terms.index(axis.limit))
    return AxisPlan(left.terms.index(axis.left), right.terms.index(axis.right), limit, axis.reach)
