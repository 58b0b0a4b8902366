"""Inference: percepts and the last actions in, beliefs with their supports out."""

from __future__ import annotations

from icarus_lite._on_use import imported_on_use

TYPE_CHECKING = False
if TYPE_CHECKING:
    from icarus_lite.inference.attachment import Hierarchy, Link, advance
    from icarus_lite.inference.beginning import given_memory
    from icarus_lite.inference.closure import Closure
    from icarus_lite.inference.contradictions import Doubt, Judgement, Withdrawal, carried_over
    from icarus_lite.inference.effects import Change, change_of
    from icarus_lite.inference.engine import BeliefState, InferenceEngine, Memory
    from icarus_lite.inference.evaluator import Evaluator, Functions
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
        with_values,
    )
    from icarus_lite.inference.given import GIVEN, GivenBeliefs, given_beliefs, given_percepts
    from icarus_lite.inference.matching import Match, Matcher
    from icarus_lite.inference.near_miss import (
        NearMiss,
        Obstacle,
        first_obstacle,
        near_misses,
        nearest_beliefs,
    )
    from icarus_lite.inference.network import Budget, ForgottenError
    from icarus_lite.inference.supports import Assertion, Derivation, Support, bind_pattern
    from icarus_lite.symbols import ATTACHED

_HOMES = {
    "ATTACHED": "attachment",
    "Assertion": "supports",
    "BeliefState": "engine",
    "Bindings": "facts",
    "Budget": "network",
    "Change": "effects",
    "Chronicle": "explaining",
    "Closure": "closure",
    "Context": "explaining",
    "Derivation": "supports",
    "Doubt": "contradictions",
    "Evaluator": "evaluator",
    "Explanation": "explanation",
    "FactStore": "facts",
    "ForgottenError": "network",
    "Functions": "evaluator",
    "GIVEN": "given",
    "GivenBeliefs": "given",
    "Hierarchy": "attachment",
    "InferenceEngine": "engine",
    "Judgement": "contradictions",
    "Link": "attachment",
    "Match": "matching",
    "Matcher": "matching",
    "Memory": "engine",
    "NearMiss": "near_miss",
    "Obstacle": "near_miss",
    "Period": "explaining",
    "Support": "supports",
    "WhyNot": "explaining",
    "Withdrawal": "contradictions",
    "advance": "attachment",
    "bind_pattern": "supports",
    "carried_over": "contradictions",
    "change_of": "effects",
    "explain": "explanation",
    "first_obstacle": "near_miss",
    "given_beliefs": "given",
    "given_memory": "beginning",
    "given_percepts": "given",
    "ground": "facts",
    "match": "facts",
    "near_misses": "near_miss",
    "nearest_beliefs": "near_miss",
    "percept_fact": "facts",
    "percept_facts": "facts",
    "resolve": "facts",
    "unify": "facts",
    "what_ended": "explaining",
    "why_not": "explaining",
    "why_not_document": "explaining",
    "with_values": "facts",
}

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
    "Doubt",
    "Evaluator",
    "Explanation",
    "FactStore",
    "ForgottenError",
    "Functions",
    "GivenBeliefs",
    "Hierarchy",
    "InferenceEngine",
    "Judgement",
    "Link",
    "Match",
    "Matcher",
    "Memory",
    "NearMiss",
    "Obstacle",
    "Period",
    "Support",
    "WhyNot",
    "Withdrawal",
    "advance",
    "bind_pattern",
    "carried_over",
    "change_of",
    "explain",
    "first_obstacle",
    "given_beliefs",
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
    "with_values",
]

__getattr__ = imported_on_use(__name__, _HOMES)
