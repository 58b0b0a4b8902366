"""Inference: percepts and the last actions in, beliefs with their supports out."""

from icarus_lite.inference.attachment import ATTACHED, Hierarchy, Link, advance
from icarus_lite.inference.closure import Closure
from icarus_lite.inference.effects import Change, change_of
from icarus_lite.inference.engine import BeliefState, InferenceEngine, Memory
from icarus_lite.inference.explaining import (
    Chronicle,
    Context,
    Period,
    WhyNot,
    what_ended,
    why_not,
    why_not_document,
)
from icarus_lite.inference.explanation import Explanation, explain
from icarus_lite.inference.facts import (
    Bindings,
    FactStore,
    ground,
    match,
    percept_fact,
    percept_facts,
    resolve,
    unify,
)
from icarus_lite.inference.given import GIVEN, given_memory, given_percepts
from icarus_lite.inference.matching import Evaluator, Functions, Match, Matcher
from icarus_lite.inference.near_miss import (
    NearMiss,
    Obstacle,
    first_obstacle,
    near_misses,
    nearest_beliefs,
)
from icarus_lite.inference.network import Budget, ForgottenError
from icarus_lite.inference.supports import Assertion, Derivation, Support, bind_pattern

__all__ = [
    "ATTACHED",
    "GIVEN",
    "Assertion",
    "BeliefState",
    "Bindings",
    "Budget",
    "Change",
    "Chronicle",
    "Closure",
    "Context",
    "Derivation",
    "Evaluator",
    "Explanation",
    "FactStore",
    "ForgottenError",
    "Functions",
    "Hierarchy",
    "InferenceEngine",
    "Link",
    "Match",
    "Matcher",
    "Memory",
    "NearMiss",
    "Obstacle",
    "Period",
    "Support",
    "WhyNot",
    "advance",
    "bind_pattern",
    "change_of",
    "explain",
    "first_obstacle",
    "given_memory",
    "given_percepts",
    "ground",
    "match",
    "near_misses",
    "nearest_beliefs",
    "percept_fact",
    "percept_facts",
    "resolve",
    "unify",
    "what_ended",
    "why_not",
    "why_not_document",
]
