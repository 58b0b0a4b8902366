"""A session: a run, live or recorded, and the cycle that is being looked at."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from icarus_lite.language.syntax import Domain
from icarus_lite.trace import Instant, Recording
from runtime.repl.breakpoints import Stop, declared
from runtime.repl.command import CommandError
from runtime.repl.runs import LiveRun
from runtime.repl.supposing import Supposition


class Session:
    """What the commands work on.

    Args:
        recording: The run. It grows if the session is live.
        live: Where further cycles come from; None for a run that is over.
        file: The domain file that `reload` reads again.
    """

    def __init__(
        self, recording: Recording, live: LiveRun | None = None, file: Path | None = None
    ) -> None:
        self.recording = recording
        self.live = live
        self.file = file
        self.stops: list[Stop] = list(declared(recording.domain))
        self.supposed = Supposition()
        self.done = False
        self._place = 0 if len(recording) else -1
        self._instant: Instant | None = None

    @property
    def domain(self) -> Domain:
        """The domain that runs, or ran."""
        return self.recording.domain

    @property
    def name(self) -> str:
        """What the prompt calls it."""
        if self.live is not None:
            return self.domain.name
        return Path(self.recording.path).name

    @property
    def has_cycle(self) -> bool:
        """Whether there is a cycle to look at."""
        return self._place >= 0

    @property
    def cycle(self) -> int:
        """The cycle that is being looked at. Raises CommandError if there is none yet."""
        if self._place < 0:
            hint = "`step` runs the first" if self.live is not None else "the trace is empty"
            raise CommandError(f"there is no cycle to look at yet; {hint}")
        return self.recording.cycles[self._place]

    @property
    def is_at_end(self) -> bool:
        """Whether it is the last cycle there is."""
        return self._place == len(self.recording) - 1

    @property
    def instant(self) -> Instant:
        """The cycle that is being looked at, ready to be asked about."""
        cycle = self.cycle
        if self._instant is None or self._instant.cycle != cycle:
            self._instant = self.recording.at(cycle)
        return self._instant

    @property
    def record(self) -> Mapping[str, object]:
        """The line of the cycle that is being looked at."""
        return self.recording.record(self.cycle)

    def go_to(self, cycle: int) -> None:
        """Look at another cycle. Raises TraceError if there is none of that number."""
        self._place = self.recording.place(cycle)

    def forward(self) -> bool:
        """Go on by one cycle, recorded or, at the end of a live run, new; False at the end."""
        if not self.is_at_end:
            self._place += 1
            return True
        if self.live is None:
            return False
        line = self.live.advance()
        if line is None:
            return False
        self.recording.append(line)
        self._place = len(self.recording) - 1
        return True

    @property
    def waits(self) -> bool:
        """Whether a live run has come to where only the person can change anything."""
        return self.live is not None and self.is_at_end and self.live.waits

    def backward(self) -> bool:
        """Go back by one cycle; False at the first."""
        if self._place <= 0:
            return False
        self._place -= 1
        return True

    def use(self, domain: Domain) -> None:
        """Look at the run, and let it go on, by the rules of another domain text from now on."""
        if self.live is not None:
            self.live.agent.reload(domain)
        self.recording.use(domain)
        self._instant = None

    def close(self) -> None:
        """End the session."""
        if self.live is not None:
            self.live.close()
