"""What the page shows, gathered from a recorded run as plain data."""

from __future__ import annotations

from collections.abc import Iterator, Mapping

from icarus_lite import IcarusError
from icarus_lite.inference import Explanation, Period
from icarus_lite.symbols import Belief
from icarus_lite.trace import Instant, Recording, Story, tell

MOST_FRAMES = 2_000
"""Cycles that can be gone to on the page; of a longer run each second one, or third, and so on."""

MOST_ROWS = 400
"""Beliefs with a row of their own; those that changed least often are left out first."""


def contents(recording: Recording) -> dict[str, object]:
    """Gather what the page shows.

    Raises:
        TraceError: a line of the trace cannot be read.
    """
    story = tell(recording)
    cycles = recording.cycles
    stride = max(1, -(-len(cycles) // MOST_FRAMES))
    shown = sorted({*cycles[::stride], *(cycles[-1:])})
    rows, left_out = _rows(recording)
    return {
        "title": _title(recording),
        "story": list(story.lines()),
        "first": cycles[0] if cycles else 0,
        "last": cycles[-1] if cycles else 0,
        "count": len(cycles),
        "stride": stride,
        "warning": recording.warning,
        "left_out": left_out,
        "rows": rows,
        "actions": list(_actions(story)),
        "frames": [_frame(recording.record(cycle)) for cycle in shown],
    }


def _title(recording: Recording) -> str:
    header = recording.header
    told = header.get("domain")
    name = told.get("name") if isinstance(told, dict) else None
    parts = [str(name)] if name else []
    if header.get("task"):
        parts.append(f"task {header['task']}")
    if header.get("robot"):
        parts.append(str(header["robot"]))
    return ", ".join(parts) or recording.path


def _actions(story: Story) -> Iterator[dict[str, object]]:
    for episode in story.episodes:
        yield {
            "action": episode.action,
            "first": episode.first,
            "last": episode.last,
            "status": episode.status,
            "why": [f"for {' and '.join(episode.aims)}", f"chosen as {episode.reason}"]
            + ([f"then {', '.join(episode.plan)}"] if episode.plan else [])
            + list(episode.serves)
            + [f"not {skill}: {why}" for skill, why in episode.rejected]
            + ([episode.ended] if episode.ended else []),
        }


def _rows(recording: Recording) -> tuple[list[dict[str, object]], int]:
    """Give each belief with its periods, and for each of them why it was held when it began."""
    held = list(recording.chronicle().held())
    kept = sorted(held, key=lambda each: (-len(each[1]), each[1][0].first))[:MOST_ROWS]
    instants = _Instants(recording)
    order = {belief.predicate: number for number, (belief, _) in enumerate(reversed(held))}
    kept.sort(key=lambda each: (-order[each[0].predicate], each[1][0].first, str(each[0])))
    rows: list[dict[str, object]] = [
        {
            "belief": str(belief),
            "predicate": belief.predicate,
            "periods": [[period.first, period.last] for period in periods],
            "whys": [instants.why(belief, period) for period in periods],
        }
        for belief, periods in kept
    ]
    return rows, len(held) - len(kept)


class _Instants:
    """Answers why, with the instants that were gone to last kept."""

    def __init__(self, recording: Recording) -> None:
        self._recording = recording
        self._found: dict[int, Instant] = {}

    def why(self, belief: Belief, period: Period) -> list[str]:
        """Say why a belief was held when a period of it began."""
        try:
            instant = self._found.get(period.first)
            if instant is None:
                instant = self._found[period.first] = self._recording.at(period.first)
            explanation: Explanation = instant.why(belief)
        except IcarusError as error:
            return [str(error)]
        return list(explanation.lines())


def _frame(record: Mapping[str, object]) -> dict[str, object]:
    """Give what is shown of one cycle."""
    decision = record.get("decision")
    goals = _list(record, "goals")
    return {
        "cycle": record["cycle"],
        "decision": decision if isinstance(decision, dict) else {},
        "outcomes": [_reported(row) for row in _list(record, "outcomes")],
        "goals": [[row["goal"], bool(row["satisfied"])] for row in goals],
        "path": record.get("path") or [],
        "percepts": [
            [row["type"], row["name"], row["attributes"]] for row in _list(record, "percepts")
        ],
        "detections": [[row["type"], row["box"]] for row in _list(record, "detections")],
        "anchors": [
            [
                row["name"],
                row["status"],
                row.get("parent"),
                row["box"],
                row.get("position"),
                row.get("reason"),
            ]
            for row in _list(record, "anchors")
        ],
    }


def _reported(row: Mapping[str, object]) -> str:
    args = row.get("args")
    action = " ".join(map(str, (row["name"], *(args if isinstance(args, list) else ()))))
    return f"({action}) {row['status']}" + (f": {row['reason']}" if row.get("reason") else "")


def _list(record: Mapping[str, object], key: str) -> list[dict[str, object]]:
    found = record.get(key)
    return [row for row in found if isinstance(row, dict)] if isinstance(found, list) else []
