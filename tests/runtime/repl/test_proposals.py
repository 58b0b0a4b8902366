from __future__ import annotations

from pathlib import Path

import pytest
from talking import ask, live

from runtime.repl import Session
from runtime.repl.prompt import is_open
from runtime.repl.proposals import proposals


@pytest.fixture
def session() -> Session:
    session = live()
    ask(session, "step 3")
    return session


def words(text: str, session: Session) -> list[str]:
    return [word for word, _, _ in proposals(text, session)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("hie", ["hierarchy"]),
        ("why", ["why-not"]),
        ("help why", ["why-not"]),
        ("why (att", ["attached"]),
        ("(hold", ["holding"]),
        ("why-not (ins", ["insert"]),
        ("why (attached hub", ["hubcover"]),
        ("why (attached hubcover c", ["case"]),
        ("when (object case ^se", ["^seen"]),
        ("break los", ["lost"]),
        ("break lost (fre", ["free"]),
        ("goto 1", []),
        ("goto ", ["0", "2", "1"]),
        ("percepts ha", ["hand1"]),
        ("fly ", []),
        ("hierarchy x", []),
    ],
)
def test_what_is_proposed(session: Session, text: str, expected: list[str]) -> None:
    assert words(text, session) == expected


def test_files(session: Session, tmp_path: Path) -> None:
    (tmp_path / "frames.jsonl").touch()
    (tmp_path / "other.txt").touch()
    assert [Path(w).name for w in words(f"load {tmp_path}/fr", session)] in (
        ["frames.jsonl"],
        [],
    )
    assert [Path(w).name for w in words(f"load {tmp_path}/", session)] == ["frames.jsonl"]
    assert words("load /no/such/folder/", session) == []


def test_before_the_first_cycle_names_are_not_known_but_nothing_breaks() -> None:
    session = live()
    assert words("why (attached hub", session) == []
    assert words("goto ", session) == []
    assert "attached" in words("why (", session)


@pytest.mark.parametrize("text", ["why (attached a", 'why (attached "a', 'why (attached "a\\")'])
def test_enter_goes_on_while_something_is_open(text: str) -> None:
    assert is_open(text)


@pytest.mark.parametrize("text", ["", "goal", "why (on a b)", 'why (on "a(")', "why attached)"])
def test_enter_ends_what_is_whole(text: str) -> None:
    assert not is_open(text)
