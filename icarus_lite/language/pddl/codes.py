"""The codes of what can be wrong with a PDDL file."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

PDDL_CODES: Mapping[str, str] = MappingProxyType(
    {
        "PDDL001": "A character has no place in PDDL.",
        "PDDL002": 'A "(" is never closed.',
        "PDDL003": 'A ")" closes nothing.',
        "PDDL004": "Parentheses are nested too deeply.",
        "PDDL005": "The file is not the PDDL file that was asked for.",
        "PDDL006": "A list does not have the shape that PDDL gives it.",
        "PDDL007": "A construct has no counterpart in a domain of this language.",
        "PDDL008": "A name is not declared.",
        "PDDL009": "A predicate has the wrong number of arguments.",
        "PDDL010": "An argument has the wrong type.",
        "PDDL011": "Something is declared twice, or is missing.",
        "PDDL012": "The types form a circle, or derived predicates negate one another in a circle.",
        "PDDL013": "Costs and metrics are read and left out.",
        "PDDL014": "A condition has too many alternatives.",
        "PDDL015": "A derived predicate is stated as a fact or as an effect.",
        "PDDL016": "A name is changed, because it means something else here.",
        "PDDL017": "Something is left out of the PDDL files, or means a little less in them.",
    }
)
"""Every code, with the one sentence that says what it means."""
