"""The state that an exported problem begins with, as far as the exporter has to know it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Protocol

from icarus_lite.language.syntax import Call, Condition
from icarus_lite.symbols import Belief, Value


class KnownState(Protocol):
    """What is believed at the start. Inference knows it; the language only asks."""

    @property
    def facts(self) -> Sequence[Belief]:
        """All percepts (under each of their types) and beliefs, derived ones included."""

    def matches(
        self, conditions: Sequence[Condition], tests: Sequence[Call], bindings: Mapping[str, Value]
    ) -> Iterator[Mapping[str, Value]]:
        """Give the bindings under which conditions and tests hold at the start.

        Raises:
            InferenceError: A test cannot be evaluated.
        """
