"""A session that can be talked to without a terminal, for the tests of the REPL."""

from __future__ import annotations

import io
from functools import cache
from pathlib import Path

from rich.console import Console

from icarus_lite import Agent, Percept, load_domain
from icarus_lite.language.syntax import Domain
from icarus_lite.trace import Recording, header
from runtime.repl import Session, TypedRun, answer

GEARBOX = Path(__file__).parents[3] / "domains" / "gearbox.icr"
SCENE = (
    Percept("hand", "hand1", {"reach": 0.85}),
    Percept(
        "object", "hubcover", {"type": "hubcover", "x": 0.4, "y": 0.1, "z": 0.01, "seen": "yes"}
    ),
    Percept("object", "case", {"type": "case", "x": 0.4, "y": -0.1, "z": 0.03, "seen": "yes"}),
)


def live(file: Path = GEARBOX, goal: str = "(attached hubcover case)") -> Session:
    """Give a live session in which everything that the goal needs is perceived."""
    domain = _gearbox() if file == GEARBOX else load_domain(file)
    agent = Agent(domain, [goal] if goal else [])
    recording = Recording(header(domain, agent.goals))
    return Session(recording, TypedRun(agent, SCENE), file)


@cache
def _gearbox() -> Domain:
    return load_domain(GEARBOX)


def ask(session: Session, *lines: str) -> str:
    """Type lines, and give what is shown for the last of them."""
    shown = ""
    for line in lines:
        console = Console(file=io.StringIO(), width=200, highlight=False)
        for each in answer(session, line):
            console.print(each)
        shown = console.file.getvalue()  # type: ignore[attr-defined]
    return "\n".join(line.rstrip() for line in shown.splitlines())
