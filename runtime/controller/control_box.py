"""The control box: arm, safety, terminals and the running program, advanced cycle by cycle."""

from __future__ import annotations

import logging
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Final

from runtime.controller.arm import HOME, Arm
from runtime.controller.force_functions import force_functions
from runtime.controller.functions import general_functions
from runtime.controller.journal import Journal
from runtime.controller.motion_functions import motion_functions
from runtime.controller.motions import MotionError
from runtime.controller.program import Program, blocking_names
from runtime.controller.safety import RobotMode, RuntimeState, Safety, SafetyMode
from runtime.controller.signals import Signals
from runtime.controller.tokens import ScriptError
from runtime.controller.urscript import Translation, translate
from runtime.controller.versions import SCRIPT_SINCE, VERSIONS, Version
from runtime.kinematics import ArmModel, Joints

_LOG: Final = logging.getLogger("runtime.controller")
_REMEMBERED: Final = 4


@dataclass(slots=True)
class _Watchdog:
    """`rtde_set_watchdog`: a variable that must be renewed, in wall time.

    In wall time even under a fast clock: it watches over the link to a real client.
    """

    variable: str
    period_s: float
    action: str
    renewed_s: float


class ControlBox:
    """Everything behind the ports.

    Args:
        model: The arm.
        wall_clock: Monotonic time, s, for the watchdog.
        joints: Where the arm stands at first, rad.
        version: The PolyScope version to play; None takes the usual one for the arm.
    """

    def __init__(
        self,
        model: ArmModel,
        wall_clock: Callable[[], float],
        joints: Joints = HOME,
        version: Version | None = None,
    ) -> None:
        self.model: Final = model
        self.version: Final = VERSIONS[model.name] if version is None else version
        self.cycle_s: Final = 1.0 / model.frequency_hz
        self.arm: Final = Arm(model, joints)
        self.safety: Final = Safety()
        self.signals: Final = Signals()
        self.time_s = 0.0
        self.journal: Final = Journal(self.arm, lambda: self.time_s)
        self.in_remote_control = True
        self.program: Program | None = None
        self.paused = False
        self.last_failure: str | None = None
        self._wall_clock = wall_clock
        self._watchdog: _Watchdog | None = None
        self._functions: Final[Mapping[str, Callable[..., Any]]] = {
            **general_functions(self),
            **motion_functions(self),
            **force_functions(self),
            **self._missing_functions(),
        }
        self._translations: dict[str, Translation] = {}
        self._blocking: Final = blocking_names(self._functions)

    def _missing_functions(self) -> dict[str, Callable[..., Any]]:
        """Give, for each function that came later than the version played, one that says so."""

        def missing(name: str) -> Callable[..., Any]:
            def refuse(*_values: Any, **_named: Any) -> None:
                raise ScriptError(f"{name}() is not known to PolyScope {self.version}")

            return refuse

        return {
            name: missing(name)
            for name, since in SCRIPT_SINCE.items()
            if not self.version.is_at_least(since)
        }

    @property
    def runtime_state(self) -> RuntimeState:
        """What the program is doing."""
        if self.program is None:
            return RuntimeState.STOPPED
        return RuntimeState.PAUSED if self.paused else RuntimeState.PLAYING

    @property
    def thread(self) -> int:
        """The thread of the program whose turn it is."""
        assert self.program is not None
        return self.program.current

    def cycle(self) -> None:
        """Advance robot time by one control period."""
        self.time_s += self.cycle_s
        if self.safety.step(self.time_s):
            self._powered_up()
        self._check_watchdog()
        if self.program is not None and not self.paused:
            self.program.step()
            if self.program.ended:
                self._program_over(self.program)
        try:
            self.arm.step(self.cycle_s)
        except MotionError as error:
            self.protective_stop(str(error))
        self.journal.observe(may_move=self.safety.may_move)

    def _powered_up(self) -> None:
        self.journal.note("brakes_released", "")
        if self.safety.may_move and not self.paused:
            self.arm.unhold()

    # The program

    def load(self, text: str) -> None:
        """Start a program in place of the running one, as an upload to a script port does.

        Raises:
            ScriptError: It is no program, or the arm may not move.
        """
        if not self.safety.may_move:
            raise ScriptError(
                f"a program was refused: robot mode {self.safety.robot_mode.name}, "
                f"safety mode {self.safety.mode.name}"
            )
        if not self.in_remote_control:
            raise ScriptError("a program was refused: the controller is in local control")
        translation = self._translate(text)
        self.stop_program("another program was started")
        self.last_failure = None
        self.paused = False
        self.program = Program(translation, self._functions)
        self.log(f"program {translation.name} started")
        self.journal.note("program_started", translation.name)

    def _translate(self, text: str) -> Translation:
        """Translate, or remember: clients upload the same program again after every stop."""
        translation = self._translations.pop(text, None) or translate(text, self._blocking)
        self._translations[text] = translation
        if len(self._translations) > _REMEMBERED:
            del self._translations[next(iter(self._translations))]
        return translation

    def stop_program(self, reason: str) -> None:
        """End the running program, if there is one; the arm brakes."""
        if self.program is not None:
            self.program.stop()
            self._program_over(self.program, reason)

    def pause(self) -> bool:
        """Pause the program and the arm; False when none is running."""
        if self.program is None:
            return False
        self.paused = True
        self.arm.hold()
        self.journal.note("program_paused", self.program.name)
        return True

    def play(self) -> bool:
        """Let a paused program go on, its interrupted motion with it; False when it cannot."""
        if self.program is None or not self.safety.may_move:
            return False
        self.paused = False
        self.arm.unhold()
        self.journal.note("program_resumed", self.program.name)
        return True

    def _program_over(self, program: Program, reason: str = "it came to its end") -> None:
        self.program = None
        self.paused = False
        self._watchdog = None
        self.arm.release()
        self.arm.force_mode = None
        if self.safety.may_move:
            self.arm.unhold()
        self.journal.note("program_ended", program.failure or reason)
        if program.failure is not None:
            self.last_failure = program.failure
            self.warn(f"program {program.name} failed: {program.failure}")
        else:
            self.log(f"program {program.name} ended: {reason}")

    # Safety

    def protective_stop(self, reason: str) -> bool:
        """Stop the arm and pause the program; False when the arm is stopped already."""
        if not self.safety.protective_stop(self.time_s, reason):
            return False
        self.warn(f"protective stop: {reason}")
        self.journal.note("protective_stop", reason)
        self.arm.hold()
        self.paused = self.program is not None
        return True

    def unlock_refusal(self) -> str | None:
        """Unlock a protective stop; None when done. A paused program stays paused."""
        stopped = self.safety.mode is SafetyMode.PROTECTIVE_STOP
        refusal = self.safety.unlock_refusal(self.time_s)
        if refusal is None and stopped:
            self.journal.note("protective_stop_unlocked", "")
        if refusal is None and not self.paused and self.safety.may_move:
            self.arm.unhold()
        return refusal

    def emergency_stop(self) -> None:
        """Press the emergency stop: the program ends and the power goes."""
        self.safety.emergency_stop()
        self.warn("emergency stop")
        self.journal.note("emergency_stop", "")
        self.arm.hold()
        self.stop_program("emergency stop")

    def release_emergency_stop(self) -> None:
        """Pull the emergency stop out again; the arm stays without power."""
        if self.safety.release_emergency_stop():
            self.log("emergency stop released")
            self.journal.note("emergency_stop_released", "")

    def power_on(self) -> bool:
        """Power the arm, brakes still closed; False while the emergency stop is pressed."""
        return self.safety.power_on(self.time_s)

    def power_off(self) -> None:
        """Take the power from the arm; the program ends."""
        self.safety.power_off()
        self.journal.note("power_off", "")
        self.arm.hold()
        self.stop_program("power off")

    def release_brakes(self) -> bool:
        """Get the arm ready to move, in a while; False while the emergency stop is pressed."""
        return self.safety.release_brakes(self.time_s)

    @property
    def robot_status_bits(self) -> int:
        """The state stream's `robot_status_bits`: power on, program running."""
        powered = self.safety.robot_mode is not RobotMode.POWER_OFF
        playing = self.runtime_state is RuntimeState.PLAYING
        return int(powered) | int(playing) << 1

    # The watchdog

    def set_watchdog(self, variable: str, min_frequency_hz: float, action: str) -> None:
        """Watch an input variable from now on; a frequency of 0 or less ends it."""
        self._watchdog = (
            _Watchdog(variable, 1.0 / min_frequency_hz, action, self._wall_clock())
            if min_frequency_hz > 0
            else None
        )

    def input_renewed(self, variables: tuple[str, ...]) -> None:
        """Learn that a client has written input variables."""
        if self._watchdog is not None and self._watchdog.variable in variables:
            self._watchdog.renewed_s = self._wall_clock()

    def _check_watchdog(self) -> None:
        watched = self._watchdog
        if watched is None or self.program is None or self.paused:
            return
        if self._wall_clock() - watched.renewed_s <= watched.period_s:
            return
        words = f"{watched.variable} was not written for {watched.period_s:g} s; {watched.action}"
        self.warn(f"watchdog: {words}")
        self.journal.note("watchdog", words)
        if watched.action == "stop":
            self.stop_program("watchdog")
        elif watched.action == "pause":
            self.pause()
        else:
            self._watchdog = None

    # The log

    def log(self, text: str) -> None:
        """Write to the controller's log."""
        _LOG.info("%s", text)

    def warn(self, text: str) -> None:
        """Write to the controller's log what a person should look at."""
        _LOG.warning("%s", text)
