"""From PDDL files to a first plan, in this process; what a benchmark and each child share."""

from __future__ import annotations

from icarus_lite.language.checking.report import Report
from icarus_lite.language.pddl.importer import import_problem
from icarus_lite.language.pddl.reading import read_pddl_domain, read_pddl_problem
from icarus_lite.language.reading.sources import read_source
from icarus_lite.language.syntax import Domain
from icarus_lite.planning.beginning import Beginning, given_beginning
from icarus_lite.planning.ground_task import GroundTask
from icarus_lite.planning.grounding import PlanningDomain, ground_goals
from icarus_lite.records import dataclass

TYPE_CHECKING = False
if TYPE_CHECKING:
    from pathlib import Path


@dataclass(frozen=True, slots=True)
class Imported:
    """A PDDL problem as it is planned for; grounding it is what remains to be done."""

    prepared: PlanningDomain
    beginning: Beginning
    domain: Domain

    def ground(self) -> GroundTask:
        """Give the problem without variables."""
        return ground_goals(self.prepared, self.beginning, self.domain.tasks[0].goals).task


def imported(domain: Path | str, problem: Path | str) -> Imported:
    """Read PDDL files, and infer what is believed in the beginning."""
    first, second = (read_source(path, str(path)) for path in (domain, problem))
    schema, _ = read_pddl_domain(first)
    assert schema is not None, f"{domain} cannot be read"
    instance, _ = read_pddl_problem(second, schema)
    assert instance is not None, f"{problem} cannot be read"
    read = import_problem(schema, instance, Report(first), Report(second))
    assert read is not None, f"{problem} cannot be translated"
    [task] = read.tasks
    beginning = given_beginning(read, task.init)
    return Imported(PlanningDomain(read, beginning.evaluator), beginning, read)


def actions(task: GroundTask, plan: tuple[int, ...]) -> list[tuple[str, ...]]:
    """Give the actions of a plan with their arguments."""
    steps = [task.operators[number].step.action for number in plan]
    return [(step.name, *map(str, step.args)) for step in steps]
