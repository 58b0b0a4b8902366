"""The incremental network: a domain compiled once, its beliefs kept up to date each cycle.

Compiling, once a domain (`compiled`): each clause is taken apart (`bodies`) into relations to join
(`relations`) and tests to ask; each concept is given the way it is kept (`design`), each join its
order (`ordering`); and all of it is written out as Python (`generation`) that a person can read.

Running, once a network (`network`): what it is told is checked and can be taken back (`base`);
objects lie in columns (`tables`), are seen by patterns and paired by numeric kernels (`scene`,
`pair_stores`, `kernels`); the generated functions carry the changes on, concept by concept
(`running`), those with attributes by way of `attributed` and `recomputed`. A budget is watched
(`watch`), net changes are logged (`history`), and why something is believed is found when asked
(`asking`, `proofs`, `ways`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from icarus_lite._on_use import imported_on_use

if TYPE_CHECKING:
    from icarus_lite.inference.network.changes import Budget, Changes, Delta
    from icarus_lite.inference.network.compiled import CompiledDomain, compile_domain
    from icarus_lite.inference.network.history import ForgottenError
    from icarus_lite.inference.network.network import Network

_HOMES = {
    "Budget": "changes",
    "Changes": "changes",
    "CompiledDomain": "compiled",
    "Delta": "changes",
    "ForgottenError": "history",
    "Network": "network",
    "compile_domain": "compiled",
}

__all__ = [
    "Budget",
    "Changes",
    "CompiledDomain",
    "Delta",
    "ForgottenError",
    "Network",
    "compile_domain",
]

__getattr__ = imported_on_use(__name__, _HOMES)
