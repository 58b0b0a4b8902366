from __future__ import annotations

import pytest

from aapa.errors import AnchoringError
from aapa.parameters import AnchoringParameters


def test_the_defaults_are_the_papers():
    parameters = AnchoringParameters()
    assert (parameters.tau, parameters.space, parameters.position_gain) == (6500.0, "image", 1.0)
    assert (parameters.confidence_gain, parameters.confidence_loss) == (0.1, 0.1)
    assert (parameters.min_anchor_confidence, parameters.min_report_confidence) == (0.3, 0.1)
    assert parameters.use_attachments
    assert parameters.radius == pytest.approx(80.6226, abs=1e-4)


@pytest.mark.parametrize(
    ("key", "value", "text"),
    [
        ("tau", 0, "tau is 0; it has to be above 0, in squared px"),
        ("tau", -3.0, "above 0"),
        ("tau", float("nan"), "tau is nan; it has to be a finite number"),
        ("tau", float("inf"), "finite"),
        ("tau", "6500", "tau is '6500'; it has to be a number"),
        ("tau", True, "a number"),
        ("space", "world", 'space is \'world\'; it has to be "image" or "base"'),
        ("position_gain", 0, "position_gain is 0; it has to be above 0"),
        ("position_gain", 1.5, "position_gain is 1.5; it has to be within 0…1"),
        ("confidence_gain", -0.1, "above 0"),
        ("confidence_loss", 0.0, "above 0"),
        ("confidence_loss", 2, "within 0…1"),
        ("initial_confidence", -0.5, "within 0…1"),
        ("min_anchor_confidence", 1.1, "within 0…1"),
        ("min_report_confidence", None, "min_report_confidence is None; it has to be a number"),
        ("margin_px", -1, "margin_px is -1; it has to be at least 0 px"),
        ("blink", -1, "blink is -1; it has to be a whole number of frames, at least 0"),
        ("blink", 1.5, "whole number"),
        ("blink", True, "whole number"),
        ("use_attachments", "no", "use_attachments is 'no'; it has to be true or false"),
        ("unique_types", "case", "unique_types is 'case'; expected a set of type names"),
        ("unique_types", frozenset({1}), "expected a set of type names"),
        ("image_size", (320,), r"image_size is \(320,\); expected a width and a height"),
        ("image_size", (320, 0), "expected a width and a height"),
        ("image_size", (320.0, 240.0), "in whole px"),
    ],
)
def test_a_wrong_value_is_named(key, value, text):
    with pytest.raises(AnchoringError, match=text):
        AnchoringParameters(**{key: value})
    with pytest.raises(AnchoringError, match=text):
        AnchoringParameters.from_mapping({key: value})


def test_squared_pixels_are_no_squared_metres():
    with pytest.raises(AnchoringError, match=r"a radius of 81 m: in base space it is in squared m"):
        AnchoringParameters(space="base")
    assert AnchoringParameters(space="base", tau=0.01).radius == pytest.approx(0.1)


def test_a_mapping_may_hold_lists():
    parameters = AnchoringParameters.from_mapping(
        {"tau": 0.04, "space": "base", "unique_types": ["case", "plug"], "image_size": [640, 480]}
    )
    assert parameters == AnchoringParameters(
        tau=0.04,
        space="base",
        unique_types=frozenset({"case", "plug"}),
        image_size=(640, 480),
    )


def test_unknown_keys_are_named_with_what_was_meant():
    with pytest.raises(AnchoringError) as caught:
        AnchoringParameters.from_mapping({"confidence_los": 0.1, "colour": "red", 3: 1})
    text = str(caught.value)
    assert "unknown anchoring parameter 'confidence_los'; did you mean 'confidence_loss'?" in text
    assert "'colour'; known are tau, space, " in text
    assert "unknown anchoring parameter 3" in text


def test_what_is_no_mapping_is_refused():
    with pytest.raises(AnchoringError, match="expected keys, values"):
        AnchoringParameters.from_mapping([("tau", 3)])
