"""The `dataclass`, `field` and `replace` of this package: as the standard library's, but made late.

To plan or to check a file, hundreds of classes are imported and a few dozen are made use of; with
the standard library's decorator, writing the methods of all of them takes longer than everything
else. Type checkers are told that these are the standard ones, for they behave alike
(`tests/icarus_lite/records/test_late.py` compares them); `dataclasses.fields`, `asdict` and
`is_dataclass` take their instances, and standard data classes may inherit from them.
"""

from __future__ import annotations

TYPE_CHECKING = False
if TYPE_CHECKING:
    from dataclasses import dataclass, field, replace
else:
    from icarus_lite.records.late import dataclass, field, replace

__all__ = ["dataclass", "field", "replace"]
