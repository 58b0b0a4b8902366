r"""The bench port: what a simulated cell or a test wires to the controller, as JSON lines.

Each request is one JSON object on one line, and gets one line back: `{"ok": true, …}` or
`{"ok": false, "error": "…"}`. Several keys may stand in one request.

- `{"inputs": {"tool_digital_in_0": true}}` sets digital inputs, `{"analog_inputs": [0.5, 0]}`
  the analog ones, as fractions of their range; `{"outputs": {"tool_digital_out_0": true}}` sets
  digital outputs, as if they had been left so by a program that ended.
- `{"contact": {"origin": [x, y], "step_m": s, "heights": [[z, …], …], "stiffness_n_m": k,
  "thread": null}}` is what the tool touches: see `runtime.controller.contact`; null for nothing.
- `{"wrench": [fx, fy, fz, mx, my, mz]}` is what presses on the tool, N and Nm, base frame.
- `{"followed": true}` says that whoever moves a simulated world after the arm has just done so:
  from then on the arm waits for them, see `runtime.controller.following`; false ends that.
- `{"fault": {…}}` lets something go wrong at once, with any of `protective_stop: true`,
  `emergency_stop: true|false` (pressed, released), `kill_script: true`, `drop_rtde: true`,
  `drop_dashboard: true`, `silence: seconds` of wall time in which nothing runs and nothing
  answers, `die: true`.
- `{"faults": [{…}, …]}`, or `{"faults": {"schedule": […], "seed": n}}`, is what is to go wrong
  later, in place of what was to: see `runtime.controller.faults`.
- `{"query": "state"}` gives joints, TCP, force, safety, program, inputs and outputs;
  `{"query": "journal"}` what the controller has witnessed: see `runtime.controller.journal`.
"""

from __future__ import annotations

import json
import time
from collections.abc import Callable, Mapping
from typing import Any, Final

from runtime.controller.connections import Connection, ProtocolViolation
from runtime.controller.contact import ContactError, parse_contact
from runtime.controller.control_box import ControlBox
from runtime.controller.fault_actions import FaultActions, FaultSchedule
from runtime.controller.faults import parse_faults
from runtime.controller.following import Following
from runtime.controller.ports import BANNER
from runtime.controller.signals import SignalError, parse_digital
from runtime.errors import ConfigError

_LONGEST: Final = 1 << 22  # the heights of a large contact
_LARGEST: Final = 1e12


class BenchError(ValueError):
    """A request is not one the bench knows; the text says what it should be."""


class BenchServer:
    """Carries out bench requests.

    Args:
        box: The control box on the bench.
        actions: Lets things go wrong.
        following: Whether anybody moves a world after the arm.
    """

    def __init__(self, box: ControlBox, actions: FaultActions, following: Following) -> None:
        self._box = box
        self._actions = actions
        self._following = following
        self.schedule = FaultSchedule((), box, actions.act)
        """What is still to go wrong."""
        self._requests: dict[str, Callable[[Any], dict[str, Any]]] = {
            "inputs": self._inputs,
            "analog_inputs": self._analog_inputs,
            "outputs": self._outputs,
            "contact": self._contact,
            "wrench": self._wrench,
            "followed": self._followed,
            "fault": self._fault,
            "faults": self._schedule,
            "query": self._query,
        }
        self._queries: dict[str, Callable[[], dict[str, Any]]] = {
            "state": self._state,
            "journal": lambda: {"journal": box.journal.to_json()},
        }

    def accept(self, connection: Connection) -> _BenchSession:
        """Begin with a new client."""
        return _BenchSession(self, connection)

    def answer(self, line: bytes) -> dict[str, Any]:
        """Carry out one request; a wrong one is answered, not raised."""
        try:
            request = json.loads(line)
        except (ValueError, RecursionError) as error:
            return {"ok": False, "error": f"this is not a line of JSON: {error}"}
        if not isinstance(request, dict) or not request:
            return {"ok": False, "error": f"a request is an object with {_any_of(self._requests)}"}
        for key in request:
            if key not in self._requests:
                error_text = f"there is no request '{key}'; {_any_of(self._requests)}"
                return {"ok": False, "error": error_text}
        result: dict[str, Any] = {"ok": True}
        try:
            for key, value in request.items():
                result.update(self._requests[key](value))
        except (BenchError, ContactError, SignalError) as error:
            return {"ok": False, "error": str(error)}
        return result

    def _inputs(self, levels: Any) -> dict[str, Any]:
        if not isinstance(levels, dict):
            raise BenchError('"inputs" takes an object, such as {"tool_digital_in_0": true}')
        checked = [(parse_digital(name, "in"), _truth(name, on)) for name, on in levels.items()]
        for (group, index), on in checked:
            self._box.signals.set_input(group, index, on=on)
        return {}

    def _outputs(self, levels: Any) -> dict[str, Any]:
        if not isinstance(levels, dict):
            raise BenchError('"outputs" takes an object, such as {"tool_digital_out_0": true}')
        checked = [(parse_digital(name, "out"), _truth(name, on)) for name, on in levels.items()]
        for (group, index), on in checked:
            self._box.signals.set_output(group, index, on=on)
        return {}

    def _analog_inputs(self, levels: Any) -> dict[str, Any]:
        self._box.signals.analog_inputs = _numbers("analog_inputs", levels, 2)
        return {}

    def _contact(self, contact: Any) -> dict[str, Any]:
        self._box.arm.be_near(parse_contact(contact))
        return {}

    def _wrench(self, wrench: Any) -> dict[str, Any]:
        fx, fy, fz, mx, my, mz = _numbers("wrench", wrench, 6)
        self._box.arm.external_wrench = (fx, fy, fz, mx, my, mz)
        return {}

    def _followed(self, on: Any) -> dict[str, Any]:
        if _truth("followed", on):
            self._following.looked(time.monotonic())
        else:
            self._following.ended()
        return {}

    def _query(self, what: Any) -> dict[str, Any]:
        if not isinstance(what, str) or what not in self._queries:
            raise BenchError(f"there is no query {what!r:.80}; {_any_of(self._queries)}")
        return self._queries[what]()

    def _state(self) -> dict[str, Any]:
        box = self._box
        return {
            "controller": BANNER,
            "model": box.model.name,
            "timestamp_s": box.time_s,
            "joints": list(box.arm.joints),
            "joint_speeds": box.arm.state.qd.tolist(),
            "tcp": list(box.arm.tcp_pose),
            "tcp_offset": list(box.arm.tool.tcp),
            "payload_kg": box.arm.payload_kg,
            "wrench": list(box.arm.wrench),
            "force_mode": box.arm.force_mode is not None,
            "steady": box.arm.is_steady,
            "robot_mode": box.safety.robot_mode.name,
            "safety": box.safety.mode.name,
            "safety_reason": box.safety.reason,
            "program": None if box.program is None else box.program.name,
            "program_state": box.runtime_state.name,
            "last_failure": box.last_failure,
            "inputs": box.signals.named_inputs(),
            "outputs": box.signals.named_outputs(),
        }

    def _fault(self, faults: Any) -> dict[str, Any]:
        if not isinstance(faults, dict) or not faults:
            raise BenchError(f'"fault" takes an object; {_any_of(self._at_once)}')
        for name in faults:
            if name not in self._at_once:
                raise BenchError(f"there is no fault '{name}'; {_any_of(self._at_once)}")
        for name, value in faults.items():
            self._at_once[name](value)
        return {}

    @property
    def _at_once(self) -> Mapping[str, Callable[[Any], None]]:
        return {
            "protective_stop": self._protective_stop,
            "emergency_stop": self._emergency_stop,
            "kill_script": lambda on: self._now("kill_script", on),
            "drop_rtde": lambda on: self._now("drop_rtde", on),
            "drop_dashboard": lambda on: self._now("drop_dashboard", on),
            "silence": self._silence,
            "die": lambda on: self._now("die", on),
        }

    def _schedule(self, content: Any) -> dict[str, Any]:
        try:
            given = content if isinstance(content, dict) else {"schedule": content}
            seed = int(_numbers("seed", [given.get("seed", 0)], 1)[0])
            faults = parse_faults(given.get("schedule"), seed)
        except ConfigError as error:
            raise BenchError(str(error)) from error
        self.schedule = FaultSchedule(faults, self._box, self._actions.act)
        return {}

    def _protective_stop(self, on: Any) -> None:
        box = self._box
        if _truth("protective_stop", on) and not box.protective_stop("asked for on the bench"):
            raise BenchError(
                f"the arm is stopped already: {box.safety.mode.name}, {box.safety.robot_mode.name}"
            )

    def _emergency_stop(self, on: Any) -> None:
        if _truth("emergency_stop", on):
            self._box.emergency_stop()
        else:
            self._box.release_emergency_stop()

    def _silence(self, seconds: Any) -> None:
        self._do({"fault": "stall", "wall_s": seconds})

    def _now(self, kind: str, on: Any) -> None:
        if _truth(kind, on):
            self._do({"fault": kind})

    def _do(self, entry: dict[str, Any]) -> None:
        try:
            (fault,) = parse_faults([{**entry, "when": {"time_s": 0}}])
        except ConfigError as error:
            raise BenchError(str(error)) from error
        self._actions.act(fault)


class _BenchSession:
    """One client and its unfinished line."""

    def __init__(self, server: BenchServer, connection: Connection) -> None:
        self._server = server
        self._connection = connection
        self._buffer = bytearray()

    def received(self, data: bytes) -> None:
        self._buffer += data
        *lines, rest = bytes(self._buffer).split(b"\n")
        self._buffer = bytearray(rest)
        if len(rest) > _LONGEST:
            raise ProtocolViolation(f"a bench request of more than {_LONGEST} bytes")
        for line in lines:
            if line.strip():
                self._connection.send(json.dumps(self._server.answer(line)).encode() + b"\n")

    def closed(self) -> None:
        """What was wired stays wired."""


def _truth(name: str, value: Any) -> bool:
    if not isinstance(value, bool):
        raise BenchError(f'"{name}" takes true or false, not {value!r}')
    return value


def _numbers(name: str, values: Any, count: int) -> list[float]:
    given = values if isinstance(values, list) else []
    if len(given) != count or not all(_is_finite(value) for value in given):
        wanted = "a number" if count == 1 else f"a list of {count} numbers"
        raise BenchError(f'"{name}" takes {wanted}, not {values!r:.80}')
    return [float(value) for value in given]


def _is_finite(value: Any) -> bool:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    # An integer of JSON may be beyond any float.
    return -_LARGEST < value < _LARGEST


def _any_of(known: Mapping[str, object]) -> str:
    return "known are " + ", ".join(f'"{name}"' for name in known)
