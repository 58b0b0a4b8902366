"""COCO results: one JSON list of boxes, `{"image_id": 1, "category_id": 3, "bbox": [x, y, w, h]}`.

The image's number is the frame's. The file of the images, where it is given, adds what results
leave out: the frames in which nothing was detected, the size of the images, the categories' names.

Source: COCO, "Results format: object detection"; Lin et al. 2014.
"""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from aapa.detections import Detection
from aapa.errors import AnchoringError, DatasetError
from aapa.formats.refusals import Refused, refuse
from aapa.jsonl import RecordedFrame
from aapa.validation import check_within, checked_detections


@dataclass(frozen=True, slots=True)
class Images:
    """What the file of the images tells.

    Args:
        sizes: Width and height in px of each image, by number, ascending; None if not told.
        types: The name of each category, by number.
    """

    sizes: Mapping[int, tuple[int, int] | None] = field(default_factory=dict)
    types: Mapping[int, str] = field(default_factory=dict)


def read_coco(
    path: Path, images_path: Path | None = None, refused: Refused = refuse
) -> Iterator[RecordedFrame]:
    """Give the frames of a file of COCO results, in the order of the images' numbers.

    Args:
        path: The results, or any COCO file with `annotations`.
        images_path: A COCO file with `images`, and `categories` if it has them. Without it, only
            images with a detection are frames, and category 3 is the type "category-3".
        refused: What becomes of a malformed entry.

    Raises:
        DatasetError: A file or an entry is malformed; the text names file, entry and key.
        AnchoringError: A file cannot be opened.
    """
    content = _json(path)
    images = None if images_path is None else _images(images_path, _json(images_path))
    where = ""
    if isinstance(content, dict):
        where, content = "annotations", content.get("annotations")
    if not isinstance(content, list):
        raise DatasetError(
            "expected a list of results, or an object with annotations", path=str(path), key=where
        )
    frames: dict[int, list[Detection]] = defaultdict(list)
    for index, item in enumerate(content):
        try:
            frame, detection = _Entry(str(path), f"{where}[{index}]", item).detection(images)
        except DatasetError as error:
            refused(error)
            continue
        frames[frame].append(detection)
    sizes = {} if images is None else images.sizes
    for number in sorted({*frames, *sizes}):
        yield RecordedFrame(number, tuple(frames.get(number, ())), image_size=sizes.get(number))


def _json(path: Path) -> object:
    try:
        return json.loads(path.read_bytes())
    except OSError as error:
        raise AnchoringError(f"cannot read {path}: {error.strerror}") from error
    except json.JSONDecodeError as error:
        whole = error.msg.startswith("Extra data")
        raise DatasetError(
            f"it is not JSON: {error.msg} at line {error.lineno}, column {error.colno}; "
            + ("is it JSON Lines, one frame a line?" if whole else "was it cut off?"),
            path=str(path),
        ) from error
    except UnicodeDecodeError as error:
        raise DatasetError("it is not UTF-8", path=str(path)) from error
    except ValueError as error:
        # Python refuses to read integers of thousands of digits.
        raise DatasetError("it holds a number that is too long", path=str(path)) from error
    except RecursionError as error:
        raise DatasetError("it is nested too deeply", path=str(path)) from error


def _images(path: Path, content: object) -> Images:
    file = _Entry(str(path), "", content)
    sizes: dict[int, tuple[int, int] | None] = {}
    for index, item in enumerate(file.list("images")):
        image = _Entry(str(path), f"images[{index}]", item)
        number = image.integer("id", least=0)
        if number in sizes:
            raise image.error("id", f"there are two images {number}")
        told = image.has("width") or image.has("height")
        sizes[number] = (
            (image.integer("width", least=1), image.integer("height", least=1)) if told else None
        )
    types: dict[int, str] = {}
    for index, item in enumerate(file.list("categories") if file.has("categories") else []):
        category = _Entry(str(path), f"categories[{index}]", item)
        types[category.integer("id", least=0)] = category.text("name")
    return Images(dict(sorted(sizes.items())), types)


class _Entry:
    """A JSON object of a file, where it stands, and how to read it."""

    def __init__(self, path: str, where: str, item: object) -> None:
        self._path = path
        self._where = where
        if not isinstance(item, dict):
            raise DatasetError(f"expected an object, found {item!r:.40}", path=path, key=where)
        self._item = item

    def detection(self, images: Images | None) -> tuple[int, Detection]:
        frame = self.integer("image_id", least=0)
        if images is not None and frame not in images.sizes:
            raise self.error("image_id", f"there is no image {frame} in the images' file")
        category = self.integer("category_id", least=0)
        types = {} if images is None else images.types
        if types and category not in types:
            raise self.error("category_id", f"there is no category {category} in the images' file")
        x, y, width, height = self._numbers("bbox", 4)
        if not (width > 0 and height > 0):
            raise self.error(
                "bbox", f"it is {width:g} px wide and {height:g} px high; expected above 0 px"
            )
        score = self._numbers("score", 1)[0] if self.has("score") else 1.0
        name = types.get(category, f"category-{category}")
        try:
            [detection] = checked_detections(
                [Detection(name, (x, y, x + width, y + height), score)], "image"
            )
            size = None if images is None else images.sizes[frame]
            if size is not None:
                check_within([detection], size)
        except AnchoringError as error:
            raise DatasetError(str(error), path=self._path, key=self._where) from error
        return frame, detection

    def has(self, key: str) -> bool:
        return key in self._item

    def integer(self, key: str, *, least: int) -> int:
        value = self._present(key)
        if isinstance(value, bool) or not isinstance(value, int) or value < least:
            raise self.error(
                key, f"expected a whole number of at least {least}, found {value!r:.40}"
            )
        return value

    def text(self, key: str) -> str:
        value = self._present(key)
        if not isinstance(value, str) or not value:
            raise self.error(key, f"expected a name, found {value!r:.40}")
        return value

    def list(self, key: str) -> Sequence[object]:
        value = self._present(key)
        if not isinstance(value, list):
            raise self.error(key, f"expected a list, found {value!r:.40}")
        return value

    def error(self, key: str, message: str) -> DatasetError:
        where = f"{self._where}.{key}" if self._where else key
        return DatasetError(message, path=self._path, key=where)

    def _numbers(self, key: str, count: int) -> tuple[float, ...]:
        value = self._present(key)
        values = [value] if count == 1 else value
        if (
            not isinstance(values, list)
            or len(values) != count
            or any(isinstance(n, bool) or not isinstance(n, int | float) for n in values)
        ):
            expected = "a number" if count == 1 else f"a list of {count} numbers"
            raise self.error(key, f"expected {expected}, found {value!r:.40}")
        try:
            return tuple(float(number) for number in values)
        except OverflowError:
            raise self.error(key, "it holds a number that is too large") from None

    def _present(self, key: str) -> object:
        if key not in self._item:
            raise self.error(key, "it is missing")
        return self._item[key]
