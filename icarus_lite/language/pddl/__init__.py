"""PDDL both ways: typed STRIPS with negative preconditions and derived predicates."""

from icarus_lite.language.pddl.codes import PDDL_CODES
from icarus_lite.language.pddl.exporter import Exported, export_task
from icarus_lite.language.pddl.files import Imported, import_files, import_sources
from icarus_lite.language.pddl.inlining import RecursiveRuleError, inlined
from icarus_lite.language.pddl.reading import read_pddl_domain, read_pddl_problem
from icarus_lite.language.pddl.situation import KnownState
from icarus_lite.language.pddl.writer import write_domain, write_problem

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
