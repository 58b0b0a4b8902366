"""Other planners read what is exported, and agree; what is imported, they plan for as well.

They are development dependencies: a test whose planner is not installed is skipped, and says so.
"""

from __future__ import annotations

import importlib.util
import subprocess
import sys
import warnings
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

from icarus_lite.language import load_domain
from icarus_lite.language.pddl import (
    export_task,
    import_files,
    inlined,
    write_domain,
    write_problem,
)
from icarus_lite.planning import Plan, find_plan
from icarus_lite.symbols import Action

_STATES = Path(__file__).parents[3] / "reference" / "planned_states.py"
_spec = importlib.util.spec_from_file_location("planned_states", _STATES)
states = sys.modules["planned_states"] = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(states)

TASKS = [
    ("gearbox", "1.1", "task 1.1 takes two steps", 2),
    ("blocks", "sussman", "Sussman's anomaly takes six steps", 6),
    ("hanoi", "three-disks", "three disks take seven moves", 7),
    ("gripper", "carry-both", "two grippers carry two balls in one go", 5),
    ("cater", "find", "to uncover the snitch, the cones go one by one", 2),
]
PLAIN = [("blocks", "blocks-sussman"), ("gripper", "gripper-3"), ("lift", "lift-2")]


@pytest.fixture(scope="module")
def planning() -> ModuleType:
    """Give unified-planning, without its announcements."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # its own dependencies warn at import
        shortcuts: Any = pytest.importorskip(
            "unified_planning.shortcuts",
            reason="unified-planning is not installed: pip install -e '.[dev]'",
        )
        pytest.importorskip("unified_planning.io")
    shortcuts.get_environment().credits_stream = None
    return shortcuts


def fast_downward() -> Path:
    """Give the program of Fast Downward, which comes with a package of its own."""
    spec = importlib.util.find_spec("up_fast_downward")
    if spec is None or spec.origin is None:
        pytest.skip("Fast Downward is not installed: pip install up-fast-downward")
    return Path(spec.origin).parent / "downward" / "fast-downward.py"


def exported(root: Path, name: str, task: str, test: str) -> tuple[Any, Any, Any]:
    """Give the export of a shipped task, the state it begins with, and its goals."""
    domain = load_domain(root / "domains" / f"{name}.icr")
    (found,) = [each for each in domain.tests if each.name == test]
    state = states.state_of(domain, found.percepts, found.actions)
    goals = next(each.goals for each in domain.tasks if each.name == task)
    return export_task(domain, task, goals, state), state, goals


def read(planning: ModuleType, folder: Path) -> Any:
    from unified_planning.io import PDDLReader  # noqa: PLC0415 - may not be installed

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # pyparsing renames functions that its user still calls
        reader = PDDLReader(planning.get_environment())
        return reader.parse_problem(str(folder / "domain.pddl"), str(folder / "problem.pddl"))


def is_valid(planning: ModuleType, problem: Any, steps: list[tuple[str, list[str]]]) -> bool:
    from unified_planning.engines import SequentialPlanValidator  # noqa: PLC0415
    from unified_planning.plans import ActionInstance, SequentialPlan  # noqa: PLC0415

    instances = [
        ActionInstance(
            problem.action(name),
            tuple(planning.ObjectExp(problem.object(argument)) for argument in arguments),
        )
        for name, arguments in steps
    ]
    result = SequentialPlanValidator().validate(problem, SequentialPlan(instances))
    return str(result.status.name) == "VALID"


@pytest.mark.parametrize(("name", "task", "test", "length"), TASKS)
def test_fast_downward_plans_for_what_is_exported_and_the_plan_is_one_of_ours(
    root: Path, tmp_path: Path, name: str, task: str, test: str, length: int
) -> None:
    program = fast_downward()
    result, state, goals = exported(root, name, task, test)
    (tmp_path / "domain.pddl").write_text(write_domain(result.domain))
    (tmp_path / "problem.pddl").write_text(write_problem(result.problem))
    command = [sys.executable, str(program), "--plan-file", "plan", "domain.pddl", "problem.pddl"]
    command += ["--search", "astar(blind())"]
    done = subprocess.run(
        command, cwd=tmp_path, capture_output=True, text=True, timeout=60, check=False
    )
    assert done.returncode == 0, done.stdout + done.stderr
    lines = (tmp_path / "plan").read_text().splitlines()
    steps = [line.strip("()").split() for line in lines if not line.startswith(";")]
    actions = [result.skill(step[0], step[1:]) for step in steps]
    assert len(actions) == length
    assert states.reaches(state, actions, goals)


@pytest.mark.parametrize("name", ["gearbox", "blocks", "gripper", "cater"])
def test_unified_planning_reads_the_export_and_finds_our_plan_valid(
    root: Path, tmp_path: Path, planning: ModuleType, naive_pddl: ModuleType, name: str
) -> None:
    _, task, test, _ = next(each for each in TASKS if each[0] == name)
    result, _, _ = exported(root, name, task, test)
    domain, problem = inlined(result.domain, result.problem)
    (tmp_path / "domain.pddl").write_text(write_domain(domain))
    (tmp_path / "problem.pddl").write_text(write_problem(problem))
    theirs = read(planning, tmp_path)
    steps = [(n, list(a)) for n, a in naive_pddl.World(domain, problem).shortest()]
    assert is_valid(planning, theirs, steps)
    assert not is_valid(planning, theirs, steps[:-1])


@pytest.mark.parametrize(("name", "problem"), PLAIN)
def test_unified_planning_finds_our_plan_for_an_import_valid(
    problems: Path, tmp_path: Path, planning: ModuleType, name: str, problem: str
) -> None:
    domain = import_files(problems / f"{name}.pddl", problems / f"{problem}.pddl").domain
    state = states.state_of(domain, domain.tasks[0].init)
    plan = find_plan(domain, state.imagination, domain.tasks[0].goals)
    assert isinstance(plan, Plan)
    for source, target in ((name, "domain"), (problem, "problem")):
        text = (problems / f"{source}.pddl").read_text()
        (tmp_path / f"{target}.pddl").write_text(text)
    theirs = read(planning, tmp_path)
    steps = [(step.action.name, [str(value) for value in step.action.args]) for step in plan.steps]
    assert is_valid(planning, theirs, steps)
    assert not is_valid(planning, theirs, steps[:-1])


@pytest.mark.parametrize(("name", "problem"), PLAIN[:2])
def test_pyperplan_s_plan_for_a_plain_problem_is_one_of_ours(
    problems: Path, name: str, problem: str
) -> None:
    """It knows neither negative preconditions nor derived predicates, so it gets plain ones."""
    pytest.importorskip("pyperplan", reason="pyperplan is not installed: pip install -e '.[dev]'")
    from pyperplan.planner import SEARCHES, search_plan  # noqa: PLC0415 - may not be installed

    found = search_plan(
        str(problems / f"{name}.pddl"), str(problems / f"{problem}.pddl"), SEARCHES["bfs"], None
    )
    steps = [operator.name.strip("()").split() for operator in found]
    domain = import_files(problems / f"{name}.pddl", problems / f"{problem}.pddl").domain
    (task,) = domain.tasks
    state = states.state_of(domain, task.init)
    assert states.reaches(state, [Action(s[0], tuple(s[1:])) for s in steps], task.goals)
    assert len(steps) == states.our_length(state, task.goals)
