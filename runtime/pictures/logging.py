"""A run given to the viewer cycle by cycle: image plane, cell, hierarchy, beliefs, log."""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

import rerun as rr

from icarus_lite.outcomes import Status
from icarus_lite.symbols import ATTACHED, Belief, format_value
from icarus_lite.trace import Recording
from runtime.kinematics import MODELS, link_frames

TIMELINE: Final = "cycle"

_COLOURS: Final = {
    "visible": (46, 160, 67),
    "attached": (56, 139, 253),
    "occluded": (210, 153, 34),
    "out-of-view": (210, 153, 34),
    "missing": (248, 81, 73),
}
_GREY: Final = (139, 148, 158)
_HELD: Final = (88, 166, 255)
_STATUS_COLOURS: Final = {
    Status.SUCCEEDED: (46, 160, 67),
    Status.FAILED: (248, 81, 73),
    Status.RUNNING: _GREY,
}
_IMAGE_PX: Final = (320, 240)
_MOST_LANES: Final = 40


def log_run(recording: Recording, stream: rr.RecordingStream) -> None:
    """Give a run to a stream of the viewer.

    Raises:
        TraceError: a line of the trace cannot be read.
    """
    model = MODELS.get(str(recording.header.get("robot")))
    lanes = _lanes(recording)
    for lane in lanes.values():
        states = rr.StateConfiguration(
            values=["held", "not held"], colors=[_HELD, _GREY], visible=[True, False]
        )
        stream.log(f"beliefs/{lane}", states, static=True)
    has_boxes = any(recording.record(cycle).get("anchors") for cycle in recording.cycles[:1])
    if has_boxes:
        frame = rr.Boxes2D(mins=[[0, 0]], sizes=[_IMAGE_PX], colors=[_GREY])
        stream.log("camera/image", frame, static=True)
    attached: list[Belief] = []
    for cycle in recording.cycles:
        stream.set_time(TIMELINE, sequence=cycle)
        record = recording.record(cycle)
        added, removed = recording.changes(cycle)
        attached = [belief for belief in attached if belief not in removed]
        attached += [belief for belief in added if belief.predicate == ATTACHED]
        statuses = {str(row["name"]): str(row["status"]) for row in _rows(record, "anchors")}
        _log_boxes(stream, record)
        _log_places(stream, record)
        if model is not None:
            _log_arm(stream, record, model.name)
        _log_hierarchy(stream, attached, statuses)
        for belief in removed:
            if belief in lanes:
                stream.log(f"beliefs/{lanes[belief]}", rr.StateChange(state="not held"))
        for belief in added:
            if belief in lanes:
                stream.log(f"beliefs/{lanes[belief]}", rr.StateChange(state="held"))
        _log_decision(stream, recording, cycle, record)


def _lanes(recording: Recording) -> dict[Belief, str]:
    """Choose the beliefs to show as lanes: those that come and go, attachments first."""
    first = recording.cycles[0] if len(recording) else 0
    changing = [
        (belief, periods)
        for belief, periods in recording.chronicle().held()
        if len(periods) > 1 or periods[0].first > first + 1 or periods[0].last is not None
    ]
    changing.sort(key=lambda each: (each[0].predicate != ATTACHED, each[0].predicate, str(each[0])))
    return {belief: _path(str(belief)) for belief, _ in changing[:_MOST_LANES]}


def _path(text: str) -> str:
    """Make a text one part of an entity's path that a person can read."""
    return re.sub(r"[^\w.-]+", "_", text).strip("_")


def _log_boxes(stream: rr.RecordingStream, record: Mapping[str, object]) -> None:
    detections, anchors = _rows(record, "detections"), _rows(record, "anchors")
    if not anchors:
        return
    boxes = [_box(row) for row in detections]
    stream.log(
        "camera/detections",
        rr.Boxes2D(
            mins=[box[:2] for box in boxes],
            sizes=[box[2:] for box in boxes],
            colors=[_GREY] * len(boxes),
            radii=[0.4] * len(boxes),
        ),
    )
    width, height = _IMAGE_PX
    shown = [
        (row, box)
        for row in anchors
        if (box := _box(row))[0] < width
        and box[1] < height
        and box[0] + box[2] > 0
        and box[1] + box[3] > 0
    ]
    stream.log(
        "camera/anchors",
        rr.Boxes2D(
            mins=[box[:2] for _, box in shown],
            sizes=[box[2:] for _, box in shown],
            labels=[_label(row) for row, _ in shown],
            colors=[_COLOURS.get(str(row["status"]), _GREY) for row, _ in shown],
            radii=[1.2 if row["status"] == "visible" else 0.7 for row, _ in shown],
        ),
    )


def _box(row: Mapping[str, object]) -> tuple[float, float, float, float]:
    """Give a box as x, y, width, height, in px."""
    found = row["box"]
    assert isinstance(found, list)
    x1, y1, x2, y2 = map(float, found)
    return x1, y1, x2 - x1, y2 - y1


def _label(row: Mapping[str, object]) -> str:
    status, parent = str(row["status"]), row.get("parent")
    kept = "" if status == "visible" else f", {status}"
    return f"{row['name']}{kept}" + (f" to {parent}" if status == "attached" and parent else "")


def _log_places(stream: rr.RecordingStream, record: Mapping[str, object]) -> None:
    """Show each anchor where it is believed to be, in m; the kept ones as wire frames."""
    if not _rows(record, "anchors"):
        return
    sizes = {str(row["name"]): _size(row.get("attributes")) for row in _rows(record, "percepts")}
    for style, fill in ((True, rr.components.FillMode.Solid), (False, None)):
        anchors = [
            (row, position)
            for row in _rows(record, "anchors")
            if isinstance(position := row.get("position"), list)
            and (row["status"] == "visible") is style
        ]
        stream.log(
            f"cell/{'seen' if style else 'kept'}",
            rr.Boxes3D(
                centers=[position for _, position in anchors],
                half_sizes=[sizes.get(str(row["name"]), (0.01,) * 3) for row, _ in anchors],
                labels=[_label(row) for row, _ in anchors],
                colors=[_COLOURS.get(str(row["status"]), _GREY) for row, _ in anchors],
                fill_mode=fill,
            ),
        )


def _size(attributes: object) -> tuple[float, float, float]:
    """Give half the size of an object, from what is perceived of it, in m."""
    if not isinstance(attributes, dict):
        return (0.01, 0.01, 0.01)
    width, height = attributes.get("width"), attributes.get("height")
    if not isinstance(width, int | float) or not isinstance(height, int | float):
        return (0.02, 0.02, 0.02)
    return (width / 2, height / 2, min(width, height) / 4)


def _log_arm(stream: rr.RecordingStream, record: Mapping[str, object], model: str) -> None:
    arm = record.get("arm")
    joints = arm.get("joints") if isinstance(arm, dict) else None
    if not isinstance(arm, dict) or not isinstance(joints, list) or len(joints) != 6:
        return
    frames = link_frames(MODELS[model], joints)
    links = [*frames[:, :3, 3], arm["tcp_pose"][:3]]
    stream.log("cell/arm", rr.LineStrips3D([links], radii=[0.015], colors=[_GREY]))
    colour = _COLOURS["attached"] if arm.get("gripper_closed") else _COLOURS["visible"]
    stream.log("cell/gripper", rr.Points3D([links[-1]], radii=[0.02], colors=[colour]))


def _log_hierarchy(
    stream: rr.RecordingStream, attached: Sequence[Belief], statuses: Mapping[str, str]
) -> None:
    pairs = [(format_value(b.args[0]), format_value(b.args[1])) for b in attached]
    names = list(dict.fromkeys(name for pair in pairs for name in reversed(pair)))
    colours = [_COLOURS.get(statuses.get(name, ""), _GREY) for name in names]
    stream.log(
        "hierarchy",
        rr.GraphNodes(names, labels=names, colors=colours),
        rr.GraphEdges([(parent, child) for child, parent in pairs], graph_type="directed"),
    )


def _log_decision(
    stream: rr.RecordingStream, recording: Recording, cycle: int, record: Mapping[str, object]
) -> None:
    for goal in _rows(record, "goals"):
        state = "achieved" if goal["satisfied"] else "open"
        stream.log(f"doing/{_path(str(goal['goal']))}", rr.StateChange(state=state))
    decision = record.get("decision")
    if isinstance(decision, dict):
        doing = decision.get("action") or decision.get("kind")
        stream.log("doing/action", rr.StateChange(state=str(doing)))
        stream.log("now", rr.TextDocument("\n".join(_told(record, decision))))
    for _, outcome in recording.reports(cycle, cycle):
        if outcome.status is not Status.RUNNING:
            reason = f": {outcome.reason}" if outcome.reason else ""
            text = f"{outcome.action} {outcome.status}{reason}"
            level = "ERROR" if outcome.status is Status.FAILED else "INFO"
            colour = _STATUS_COLOURS[outcome.status]
            stream.log("log/actions", rr.TextLog(text, level=level, color=colour))
    added, removed = recording.changes(cycle)
    for sign, beliefs in (("-", removed), ("+", added)):
        for belief in beliefs:
            stream.log("log/beliefs", rr.TextLog(f"{sign} {belief}", level="DEBUG"))


def _told(record: Mapping[str, object], decision: Mapping[str, object]) -> Iterator[str]:
    action = decision.get("action")
    yield f"{decision.get('kind')}{f' {action}' if action else ''}"
    yield f"{decision.get('reason')}"
    path = record.get("path")
    if isinstance(path, list) and path:
        yield ""
        yield "plan"
        yield from (f"{number}. {step}" for number, step in enumerate(path, 1))


def _rows(record: Mapping[str, object], key: str) -> list[Mapping[str, object]]:
    found = record.get(key)
    return [row for row in found if isinstance(row, dict)] if isinstance(found, list) else []
