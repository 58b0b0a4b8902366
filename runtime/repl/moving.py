"""Commands that move through time, and where to stop."""

from __future__ import annotations

from collections.abc import Iterator

from rich.console import RenderableType

from icarus_lite.trace import matching, pattern_of
from runtime.repl.breakpoints import Stop, reached, read
from runtime.repl.command import Command, CommandError, Takes, no_words, number
from runtime.repl.session import Session
from runtime.repl.showing import line, lines, summary

_NOTHING_NEW = (
    "nothing changes any more until you say what is perceived, or what became of an action"
)


def goto(session: Session, text: str) -> Iterator[RenderableType]:
    """Look at a cycle."""
    words = {"first": 0, "last": -1}
    if text in words and len(session.recording):
        session.go_to(session.recording.cycles[words[text]])
    else:
        session.go_to(number(text, "a cycle, `first` or `last`"))
    yield summary(session.record)


def step(session: Session, text: str) -> Iterator[RenderableType]:
    """Go on by one cycle, or by several."""
    count = number(text, "how many cycles") if text else 1
    for _ in range(count):
        if not session.forward():
            yield line("that was the last cycle", "yellow")
            return
        yield summary(session.record)


def back(session: Session, text: str) -> Iterator[RenderableType]:
    """Go back by one cycle, or by several."""
    count = number(text, "how many cycles") if text else 1
    for _ in range(count):
        if not session.backward():
            yield line("this is the first cycle", "yellow")
            break
    yield summary(session.record)


def cont(session: Session, text: str) -> Iterator[RenderableType]:
    """Go on to the next breakpoint, or to the end."""
    most = number(text, "how many cycles at most") if text else None
    gone = 0
    while most is None or gone < most:
        if not session.forward():
            yield line("that was the last cycle", "yellow")
            break
        gone += 1
        for stop in session.stops:
            why = reached(stop, session)
            if why:
                yield line(f"stopped: {why}  [{stop}]", "bold yellow")
                yield summary(session.record)
                return
        if session.waits:
            yield line(_NOTHING_NEW, "yellow")
            break
    yield summary(session.record)


def until(session: Session, text: str) -> Iterator[RenderableType]:
    """Go on until something is believed or perceived."""
    pattern = pattern_of(text)
    while session.forward():
        if matching(pattern, session.instant):
            yield summary(session.record)
            return
        if session.waits:
            yield line(f"{_NOTHING_NEW}; nothing matched {pattern}", "yellow")
            return
    yield line(f"that was the last cycle; nothing matched {pattern}", "yellow")


def set_stop(session: Session, text: str) -> Iterator[RenderableType]:
    """Set a breakpoint, or list them."""
    if not text:
        yield from _listed(session)
        return
    stop: Stop = read(text, session.domain)
    session.stops.append(stop)
    yield line(f"{len(session.stops)}  {stop}")


def _listed(session: Session) -> Iterator[RenderableType]:
    told = [f"{number}  {stop}" for number, stop in enumerate(session.stops, 1)]
    yield lines(told or ["there are no breakpoints; `help break` shows how to set one"])


def unset_stop(session: Session, text: str) -> Iterator[RenderableType]:
    """Remove a breakpoint, or all."""
    if text == "all":
        session.stops.clear()
    else:
        place = number(text, "a breakpoint's number, or `all`")
        if not 1 <= place <= len(session.stops):
            raise CommandError(f"there is no breakpoint {place}; `break` lists them")
        del session.stops[place - 1]
    yield from _listed(session)


def where(session: Session, text: str) -> Iterator[RenderableType]:
    """Say which run and cycle this is."""
    no_words(text, "where")
    recording = session.recording
    count = len(recording)
    span = f"{count} cycles, {recording.cycles[0]} to {recording.cycles[-1]}" if count else "none"
    what = session.live.words if session.live is not None else f"recorded in {recording.path}"
    told = [f"{session.domain.name}: {what}", f"cycles so far: {span}"]
    if session.has_cycle:
        told.append(f"looking at cycle {session.cycle}")
    told += [f"supposed: {edit}" for edit in session.supposed.edits]
    yield lines(told)


MOVING = (
    Command(
        "goto", "N", "Look at cycle N, `first` or `last`.", "goto 120", goto, Takes.CYCLE, ("g",)
    ),
    Command(
        "step",
        "[N]",
        "Go on by one cycle or N; at the end of a live run, run it.",
        "step",
        step,
        aliases=("s",),
    ),
    Command("back", "[N]", "Go back by one cycle or N.", "back 10", back),
    Command(
        "cont",
        "[N]",
        "Go on to the next breakpoint, for N cycles at most, or to the end.",
        "cont",
        cont,
        aliases=("c", "continue"),
    ),
    Command(
        "until",
        "PATTERN",
        "Go on until something is believed or perceived.",
        "until (holding hand1 ?part)",
        until,
        Takes.PATTERN,
    ),
    Command(
        "break",
        "[WHEN] [if PATTERN]",
        "Stop `cont` when a belief is gained or lost, a skill or command started, a skill "
        "succeeded or failed; at a goal, impasse or failure. Without words: list what is set.",
        "break lost (free ?hand) if (object case ^seen no)",
        set_stop,
        Takes.PATTERN,
    ),
    Command("unbreak", "N|all", "Remove a breakpoint.", "unbreak 1", unset_stop),
    Command("where", "", "Say which run this is, and which cycle.", "where", where),
)
