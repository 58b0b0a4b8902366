from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from runtime.controller.connections import ProtocolViolation
from runtime.controller.script_server import ScriptServer
from runtime.controller.tokens import ScriptError


class Box:
    """A control box that keeps what it was told to run."""

    def __init__(self, refusal: str = "") -> None:
        self.loaded: list[str] = []
        self.warned: list[str] = []
        self.last_failure: str | None = None
        self._refusal = refusal

    def load(self, text):
        if self._refusal:
            raise ScriptError(self._refusal)
        self.loaded.append(text)

    def warn(self, text):
        self.warned.append(text)


def send(session, pieces):
    for piece in pieces:
        session.received(piece)


class Line:
    peer = "127.0.0.1:5"


PROGRAM = """def prog():
  if True:  # end of nothing: "
    popup("the end")
    end_force_mode()
  end
end
"""


@given(st.integers(1, 40))
def test_a_program_is_complete_with_its_end_however_it_arrives(cut):
    box = Box()
    session = ScriptServer(box).accept(Line())
    text = (PROGRAM + "\n" + PROGRAM).encode()
    for at in range(0, len(text), cut):
        session.received(text[at : at + cut])
    assert box.loaded == [PROGRAM, PROGRAM]


def test_a_line_outside_is_a_program_of_its_own():
    box = Box()
    session = ScriptServer(box).accept(Line())
    session.received(b"set_tcp(p[0,0,0,0,0,0])\n\nstopj(2)\nunfinished")
    assert box.loaded == ["set_tcp(p[0,0,0,0,0,0])\n", "stopj(2)\n"]


def test_a_refused_program_is_reported_not_raised():
    box = Box("line 1: no")
    ScriptServer(box).accept(Line()).received(b"x\n")
    assert box.last_failure == "line 1: no"
    assert box.warned == ["script from 127.0.0.1:5: line 1: no"]


@pytest.mark.parametrize("piece", [b"x" * 65536, b"def f():\n" + b"x = 1\n" * 10000])
def test_a_program_without_end_is_cut_off(piece):
    session = ScriptServer(Box()).accept(Line())
    with pytest.raises(ProtocolViolation, match="a program of more than"):
        send(session, [piece] * 40)
