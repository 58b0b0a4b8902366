"""Whether a body can carry out what the skills of a domain ask of it."""

from __future__ import annotations

from collections.abc import Collection

from icarus_lite.language.checking.report import Report
from icarus_lite.language.diagnostics import Diagnostic
from icarus_lite.language.syntax import Domain
from icarus_lite.language.wording import listing


def check_commands(domain: Domain, offered: Collection[str]) -> tuple[Diagnostic, ...]:
    """Find the commands of `:actions` that a driver does not offer.

    Args:
        domain: A checked domain.
        offered: The driver's commands, without the star.

    Returns:
        One error for each use of such a command, in the order of the text.
    """
    report = Report(domain.source)
    for skill in domain.skills:
        if skill.agent is not None:
            continue  # how another agent does it is that agent's own matter
        for command in skill.actions:
            if command.predicate not in offered:
                close = report.closest(command.predicate, offered)
                known = listing(f"`*{name}`" for name in sorted(offered))
                hint = f"did you mean `*{close}`?" if close else f"it offers {known}"
                message = f"no driver offers the command `*{command.predicate}`"
                report.error(report.name_of(command), "ICR035", message, hint)
    return tuple(report.diagnostics)
