"""The language of ICARUS domains: text into a checked syntax tree."""

from __future__ import annotations

from icarus_lite._on_use import imported_on_use

TYPE_CHECKING = False
if TYPE_CHECKING:
    from icarus_lite.language.checking.checker import check_domain
    from icarus_lite.language.checking.stratification import NotStratifiedError, strata
    from icarus_lite.language.commands import check_commands
    from icarus_lite.language.diagnostics import (
        CODES,
        Diagnostic,
        DomainError,
        Severity,
        has_errors,
        render,
        to_json,
    )
    from icarus_lite.language.files import diagnose_file, diagnose_text, load_domain
    from icarus_lite.language.formatting.formatter import format_text
    from icarus_lite.language.fragments import parse_atom, parse_conditions
    from icarus_lite.language.functions import FUNCTIONS, Function, evaluate, function_table
    from icarus_lite.language.reading.reader import parse_domain

_HOMES = {
    "CODES": "diagnostics",
    "Diagnostic": "diagnostics",
    "DomainError": "diagnostics",
    "FUNCTIONS": "functions",
    "Function": "functions",
    "NotStratifiedError": "checking.stratification",
    "Severity": "diagnostics",
    "check_commands": "commands",
    "check_domain": "checking.checker",
    "diagnose_file": "files",
    "diagnose_text": "files",
    "evaluate": "functions",
    "format_text": "formatting.formatter",
    "function_table": "functions",
    "has_errors": "diagnostics",
    "load_domain": "files",
    "parse_atom": "fragments",
    "parse_conditions": "fragments",
    "parse_domain": "reading.reader",
    "render": "diagnostics",
    "strata": "checking.stratification",
    "to_json": "diagnostics",
}

__all__ = [
    "CODES",
    "FUNCTIONS",
    "Diagnostic",
    "DomainError",
    "Function",
    "NotStratifiedError",
    "Severity",
    "check_commands",
    "check_domain",
    "diagnose_file",
    "diagnose_text",
    "evaluate",
    "format_text",
    "function_table",
    "has_errors",
    "load_domain",
    "parse_atom",
    "parse_conditions",
    "parse_domain",
    "render",
    "strata",
    "to_json",
]

__getattr__ = imported_on_use(__name__, _HOMES)
