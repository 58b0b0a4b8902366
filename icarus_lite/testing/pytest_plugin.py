"""A pytest plug-in that collects the `(test …)` forms of `.icr` files, each as one test.

pytest loads it by its entry point wherever icarus-lite is installed. Nothing of the language or
the engine is imported before there is a domain file with a test in it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from icarus_lite.inference import InferenceEngine
    from icarus_lite.language.syntax import DomainTest
    from icarus_lite.testing.outcome import CaseOutcome

_TEST_FORM = re.compile(rb"\(\s*test\b")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> pytest.Collector | None:
    """Collect a domain file that has at least one test form."""
    if file_path.suffix != ".icr" or not _TEST_FORM.search(file_path.read_bytes()):
        return None
    collector: pytest.Collector = DomainFile.from_parent(parent, path=file_path)
    return collector


class DomainFile(pytest.File):
    """A domain file and the tests in it."""

    def collect(self) -> Iterable[pytest.Item]:
        """Load the domain and give its tests.

        Raises:
            CollectError: the domain does not load; the text shows every error in it.
        """
        from icarus_lite.inference import InferenceEngine  # noqa: PLC0415 - see the module's head
        from icarus_lite.language import DomainError, load_domain  # noqa: PLC0415

        try:
            domain = load_domain(self._shown())
        except DomainError as error:
            raise self.CollectError(str(error)) from None
        engine = InferenceEngine(domain)
        for test in domain.tests:
            yield DomainItem.from_parent(self, name=test.name, engine=engine, test=test)

    def _shown(self) -> Path:
        """Give the path as a person here would write it."""
        here = self.config.invocation_params.dir
        return self.path.relative_to(here) if self.path.is_relative_to(here) else self.path


class DomainItem(pytest.Item):
    """One `(test …)` form."""

    def __init__(self, *, engine: InferenceEngine, test: DomainTest, **kwargs: object) -> None:
        super().__init__(**kwargs)  # type: ignore[arg-type] # pytest's own, handed through
        self._engine = engine
        self._test = test

    def runtest(self) -> None:
        """Run the test.

        Raises:
            DomainTestError: something is not as it states.
        """
        from icarus_lite.testing.runner import run_test  # noqa: PLC0415 - see the module's head

        outcome = run_test(self._engine, self._test)
        if not outcome.passed:
            raise DomainTestError(outcome)

    def repr_failure(
        self,
        excinfo: pytest.ExceptionInfo[BaseException],
        style: str | None = None,
    ) -> str:
        """Show what is not as stated, without a traceback through the engine."""
        if isinstance(excinfo.value, DomainTestError):
            return str(excinfo.value)
        return str(super().repr_failure(excinfo, style))  # type: ignore[arg-type] # a literal

    def reportinfo(self) -> tuple[Path, int, str]:
        """Give the file, the line from 0, and the name of the test."""
        return self.path, self._test.span.line - 1, self.name


class DomainTestError(AssertionError):
    """A domain test does not hold; its text is the difference."""

    def __init__(self, outcome: CaseOutcome) -> None:
        from icarus_lite.testing.report import describe  # noqa: PLC0415 - see the module's head

        super().__init__(describe(outcome))
