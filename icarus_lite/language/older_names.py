"""The older names of forms and fields that still load, and what they are called today."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

MODERN_FORMS: Mapping[str, str] = MappingProxyType(
    {"create-concepts": "concepts", "create-skills": "skills", "create-goals": "goals"}
)
"""The older forms that have another name today; the problems of `create-problems` are tasks."""

MODERN_FIELDS: Mapping[str, str] = MappingProxyType(
    {
        ":percepts": ":elements",
        ":conditions": ":elements",
        ":relations": ":elements",
        ":start": ":elements",
        ":requires": ":while",
        ":subgoals": ":subskills",
        ":action": ":actions",
        ":attributes": ":binds",
    }
)
"""The older fields of concept and skill clauses. Tests have modern fields of the same names."""
