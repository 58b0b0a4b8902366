"""Puts the labels over a frame: a box for each thing, its colour for its state, and a time line.

Needs Pillow, which the extra `preview` brings.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from typing import Final

import numpy as np
from numpy.typing import NDArray
from PIL import Image, ImageDraw, ImageFont

from aapa.errors import DatasetError
from aapa.lacater.classes import SNITCH_KEY
from aapa.lacater.label_rules import (
    carried_frames,
    contained_frames,
    hidden_by_others,
    object_order,
)
from aapa.lacater.video import HEIGHT, WIDTH, Perception, Video

Colour = tuple[int, int, int]


class State(StrEnum):
    """The four labels."""

    VISIBLE = "visible"
    OCCLUDED = "occluded"
    CONTAINED = "contained"
    CARRIED = "carried"


STATE_COLOURS: Final[Mapping[State, Colour]] = {
    State.VISIBLE: (44, 160, 44),
    State.OCCLUDED: (255, 140, 0),
    State.CONTAINED: (106, 61, 200),
    State.CARRIED: (214, 39, 120),
}
"""The colour of each label, told apart by people with red-green blindness by their lightness."""

TRACK_COLOUR: Final[Colour] = (0, 70, 220)
_DETECTION_COLOUR: Final[Colour] = (255, 255, 255)
_INK: Final[Colour] = (30, 30, 30)
_PAPER: Final[Colour] = (250, 250, 248)
FIXED_COLOURS: Final = (*STATE_COLOURS.values(), TRACK_COLOUR, _DETECTION_COLOUR, _INK, _PAPER)
"""Every colour that stands for something."""

_PANEL_HEIGHT = 92
_MARGIN = 8
_ACTIONS_SHOWN = 2
_STATES = tuple(State)


@dataclass(frozen=True, slots=True, eq=False)
class Track:
    """Where a model has the snitch.

    Args:
        model: Its name.
        boxes: (frames, 4) px, x1 y1 x2 y2; NaN where it says nothing.
        ious: (frames,) how far each agrees with the truth, in 0…1.
    """

    model: str
    boxes: NDArray[np.float64]
    ious: NDArray[np.float64]


class Annotator:
    """Annotates the frames of a video.

    Args:
        video: With its scene.
        scale: Pixels drawn for each px of the video.
        perception: Detections to draw as well; none if left out.
        track: A model's boxes to draw as well; none if left out.

    Raises:
        DatasetError: The video has no scene, or scene and labels are not of the same video.
    """

    def __init__(
        self,
        video: Video,
        scale: int,
        perception: Perception | None = None,
        track: Track | None = None,
    ) -> None:
        if video.scene is None:
            raise DatasetError("there is no scene file to draw it from", path=video.name)
        self._video = video
        self._scale = scale
        self._perception = perception
        self._track = track
        self._states = _states_of(video)
        self._snitch = video.labels.keys.index(SNITCH_KEY)
        self._actions = _actions_of(video)
        self._font = ImageFont.load_default(13)
        self._strip = self._time_line()

    def annotate(self, picture: NDArray[np.uint8], frame: int) -> Image.Image:
        """Give the picture of a frame with everything that is known about it."""
        height, width = picture.shape[:2]
        sheet = Image.new("RGB", (width, height + _PANEL_HEIGHT), _PAPER)
        sheet.paste(Image.fromarray(picture), (0, 0))
        draw = ImageDraw.Draw(sheet)
        self._draw_boxes(draw, frame)
        self._draw_panel(sheet, draw, frame, height)
        return sheet

    def _draw_boxes(self, draw: ImageDraw.ImageDraw, frame: int) -> None:
        for index, boxes in enumerate(self._video.labels.boxes):
            if index != self._snitch:
                state = _STATES[self._states[index, frame]]
                self._rectangle(draw, boxes[frame], STATE_COLOURS[state], 1)
        if self._perception is not None:
            for box in self._perception.boxes[frame]:
                self._dashed(draw, box)
        if self._track is not None and np.isfinite(self._track.boxes[frame]).all():
            self._rectangle(draw, self._track.boxes[frame], TRACK_COLOUR, 2)
        box = self._video.labels.boxes[self._snitch, frame]
        state = _STATES[self._states[self._snitch, frame]]
        self._rectangle(draw, box, STATE_COLOURS[state], 3)
        self._tag(draw, box, f"snitch: {state}", STATE_COLOURS[state])

    def _tag(
        self, draw: ImageDraw.ImageDraw, box: NDArray[np.int32], text: str, colour: Colour
    ) -> None:
        x1, y1, x2, y2 = (int(value) * self._scale for value in box)
        wide = int(draw.textlength(text, font=self._font)) + 8
        left = min(max((x1 + x2 - wide) // 2, 0), WIDTH * self._scale - wide)
        # Above the box, unless that is out of the picture; then below.
        top = y1 - 24 if y1 >= 24 else y2 + 6
        draw.rectangle((left, top, left + wide, top + 18), fill=colour)
        draw.text((left + 4, top + 1), text, fill=(255, 255, 255), font=self._font)

    def _rectangle(
        self,
        draw: ImageDraw.ImageDraw,
        box: NDArray[np.int32] | NDArray[np.float64],
        colour: Colour,
        width: int,
    ) -> None:
        x1, y1, x2, y2 = (round(float(value) * self._scale) for value in box)
        # Lines lie around what they mark, and do not cover it.
        draw.rectangle(
            (x1 - width, y1 - width, x2 + width, y2 + width), outline=colour, width=width
        )

    def _dashed(self, draw: ImageDraw.ImageDraw, box: NDArray[np.int64]) -> None:
        x1, y1, x2, y2 = (int(value) * self._scale for value in box)
        for x in range(x1, x2, 6):
            for y in (y1, y2):
                draw.line((x, y, min(x + 2, x2), y), fill=_DETECTION_COLOUR)
        for y in range(y1, y2, 6):
            for x in (x1, x2):
                draw.line((x, y, x, min(y + 2, y2)), fill=_DETECTION_COLOUR)

    def _draw_panel(
        self, sheet: Image.Image, draw: ImageDraw.ImageDraw, frame: int, top: int
    ) -> None:
        frames = self._video.labels.frames
        draw.text(
            (_MARGIN, top + 6), f"{self._video.name}   frame {frame:3d}", fill=_INK, font=self._font
        )
        if self._track is not None:
            text = f"{self._track.model}: IoU {self._track.ious[frame]:.2f}"
            wide = draw.textlength(text, font=self._font)
            place = (sheet.width - _MARGIN - int(wide), top + 6)
            draw.text(place, text, fill=TRACK_COLOUR, font=self._font)
        running = [text for start, end, text in self._actions if start <= frame <= end]
        shown = running[:_ACTIONS_SHOWN]
        if len(running) > _ACTIONS_SHOWN:
            shown.append(f"and {len(running) - _ACTIONS_SHOWN} more")
        line = " · ".join(shown) or "nothing moves"
        draw.text((_MARGIN, top + 26), line, fill=_INK, font=self._font)
        sheet.paste(self._strip, (_MARGIN, top + 50))
        x = _MARGIN + round(frame / max(frames - 1, 1) * (self._strip.width - 1))
        draw.line((x, top + 46, x, top + 65), fill=_INK, width=2)
        self._draw_legend(draw, top + 70)

    def _draw_legend(self, draw: ImageDraw.ImageDraw, top: int) -> None:
        x = _MARGIN
        entries: list[tuple[str, Colour]] = [
            (str(state), colour) for state, colour in STATE_COLOURS.items()
        ]
        if self._track is not None:
            entries.append((self._track.model, TRACK_COLOUR))
        for text, colour in entries:
            draw.rectangle((x, top + 4, x + 10, top + 14), fill=colour)
            draw.text((x + 15, top), text, fill=_INK, font=self._font)
            x += 15 + int(draw.textlength(text, font=self._font)) + 16

    def _time_line(self) -> Image.Image:
        """Draw the snitch's label over the whole video, a column a frame."""
        palette = np.array([STATE_COLOURS[state] for state in _STATES], dtype=np.uint8)
        row = palette[self._states[self._snitch]][None]
        strip = Image.fromarray(np.repeat(row, 12, axis=0))
        width = WIDTH * self._scale - 2 * _MARGIN
        return strip.resize((width, 12), Image.Resampling.NEAREST)


def picture_size(scale: int) -> tuple[int, int]:
    """Give width and height of an annotated picture, in pixels."""
    return WIDTH * scale, HEIGHT * scale + _PANEL_HEIGHT


def _states_of(video: Video) -> NDArray[np.intp]:
    """Give the state (objects, frames) of every object, as an index of `State`, by the rules.

    The snitch's is the one of the frame lists.
    """
    assert video.scene is not None
    scene, frames = video.scene, video.labels.frames
    order = object_order(video.labels, scene)
    contained = contained_frames(scene, frames)[order]
    carried = np.stack(
        [carried_frames(scene, scene.objects[number].instance, frames) for number in order]
    )
    hidden = hidden_by_others(video.labels, scene, 0.0)
    states = np.where(hidden, _STATES.index(State.OCCLUDED), _STATES.index(State.VISIBLE))
    states = np.where(contained, _STATES.index(State.CONTAINED), states)
    states = np.where(contained & carried, _STATES.index(State.CARRIED), states)
    snitch = video.labels.keys.index(SNITCH_KEY)
    for state in _STATES:
        states[snitch, getattr(video.masks, state)] = _STATES.index(state)
    return states


def _actions_of(video: Video) -> Sequence[tuple[int, int, str]]:
    """Give the actions in words, each with its first and its last frame."""
    assert video.scene is not None
    scene = video.scene
    names = {thing.instance: thing for thing in scene.objects}
    actions = []
    for thing in scene.objects:
        for move in scene.movements.get(thing.instance, ()):
            who = f"{thing.color} {thing.shape}".replace("gold spl", "snitch")
            verb = move.action.strip("_").replace("_", "-")
            over = ""
            if move.other in names:
                other = names[move.other]
                over = f" {other.color} {other.shape}".replace("gold spl", "snitch")
            if verb != "no-op":
                actions.append((move.start, move.end, f"{who}: {verb}{over}"))
    return sorted(actions)
