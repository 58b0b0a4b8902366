"""Profiling: how each clause is joined, and what that costs on recorded frames."""

from icarus_lite.inference.profiling.domain import DomainProfile, DomainProfiler
from icarus_lite.inference.profiling.engine_time import EngineTime, engine_time
from icarus_lite.inference.profiling.plans import PlannedStep, RulePlan, UpdatePlan, rule_plans
from icarus_lite.inference.profiling.rows import ClauseProfile, Profiler, StepProfile
from icarus_lite.inference.profiling.source import clause_source

__all__ = [
    "ClauseProfile",
    "DomainProfile",
    "DomainProfiler",
    "EngineTime",
    "PlannedStep",
    "Profiler",
    "RulePlan",
    "StepProfile",
    "UpdatePlan",
    "clause_source",
    "engine_time",
    "rule_plans",
]
