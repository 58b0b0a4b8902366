"""A PDDL domain and problem, from two files into one domain file."""

from __future__ import annotations

from pathlib import Path

from icarus_lite.language.checking.report import Report
from icarus_lite.language.diagnostics import Diagnostic, DomainError, has_errors, in_order
from icarus_lite.language.formatting.formatter import format_text
from icarus_lite.language.pddl.icr_text import domain_text
from icarus_lite.language.pddl.importer import import_problem
from icarus_lite.language.pddl.reading import read_pddl_domain, read_pddl_problem
from icarus_lite.language.reading.sources import read_source
from icarus_lite.language.syntax import Domain, Source
from icarus_lite.records import dataclass


@dataclass(frozen=True, slots=True)
class Imported:
    """An imported problem.

    Args:
        domain: The domain, with one task named `problem`.
        text: The same as the text of a domain file.
        remarks: Notes about what was left out or renamed, each with the text it points into.
    """

    domain: Domain
    text: str
    remarks: tuple[tuple[Diagnostic, Source], ...]


def import_files(domain_path: str | Path, problem_path: str | Path) -> Imported:
    """Import a PDDL domain and a problem for it.

    Raises:
        DomainError: A file cannot be read, or holds what cannot be translated; it carries
            everything that is wrong with the file.
    """
    return import_sources(
        read_source(Path(domain_path), str(domain_path)),
        read_source(Path(problem_path), str(problem_path)),
    )


def import_sources(domain_source: Source, problem_source: Source) -> Imported:
    """Import a PDDL domain and problem given as texts. Raises as `import_files` does."""
    domain, domain_found = read_pddl_domain(domain_source)
    if domain is None:
        raise DomainError(domain_found, domain_source)
    problem, problem_found = read_pddl_problem(problem_source, domain)
    if problem is None:
        raise DomainError(problem_found, problem_source)
    domain_report = Report(domain_source, list(domain_found))
    problem_report = Report(problem_source, list(problem_found))
    result = import_problem(domain, problem, domain_report, problem_report)
    for report in (domain_report, problem_report):
        if has_errors(report.diagnostics):
            raise DomainError(in_order(report.diagnostics), report.source)
    assert result is not None  # otherwise there is an error in a report
    remarks = (
        f"{problem.name}, imported from PDDL ({domain.name}).",
        "What is perceived are the objects with their types; the task gives the rest.",
    )
    found = tuple(
        (each, report.source)
        for report in (domain_report, problem_report)
        for each in in_order(report.diagnostics)
    )
    return Imported(result, format_text(domain_text(result, remarks)), found)
