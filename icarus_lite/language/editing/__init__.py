"""What an editor asks about a domain file, answered without knowing any editor."""

from icarus_lite.language.editing.completion import Completion, Proposal, complete
from icarus_lite.language.editing.descriptions import describe
from icarus_lite.language.editing.fixes import Fix, Replacement, fixes
from icarus_lite.language.editing.index import File, Index, Located, Thing
from icarus_lite.language.editing.occurrences import Occurrence, Place, Role, occurrences
from icarus_lite.language.editing.outline import Entry, EntryKind, outline
from icarus_lite.language.editing.renaming import RenameError, rename, renameable
from icarus_lite.language.editing.signatures import Signature, signature

__all__ = [
    "Completion",
    "Entry",
    "EntryKind",
    "File",
    "Fix",
    "Index",
    "Located",
    "Occurrence",
    "Place",
    "Proposal",
    "RenameError",
    "Replacement",
    "Role",
    "Signature",
    "Thing",
    "complete",
    "describe",
    "fixes",
    "occurrences",
    "outline",
    "rename",
    "renameable",
    "signature",
]
