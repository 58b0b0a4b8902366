"""AAPA over a recording: detections and actions in, anchors out, attachments from the engine."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path

import yaml

from aapa import Anchor, Anchoring, AnchoringError, AnchoringParameters, AnchorStatus, Attachment
from aapa.jsonl import RecordedAction, RecordedFrame
from icarus_lite import Action, Outcome, Percept, Status
from icarus_lite.inference import InferenceEngine, Memory
from icarus_lite.language.syntax import Domain
from runtime.errors import UsageError


def track(
    frames: Iterable[RecordedFrame],
    parameters: AnchoringParameters,
    domain: Domain | None = None,
    note: Callable[[str], None] | None = None,
) -> Iterator[tuple[int, tuple[Anchor, ...]]]:
    """Anchor a recording frame by frame.

    The attachments that the anchoring uses in a frame are the beliefs of the frame before, so an
    action that ended at frame e moves a child from e + 1 on.

    Args:
        frames: The recording, in the order of time. Its image size, where told, must stay the
            same.
        parameters: Of the anchoring; the image size comes from the frames if it is left out.
        domain: Says which actions attach what to what; None leaves the actions unused.
        note: Told in words of each action that the domain does not know, or not with so many
            objects, and of each name in one that has never been anchored.

    Yields:
        Each frame's number, and the anchors of that frame, by name.

    Raises:
        AnchoringError: a frame cannot be anchored.
        InferenceError: a test of the domain cannot be evaluated.
    """
    engine = None if domain is None else InferenceEngine(domain)
    memory, anchoring, size = Memory(), None, parameters.image_size
    last: int | None = None
    named: set[str] = set()
    unfit: set[tuple[str, int]] = set()
    known = {} if domain is None else _arities(domain)
    for frame in frames:
        if last is not None and frame.frame <= last:
            raise AnchoringError(
                f"frame {frame.frame} comes after frame {last}; a recording is in the order of "
                "time, each frame once"
            )
        last = frame.frame
        if frame.image_size is not None and size not in (None, frame.image_size):
            raise AnchoringError(
                f"frame {frame.frame} is {frame.image_size[0]} x {frame.image_size[1]} px, "
                "the ones before are not; a recording has one image size"
            )
        size = size or frame.image_size
        if anchoring is None:
            anchoring = Anchoring(replace(parameters, image_size=size))
        pairs = memory.state.hierarchy.pairs()
        attachments = [Attachment(str(child), str(parent)) for child, parent in pairs]
        anchors = anchoring.update(frame.detections, attachments, frame.camera)
        yield frame.frame, anchors
        if engine is not None:
            named.update(anchor.name for anchor in anchors)
            for action in frame.actions:
                why = _why_unfit(action, known)
                if why and note is not None and (action.name, len(action.args)) not in unfit:
                    unfit.add((action.name, len(action.args)))
                    note(f"frame {frame.frame}: {why}; it attaches and detaches nothing")
            for action, name in _strangers(frame.actions, named):
                named.add(name)
                if note is not None:
                    note(
                        f"frame {frame.frame}: ({action.name} …) names {name}, which has not been "
                        "anchored; what it is done with stays where it is"
                    )
            outcomes = [_outcome(action) for action in frame.actions]
            memory = engine.step(memory, map(_percept, anchors), outcomes)


def read_parameters(path: Path | None, tau: float | None = None) -> AnchoringParameters:
    """Give the anchoring's parameters from a YAML file; the defaults for what it leaves out.

    Args:
        path: A mapping of parameter names to values; None has the defaults.
        tau: Squared px; goes before the file's.

    Raises:
        UsageError: The file cannot be read, or is no YAML mapping.
        AnchoringError: A parameter is unknown or out of range.
    """
    values: object = {}
    if path is not None:
        try:
            values = yaml.safe_load(path.read_text(encoding="utf-8"))
        except (OSError, UnicodeDecodeError) as error:
            raise UsageError(f"{path}: cannot be read: {error}") from error
        except yaml.YAMLError as error:
            raise UsageError(f"{path}: is no YAML: {error}") from error
    if not isinstance(values, dict):
        raise UsageError(f"{path}: expected lines such as `tau: 6500`")
    return AnchoringParameters.from_mapping(values if tau is None else values | {"tau": tau})


def _arities(domain: Domain) -> dict[str, set[int]]:
    """Give the actions that a domain knows, and with how many objects each is done."""
    atoms = [rule.attach for rule in domain.attachments]
    atoms += [rule.until for rule in domain.attachments if rule.until is not None]
    atoms += [action for skill in domain.skills for action in skill.actions]
    known: dict[str, set[int]] = {}
    for atom in atoms:
        known.setdefault(atom.predicate, set()).add(len(atom.args))
    return known


def _why_unfit(action: RecordedAction, known: Mapping[str, Collection[int]]) -> str:
    """Give why an action means nothing to the domain; "" where it means something."""
    if action.name not in known:
        near = difflib.get_close_matches(action.name, list(known), n=1)
        hint = f" (did you mean {near[0]}?)" if near else ""
        return f"({action.name} …) is no action of the domain{hint}"
    if len(action.args) not in known[action.name]:
        wanted = " or ".join(map(str, sorted(known[action.name])))
        written = " ".join((action.name, *action.args))
        return f"({written}) names {len(action.args)} of the {wanted} objects it is done with"
    return ""


def _strangers(
    actions: Iterable[RecordedAction], named: Collection[str]
) -> list[tuple[RecordedAction, str]]:
    """Give each name in an action that has stood for nothing so far."""
    found = {name: action for action in actions for name in action.args if name not in named}
    return [(action, name) for name, action in found.items()]


def _outcome(action: RecordedAction) -> Outcome:
    return Outcome(Action(action.name, action.args), Status(action.status))


def _percept(anchor: Anchor) -> Percept:
    """Tell an anchor as a percept of `cater.icr`: the middle and size of its box, in px."""
    x1, y1, x2, y2 = anchor.box
    return Percept(
        "object",
        anchor.name,
        {
            "type": anchor.type,
            "x": (x1 + x2) / 2,
            "y": (y1 + y2) / 2,
            "width": x2 - x1,
            "height": y2 - y1,
            "seen": "yes" if anchor.status is AnchorStatus.VISIBLE else "no",
        },
    )
