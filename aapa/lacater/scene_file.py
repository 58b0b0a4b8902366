"""Reads a scene file."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import NoReturn

import numpy as np
from numpy.typing import NDArray

from aapa.errors import DatasetError
from aapa.lacater.json_file import read_json
from aapa.lacater.scene import Movement, Scene, SceneObject

_LARGEST_FRAME = 100_000


def read_scene(path: Path) -> Scene:
    """Read a scene file.

    Raises:
        DatasetError: It cannot be read, or something that is needed is missing or wrong.
    """
    return scene_of(read_json(path), path)


def scene_of(entry: object, path: Path) -> Scene:
    """Give the scene that a file's JSON describes.

    Args:
        entry: What was read.
        path: Where from, for the text of errors.

    Raises:
        DatasetError: Something that is needed is missing or of another kind; the text says what.
    """
    return _Reader(path).scene(entry)


class _Reader:
    """Reads one file's entries, and knows its path."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def scene(self, entry: object) -> Scene:
        if not isinstance(entry, dict):
            self.refuse("expected an object with objects and movements")
        items = entry.get("objects")
        if not isinstance(items, list) or not items:
            self.refuse("expected a list of objects", "objects")
        objects = tuple(self.thing(item, f"objects[{n}]") for n, item in enumerate(items))
        names = [thing.instance for thing in objects]
        if len(set(names)) != len(names):
            twice = next(name for name in names if names.count(name) > 1)
            self.refuse(f"two objects are called {twice}", "objects")
        camera = entry.get("camera")
        return Scene(
            int(self.number(entry, "image_index", 0.0)),
            self.text(entry, "image_filename", self.path.stem),
            objects,
            self.movements(entry.get("movements"), frozenset(names)),
            self.text(entry, "split", "new"),
            None if camera is None else self.triple(camera, "camera"),
            self.directions(entry.get("directions", {})),
            self.relationships(entry.get("relationships", {})),
        )

    def thing(self, entry: object, where: str) -> SceneObject:
        if not isinstance(entry, dict):
            self.refuse("expected an object", where)
        return SceneObject(
            self.text(entry, "instance", where=where),
            self.text(entry, "shape", where=where),
            self.text(entry, "size", where=where),
            self.text(entry, "color", where=where),
            self.text(entry, "material", where=where),
            self.number(entry, "sized", 0.0, where),
            self.number(entry, "rotation", 0.0, where),
            self.triple(entry.get("3d_coords"), f"{where}.3d_coords"),
            self.triple(entry.get("pixel_coords"), f"{where}.pixel_coords"),
            self.locations(entry.get("locations"), f"{where}.locations"),
        )

    def movements(self, value: object, known: frozenset[str]) -> Mapping[str, tuple[Movement, ...]]:
        if not isinstance(value, dict):
            self.refuse("expected an object with a list of actions for each instance", "movements")
        movements = {}
        for instance, moves in value.items():
            where = f"movements.{instance}"
            if instance not in known:
                self.refuse("there is no such object in the scene", where)
            if not isinstance(moves, list):
                self.refuse("expected a list of actions", where)
            movements[instance] = tuple(self.movement(move, known, where) for move in moves)
            starts = [move.start for move in movements[instance]]
            if starts != sorted(starts):
                self.refuse("the actions are not in the order of time", where)
        return movements

    def movement(self, value: object, known: frozenset[str], where: str) -> Movement:
        if not isinstance(value, list) or len(value) != 4:
            self.refuse(f"expected [action, other, start, end], found {value!r}", where)
        action, other, start, end = value
        if not isinstance(action, str) or not action:
            self.refuse(f"{action!r} is no action", where)
        if other is not None and other not in known:
            self.refuse(f"{action} names {other!r}; there is no such object in the scene", where)
        if type(start) is not int or type(end) is not int or not 0 <= start <= end < _LARGEST_FRAME:
            self.refuse(
                f"{action} lasts from frame {start!r} to {end!r}; expected 0 ≤ start ≤ end", where
            )
        return Movement(action, other, start, end)

    def locations(self, value: object, where: str) -> NDArray[np.float64]:
        if not isinstance(value, dict) or not value:
            self.refuse("expected a place for each frame", where)
        try:
            places = np.array([value[str(n)] for n in range(len(value))], dtype=np.float64)
        except KeyError as error:
            self.refuse(f"frame {error.args[0]} is missing", where)
        except (ValueError, TypeError):
            self.refuse("expected places of 3 numbers", where)
        if places.shape != (len(value), 3) or not np.isfinite(places).all():
            self.refuse("expected places of 3 finite numbers", where)
        return places

    def directions(self, value: object) -> Mapping[str, tuple[float, float, float]]:
        if not isinstance(value, dict):
            self.refuse("expected an object of vectors", "directions")
        return {name: self.triple(vector, f"directions.{name}") for name, vector in value.items()}

    def relationships(self, value: object) -> Mapping[str, tuple[tuple[int, ...], ...]]:
        try:
            return {
                str(name): tuple(tuple(map(int, others)) for others in lists)
                for name, lists in value.items()  # type: ignore[attr-defined]
            }
        except (AttributeError, TypeError, ValueError):
            self.refuse("expected lists of object numbers", "relationships")

    def triple(self, value: object, where: str) -> tuple[float, float, float]:
        if not isinstance(value, list) or len(value) != 3:
            self.refuse(f"expected 3 numbers, found {value!r}", where)
        for number in value:
            if not _is_finite(number):
                self.refuse(f"expected 3 finite numbers, found {value!r}", where)
        return value[0], value[1], value[2]

    def text(
        self, entry: Mapping[str, object], key: str, default: str = "", where: str = ""
    ) -> str:
        value = entry.get(key, default)
        if not isinstance(value, str) or not value:
            self.refuse(f"expected text, found {value!r}", f"{where}.{key}".strip("."))
        return value

    def number(
        self, entry: Mapping[str, object], key: str, default: float, where: str = ""
    ) -> float:
        value = entry.get(key, default)
        if isinstance(value, bool) or not isinstance(value, int | float) or not _is_finite(value):
            self.refuse(f"expected a finite number, found {value!r}", f"{where}.{key}".strip("."))
        return value

    def refuse(self, message: str, key: str = "") -> NoReturn:
        raise DatasetError(message, path=str(self.path), key=key)


def _is_finite(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and -1e9 <= value <= 1e9
