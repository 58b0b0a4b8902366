"""What the step of a recorded plan was for: the causal links that began at it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from icarus_lite.trace.recording import Recording


def serves(recording: Recording, cycle: int) -> Iterator[str]:
    """Say what the present step of a cycle's plan was to bring about, and for whom.

    Nothing is said where no plan was followed. Links are looked up in the last line that has
    them: they are written down when they are new.

    Raises:
        TraceError: the run has no such cycle, or a line cannot be read.
    """
    present = _plan(recording.record(cycle))
    position = present.get("position")
    if not isinstance(position, int):
        return
    steps, links = _written_down(recording, cycle)
    for link in links:
        if link.get("producer") != position:
            continue
        consumer = link.get("consumer")
        if consumer is None:
            yield f"it was to bring about {link['fact']}, a goal"
        elif isinstance(consumer, int) and consumer < len(steps):
            yield f"it was to bring about {link['fact']}, which {steps[consumer]} needs"


def _written_down(
    recording: Recording, cycle: int
) -> tuple[list[object], list[Mapping[str, object]]]:
    """Give steps and links of the plan that was followed in a cycle."""
    for place in range(recording.place(cycle), -1, -1):
        plan = _plan(recording.record(recording.cycles[place]))
        if not plan:
            break
        steps, links = plan.get("steps"), plan.get("links")
        if isinstance(steps, list) and isinstance(links, list):
            return steps, [link for link in links if isinstance(link, dict)]
    return [], []


def _plan(record: Mapping[str, object]) -> Mapping[str, object]:
    found = record.get("plan")
    return found if isinstance(found, dict) else {}
