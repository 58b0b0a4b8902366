from __future__ import annotations

import pytest

from aapa.errors import AnchoringError
from aapa.lacater.generator.noise import DetectorNoise, read_noise


@pytest.mark.parametrize(
    ("name", "value", "text"),
    [
        ("jitter_px", -0.1, "jitter_px is -0.1; it has to be a number from 0 on"),
        ("jitter_px", float("nan"), "jitter_px is nan; it has to be a number from 0 on"),
        ("miss_rate", 1.5, "miss_rate is 1.5; it has to be at most 1"),
        ("settling", 1.0, "settling is 1.0; it has to be below 1"),
        ("swap_frames", 0.5, "swap_frames is 0.5; it has to be at least 1"),
        ("seen_slope", 0.0, "seen_slope is 0.0; it has to be above 0"),
    ],
)
def test_values_out_of_range_are_refused(name, value, text):
    with pytest.raises(AnchoringError, match=f"^{text}$"):
        DetectorNoise(**{name: value})


def test_a_file_changes_what_it_names(tmp_path):
    file = tmp_path / "noise.yaml"
    file.write_text("jitter_px: 1\nblind_classes: [0, 5]\n")
    assert read_noise(file) == DetectorNoise(jitter_px=1, blind_classes=(0, 5))
    file.write_text("")
    assert read_noise(file) == DetectorNoise()


@pytest.mark.parametrize(
    ("content", "text"),
    [
        ("jiter_px: 1", "there is no parameter 'jiter_px'; did you mean jitter_px?"),
        ("jitter_px: much", "jitter_px is 'much'; it has to be a number"),
        ("jitter_px: true", "jitter_px is True; it has to be a number"),
        ("miss_rate: 3", "miss_rate is 3; it has to be at most 1"),
        ("blind_classes: 0", "expected a list of class numbers, 0 to 192"),
        ("blind_classes: [193]", "expected a list of class numbers, 0 to 192"),
        ("- 1", "expected the names of parameters and their values"),
        ("a: [", "is no YAML"),
    ],
)
def test_a_wrong_file_says_what_is_wrong(tmp_path, content, text):
    file = tmp_path / "noise.yaml"
    file.write_text(content)
    with pytest.raises(AnchoringError) as caught:
        read_noise(file)
    assert str(caught.value).startswith(f"{file}: ")
    assert text in str(caught.value)


def test_a_missing_file_is_said_to_be(tmp_path):
    with pytest.raises(AnchoringError, match="cannot be read: No such file"):
        read_noise(tmp_path / "none.yaml")
