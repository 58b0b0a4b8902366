"""Which ideas beyond the paper are used: one switch each, so that each can be left out."""

from __future__ import annotations

from dataclasses import dataclass, fields

from aapa.errors import AnchoringError


@dataclass(frozen=True, slots=True)
class Ideas:
    """The switches. As they are here they make the model `aapa-plus`.

    Args:
        lock: What stands in a container is not looked for; detections of it are false.
        ground: A carried child's box follows from where its container stands on the floor.
            Off: the box is moved as the container's middle moves in the image.
        hidden_motion: What is hidden while it moves goes on along its path to the planned end.
        bounded: What goes on unseen goes no farther than what stands before it can hide it.
            Where the end of a move is not known, it goes on as fast as it was seen to, so far.
        rest: The boxes of what is at rest are averaged, and far detections of it not believed.
        geometry: What vanished where a cone now stands is in it, reported or not.
        rivals: What may contain it is weighed from frame to frame. Off: the cone that is nearest
            when it vanishes is believed at once, until it is seen again.
        planned_end: An action says, when it begins, when it is going to end.
        reports: Actions and attachments are reported; off, the model does not listen.
        camera: Where the camera stands is given; off, the model finds it out.
    """

    lock: bool = True
    ground: bool = True
    hidden_motion: bool = True
    bounded: bool = True
    rest: bool = True
    geometry: bool = True
    rivals: bool = True
    planned_end: bool = True
    reports: bool = True
    camera: bool = False

    def without(self, name: str) -> Ideas:
        """Give the same with one switch off.

        Raises:
            AnchoringError: There is no such switch.
        """
        known = {field.name: bool(getattr(self, field.name)) for field in fields(self)}
        if name not in known:
            raise AnchoringError(f"there is no idea {name!r}; known are {', '.join(known)}")
        return Ideas(**{**known, name: False})
