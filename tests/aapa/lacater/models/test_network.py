"""Networks by name: what they are handed, and that a video's boxes are its own."""

from __future__ import annotations

import sys

import numpy as np
import pytest

from aapa.errors import AnchoringError, DatasetError
from aapa.lacater.classes import SNITCH
from aapa.lacater.generator import DetectorNoise
from aapa.lacater.generator.video import generate_video
from aapa.lacater.layout import PerceptionKind
from aapa.lacater.models import Footage, Model, Network, model_named, models_named
from aapa.lacater.models.network import SHIPPED, TOGETHER, network_named, slots_looked_at
from aapa.lacater.video import Perception
from aapa.neural.guidance import NO_SLOT

torch = pytest.importorskip("torch")
pytest.importorskip("safetensors")

from aapa.neural.checkpoints import Guidance, Meta, save_checkpoint  # noqa: E402
from aapa.neural.models import build_network  # noqa: E402


@pytest.fixture
def weights(tmp_path):
    """Writes weights of a small network that nobody has trained."""

    def make(name="opnet", guidance=None, seed=1, sizes=(16, 24)):
        path = tmp_path / f"{name}-{seed}.safetensors"
        with torch.random.fork_rng():
            torch.manual_seed(seed)
            widths = dict(zip(("who_hidden", "where_hidden"), sizes, strict=True))
            network = build_network(name, widths)
        save_checkpoint(path, network, Meta(name, widths, guidance))
        return path

    return make


def footage(number):
    made = generate_video(79, number, DetectorNoise())
    perception = made.perceptions[PerceptionKind.OD]
    classes = sorted({c for each in perception.classes for c in each.tolist()})
    looked_at = np.full(perception.frames, SNITCH)
    looked_at[100:150] = classes[0]
    looked_at[200:210] = 7 if 7 not in classes else 11
    return Footage(perception, looked_at)


def test_a_video_s_boxes_do_not_depend_on_which_others_come_with_it(weights):
    # As wide as the published network: how a product is split up depends on its size.
    network = network_named("mine", weights(sizes=(256, 512)))
    films = [footage(number) for number in range(TOGETHER + 2)]
    alone = [network.predict([film])[0] for film in films]
    for order in (range(TOGETHER + 2), [5, 1, 9, 0], [3, 3, 2]):
        for number, boxes in zip(order, network.predict([films[n] for n in order]), strict=True):
            np.testing.assert_array_equal(boxes, alone[number])


def test_boxes_are_boxes(weights):
    boxes = network_named("mine", weights()).predict([footage(0)])[0]
    assert boxes.shape == (300, 4)
    assert (boxes[:, 2:] >= boxes[:, :2]).all()
    assert np.isfinite(boxes).all()


def test_videos_of_several_lengths_go_together(weights):
    network = network_named("mine", weights())
    film = footage(1)
    short = Footage(
        Perception(film.perception.boxes[:40], film.perception.classes[:40]), film.looked_at[:40]
    )
    both = network.predict([short, film])
    assert [len(boxes) for boxes in both] == [40, 300]
    np.testing.assert_allclose(both[0], network.predict([short])[0], atol=1e-3)


def test_slots_are_those_of_the_features():
    boxes = tuple(np.zeros((n, 4), dtype=np.int64) for n in (2, 1, 0))
    seen = (np.array([SNITCH, 150]), np.array([3]), np.array([], dtype=np.int64))
    film = Footage(Perception(boxes, seen), np.array([150, 3, 9]))
    assert slots_looked_at(film).tolist() == [2, 1, NO_SLOT]


def test_a_class_beyond_the_fifteenth_slot_is_not_told(weights):
    classes = np.arange(20)
    perception = Perception((np.tile([0, 0, 9, 9], (20, 1)),), (classes,))
    path = weights("opnet-aa", Guidance(100.0, "product"))
    network = network_named("opnet-aa", path)
    told, untold = (
        network.predict([Footage(perception, np.array([number]))])[0] for number in (18, -1)
    )
    np.testing.assert_array_equal(told, untold)


def test_guidance_changes_what_a_network_with_guidance_gives_and_nothing_else(weights):
    film = footage(2)
    blind = Footage(film.perception, np.full(300, -1))
    answers = []
    for mode in ("product", "softmax", "renormalised"):
        path = weights("opnet-aa", Guidance(100.0, mode))
        network = network_named("mine", path)
        answers.append(network.predict([film])[0])
        assert abs(answers[-1] - network.predict([blind])[0]).max() > 0.1, mode
    # The same numbers, told in three ways.
    for first, second in ((0, 1), (0, 2), (1, 2)):
        assert abs(answers[first] - answers[second]).max() > 0.1
    plain = network_named("opnet", weights())
    np.testing.assert_array_equal(plain.predict([film])[0], plain.predict([blind])[0])


def test_weights_that_changed_on_disk_are_read_anew(weights):
    film, path = footage(0), weights(seed=1)
    network = network_named("mine", path)
    before = network.predict([film])[0]
    path.write_bytes(weights(seed=2).read_bytes())
    assert abs(network.predict([film])[0] - before).max() > 0.1


def test_names_give_networks_and_models_in_their_order(weights):
    path = weights()
    found = models_named(["aapa-6500", "mine"], {"mine": path})
    assert [type(each) for each in found] == [Model, Network]
    assert found[1].parameters == {"weights": path.name}
    guided = network_named("x", weights("opnet-aa", Guidance(5.0, "softmax")))
    assert guided.parameters["w"] == 5.0
    assert guided.parameters["mode"] == "softmax"


def test_weights_of_a_model_that_is_not_asked_for_are_an_error(weights):
    with pytest.raises(AnchoringError, match="weights for 'mine', which is not among the models"):
        models_named(["opnet"], {"mine": weights()})


def test_a_network_cannot_be_asked_frame_by_frame():
    with pytest.raises(AnchoringError, match="looks at whole videos"):
        model_named("opnet-aa")


def test_without_weights_the_text_says_how_to_get_some(tmp_path):
    with pytest.raises(
        AnchoringError, match=r"opnet has no weights: there is no file .*cater train"
    ):
        network_named("opnet", tmp_path / "nothing.safetensors")


def test_a_name_that_says_how_it_is_told_takes_no_weights_of_another_kind(weights):
    with pytest.raises(AnchoringError, match="with no guidance, and opnet-aa means one with the"):
        network_named("opnet-aa", weights())
    with pytest.raises(AnchoringError, match="guidance 'product', and opnet-aa-softmax means"):
        network_named("opnet-aa-softmax", weights("opnet-aa", Guidance(100.0, "product")))
    with pytest.raises(AnchoringError, match="guidance 'product', and opnet means one with no"):
        network_named("opnet", weights("opnet-aa", Guidance(100.0, "product")))


def test_a_file_that_is_no_network_is_refused(tmp_path):
    path = tmp_path / "bad.safetensors"
    path.write_bytes(b"\x80\x04pickle")
    with pytest.raises(DatasetError, match=r"bad\.safetensors"):
        network_named("mine", path)


@pytest.mark.parametrize("name", SHIPPED)
def test_without_pytorch_one_sentence_names_the_extra(name, monkeypatch):
    monkeypatch.setitem(sys.modules, "torch", None)
    monkeypatch.setattr("aapa.neural.extra.find_spec", lambda _name: None)
    with pytest.raises(AnchoringError, match=rf"^{name} .*pip install 'icarus-lite\[neural\]'$"):
        models_named([name])
