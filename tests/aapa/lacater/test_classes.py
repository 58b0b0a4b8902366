from __future__ import annotations

import pytest

from aapa.lacater.classes import (
    CLASS_NAMES,
    CONES,
    LARGE_CONES,
    SNITCH,
    class_number,
    class_of_key,
)


def test_there_are_193_classes_with_the_snitch_at_140():
    assert len(CLASS_NAMES) == len(set(CLASS_NAMES)) == 193
    assert CLASS_NAMES[SNITCH] == "small_gold_spl_metal"


@pytest.mark.parametrize(
    ("number", "name"),
    [
        (0, "large_blue_cone_metal"),  # size 0, metal 0, blue 0, cone 0
        (1 * 4 + 3, "large_brown_sphere_metal"),  # brown is colour 1, sphere shape 3
        (32 + 7 * 4 + 2, "large_yellow_cylinder_rubber"),
        (64 + 32 + 4 * 4 + 1, "medium_green_cube_rubber"),
        (139, "small_cyan_sphere_metal"),  # the last before the snitch
        (141, "small_gray_cone_metal"),  # one higher than the formula from here on
        (160, "small_yellow_sphere_metal"),
        (161, "small_blue_cone_rubber"),
        (192, "small_yellow_sphere_rubber"),
    ],
)
def test_the_number_of_a_class_follows_from_size_material_colour_and_shape(number, name):
    assert CLASS_NAMES[number] == name
    assert class_number(name) == number


def test_there_are_48_cones_of_which_every_fourth_class_from_0_to_60_is_large():
    assert len(CONES) == 48
    assert frozenset(range(0, 61, 4)) == LARGE_CONES
    assert SNITCH not in CONES


@pytest.mark.parametrize(
    ("key", "number"),
    [
        ("small_gold_spl_metal_Spl_0", SNITCH),
        ("large_green_cone_rubber_Cone_1", 48),
        ("medium_blue_cylinder_metal_SmoothCylinder-Short_0", 66),
        ("small_gold_spl_metal", None),
        ("large_pink_cone_rubber_Cone_1", None),
    ],
)
def test_the_key_of_a_label_tells_the_class(key, number):
    assert class_of_key(key) == number


def test_an_unknown_class_has_no_number():
    assert class_number("huge_blue_cone_metal") is None
