"""Constructs of older dialects that have no counterpart here, each with what to write instead.

What merely has another name today loads with a note; see `assembly`.
"""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

_STRENGTH = "a concept holds or does not: state the limit in :tests, such as ((< ?d 0.05))"
_CHOICE = "skills are chosen by planning, the shortest way first; remove it"
_NOT = "write its patterns in :elements, each as (not (on ?other ?block))"

GONE_FIELDS: Mapping[str, str] = MappingProxyType(
    {
        ":changes": "say what will be believed in :effects, such as (on ?a ?b) or (not (on ?a ?c))",
        ":duration": "how long a skill may take is its :timeout, in seconds",
        ":expected": _CHOICE,
        ":id": "a skill is known by the name in its head; remove it",
        ":negatives": _NOT,
        ":nominate": "say when a long-term goal matters in :relevance ((untidy ?table))",
        ":ordered": "subskills are carried out in order: write :subskills ((pick-up ?hand ?obj))",
        ":pivot": _STRENGTH,
        ":positives": "write its patterns in :elements",
        ":skills": "write :subskills ((pick-up ?hand ?obj))",
        ":threshold": _STRENGTH,
        ":value": _CHOICE,
    }
)
"""Fields that are refused, each with the modern way."""

_WHEN = "say when it may start in :elements"
_WHAT = "say what will be believed in :effects, what no longer as (not (on ?a ?b))"

PDDL_FIELDS: Mapping[str, str] = MappingProxyType(
    {
        ":add": _WHAT,
        ":condition": _WHEN,
        ":delete": _WHAT,
        ":parameters": "the arguments stand in the head: ((move ?a ?b) :elements (…))",
        ":precondition": _WHEN,
        ":preconditions": _WHEN,
        ":vars": "variables need no declaration; remove it",
    }
)
"""Fields that people know from PDDL, each with what is written here."""

GONE_FORMS: Mapping[str, str] = MappingProxyType(
    {
        "create-constraints": "goals are ordered by planning; state what must not hold as a goal "
        "of its own: :goal ((on a b) (not (on b a)))",
        "create-percepts": "declare what is perceived: (percepts (object ^type ^x ^y))",
        "clear": "a file is read afresh each time; remove it",
        "run": 'this is a command: type "icarus run" in a terminal',
        "defun": "functions are written in Python and given when the domain is loaded",
        "in-package": "a file needs no package; remove it",
        "load": 'write (include "other.icr")',
        "setq": "the language has no global variables; write the value where it is used",
    }
)
"""Forms that are refused, each with the modern way."""
