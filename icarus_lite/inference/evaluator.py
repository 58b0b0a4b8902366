"""What evaluates the expressions and conditions of a domain, and remembers what it compiled.

What compiles them is imported when there is something to compile: a problem without tests, as in
most of PDDL, is planned without it.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from icarus_lite.inference.facts import Bindings
from icarus_lite.language.syntax import Call, Condition, Expression
from icarus_lite.records import dataclass, field
from icarus_lite.symbols import Value

TYPE_CHECKING = False
if TYPE_CHECKING:
    from icarus_lite.inference.matching import Matcher

Functions = Mapping[str, Callable[..., Value | bool]]
"""Python predicates registered by name, beside the built-in functions of `:tests`."""

_MATCHERS_KEPT = 512


@dataclass(frozen=True, slots=True)
class Evaluator:
    """Evaluates the expressions of one domain.

    Args:
        functions: Python predicates registered by name. They must be pure.
        path: The domain file, to name it in errors.
    """

    functions: Functions = field(default_factory=dict)
    path: str = ""
    _matchers: dict[tuple[object, ...], Matcher] = field(
        default_factory=dict, init=False, repr=False, compare=False
    )

    def __call__(self, expression: Expression, bindings: Bindings) -> Value | bool:
        """Give an expression's value. Raises InferenceError, with the place, if it has none."""
        from icarus_lite.language.functions import evaluate  # noqa: PLC0415 - see above

        return evaluate(expression, bindings, self.functions, path=self.path)

    def matcher(
        self, conditions: Sequence[Condition], tests: Sequence[Call] = (), bound: Sequence[str] = ()
    ) -> Matcher:
        """Give a matcher; for what was asked for lately, the one that is compiled already."""
        key = (*conditions, None, *tests, None, *bound)
        found = self._matchers.get(key)
        if found is None:
            if len(self._matchers) >= _MATCHERS_KEPT:
                self._matchers.clear()
            from icarus_lite.inference.matching import Matcher  # noqa: PLC0415 - see above

            found = self._matchers[key] = Matcher(conditions, tests, bound, self)
        return found
