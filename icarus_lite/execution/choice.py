"""What an executor comes to in one cycle."""

from __future__ import annotations

from icarus_lite.execution.decision import DecisionKind
from icarus_lite.execution.path import SkillPath
from icarus_lite.execution.plan_following import PlanStatus
from icarus_lite.execution.requests import Request
from icarus_lite.planning import Candidate, Failure, PlanStep
from icarus_lite.records import dataclass, replace


@dataclass(frozen=True, slots=True)
class Choice:
    """What the executor has come to: see `Decision` for each part."""

    kind: DecisionKind
    reason: str
    plan: tuple[PlanStep, ...] = ()
    step: PlanStep | None = None
    skill_path: SkillPath | None = None
    candidates: tuple[Candidate, ...] = ()
    failures: tuple[Failure, ...] = ()
    plan_status: PlanStatus | None = None
    request: Request | None = None

    def asking(self, request: Request) -> Choice:
        """Give the choice to have its step done by another agent: asked, or only waited for."""
        kind = DecisionKind.REQUEST if request.sentence else DecisionKind.AWAIT
        return replace(self, kind=kind, reason=request.text, request=request)
