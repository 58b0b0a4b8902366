"""How long it takes to say why: the whole proof of a belief, down to percepts and assertions."""

from __future__ import annotations

import random
import time
from collections.abc import Iterator
from dataclasses import dataclass

from icarus_lite import Belief
from icarus_lite.inference import Derivation
from icarus_lite.inference.network import Network

_DEEP = ("assembly", "loose", "candidate", "has-candidate", "graspable", "connected", "linked")


@dataclass(frozen=True, slots=True)
class ProofTime:
    """One proof.

    Args:
        belief: What was asked about.
        nodes: How many percepts and beliefs the proof has.
        microseconds: How long it took, the first time it was asked for.
    """

    belief: str
    nodes: int
    microseconds: float


def proof(network: Network, belief: Belief) -> dict[Belief, Derivation | None]:
    """Give each belief and percept of a proof with its first derivation; None for what is given."""
    found: dict[Belief, Derivation | None] = {}
    pending = [belief]
    while pending:
        each = pending.pop()
        if each in found:
            continue
        first = next(iter(network.supports(each)), None)
        found[each] = first
        if first is not None:
            pending += first.matched
    return found


def proof_times(network: Network, most: int = 200, seed: int = 1) -> Iterator[ProofTime]:
    """Ask for the proofs of some beliefs of the kinds that rest on others, each once."""
    beliefs = [belief for name in _DEEP for belief in network.facts(name)]
    random.Random(seed).shuffle(beliefs)  # noqa: S311 - a benchmark, not a secret
    for belief in beliefs[:most]:
        begun = time.process_time_ns()
        found = proof(network, belief)
        yield ProofTime(str(belief), len(found), (time.process_time_ns() - begun) / 1000)
