"""The 193 classes of the LA-CATER detector: size, colour, shape and material of an object.

An object's class has no instance number: two large green rubber cones share one.

Source: Shamsian et al., Learning Object Permanence from Video, ECCV 2020 (the published code).
"""

from __future__ import annotations

from typing import Final

COLORS: Final = ("blue", "brown", "cyan", "gray", "green", "purple", "red", "yellow")
"""The colours of all objects but the snitch, in the order of the class numbers."""

SHAPES: Final = ("cone", "cube", "cylinder", "sphere")
"""The shapes of all objects but the snitch, in the order of the class numbers."""

SIZES: Final = ("large", "medium", "small")
"""The sizes, in the order of the class numbers."""

MATERIALS: Final = ("metal", "rubber")
"""The materials, in the order of the class numbers."""

SNITCH: Final = 140
"""The class of the snitch, the small golden thing that has to be found."""

SNITCH_NAME: Final = "small_gold_spl_metal"
"""The snitch's class as text."""

SNITCH_KEY: Final = "small_gold_spl_metal_Spl_0"
"""The snitch as the label files name it."""


def _all_names() -> tuple[str, ...]:
    names = [
        f"{size}_{color}_{shape}_{material}"
        for size in SIZES
        for material in MATERIALS
        for color in COLORS
        for shape in SHAPES
    ]
    names.insert(SNITCH, SNITCH_NAME)
    return tuple(names)


CLASS_NAMES: Final = _all_names()
"""The name of each class, such as "large_blue_cone_metal"; the index is the class number."""

_NUMBERS: Final = {name: number for number, name in enumerate(CLASS_NAMES)}

CONES: Final = frozenset(number for number, name in enumerate(CLASS_NAMES) if "_cone_" in name)
"""The 48 classes of cones."""

LARGE_CONES: Final = frozenset(n for n in CONES if CLASS_NAMES[n].startswith("large_"))
"""The 16 classes of large cones."""


def class_number(name: str) -> int | None:
    """Give the number of a class, or None if there is no such class.

    Example:
        >>> class_number("small_gold_spl_metal"), class_number("large_blue_cone_metal")
        (140, 0)
    """
    return _NUMBERS.get(name)


def class_of_key(key: str) -> int | None:
    """Give the class of a key of a label file, or None if it is no such key.

    Example:
        >>> class_of_key("small_gold_spl_metal_Spl_0")
        140
    """
    parts = key.split("_", 4)
    return _NUMBERS.get("_".join(parts[:4])) if len(parts) == 5 else None
