"""PDDL both ways: typed STRIPS with negative preconditions and derived predicates."""

from __future__ import annotations

from icarus_lite._on_use import imported_on_use

TYPE_CHECKING = False
if TYPE_CHECKING:
    from icarus_lite.language.pddl.codes import PDDL_CODES
    from icarus_lite.language.pddl.exporter import Exported, export_task
    from icarus_lite.language.pddl.files import Imported, import_files, import_sources
    from icarus_lite.language.pddl.inlining import RecursiveRuleError, inlined
    from icarus_lite.language.pddl.reading import read_pddl_domain, read_pddl_problem
    from icarus_lite.language.pddl.situation import KnownState
    from icarus_lite.language.pddl.writer import write_domain, write_problem

_HOMES = {
    "Exported": "exporter",
    "Imported": "files",
    "KnownState": "situation",
    "PDDL_CODES": "codes",
    "RecursiveRuleError": "inlining",
    "export_task": "exporter",
    "import_files": "files",
    "import_sources": "files",
    "inlined": "inlining",
    "read_pddl_domain": "reading",
    "read_pddl_problem": "reading",
    "write_domain": "writer",
    "write_problem": "writer",
}

__all__ = [
    "PDDL_CODES",
    "Exported",
    "Imported",
    "KnownState",
    "RecursiveRuleError",
    "export_task",
    "import_files",
    "import_sources",
    "inlined",
    "read_pddl_domain",
    "read_pddl_problem",
    "write_domain",
    "write_problem",
]

__getattr__ = imported_on_use(__name__, _HOMES)
