"""The networks: sizes, shapes, gradients, and what each may and may not look at."""

from __future__ import annotations

import pytest
import torch

from aapa import AnchoringError
from aapa.neural.models import NETWORKS, OPNet, build_network, parameter_count
from aapa.neural.models.recurrence import Lstm

TINY = {
    "opnet": {"who_hidden": 5, "where_hidden": 7},
    "opnet-aa": {"who_hidden": 5, "where_hidden": 7},
    "opnet-mlp": {"who_hidden": 5, "where_hidden": 7},
    "baseline-lstm": {"hidden": 7},
    "nonlinear-lstm": {"slot_hidden": 4, "hidden": 7},
    "transformer-lstm": {
        "slot_hidden": 4,
        "feedforward": 6,
        "heads": 2,
        "layers": 1,
        "hidden": 5,
    },
}


@pytest.fixture(params=sorted(NETWORKS))
def network(request: pytest.FixtureRequest) -> torch.nn.Module:
    torch.manual_seed(3)
    return build_network(request.param, TINY[request.param])


def features_for(network: torch.nn.Module, frames: int = 6) -> torch.Tensor:
    return torch.rand(2, frames, 15, network.features, generator=torch.manual_seed(5))


@pytest.mark.parametrize(
    ("name", "parameters"),
    [
        ("opnet", 1_421_056),
        ("opnet-aa", 1_421_056),
        # Without the second LSTM: 354,304 + 3,840, then 6 x 512 and 512 x 4.
        ("opnet-mlp", 363_264),
        ("baseline-lstm", 75 * 2048 + 512 * 2048 + 512 * 4),
        ("nonlinear-lstm", 5 * 256 + 3840 * 2048 + 3 * 512 * 2048 + 512 * 4),
        # Two encoder layers of 1,315,072, as PyTorch's have with 2,048 inside.
        ("transformer-lstm", 5 * 256 + 2 * 1_315_072 + 256 * 2048 + 3 * 512 * 2048 + 512 * 4),
    ],
)
def test_the_published_number_of_parameters(name: str, parameters: int):
    assert parameter_count(build_network(name)) == parameters


def test_a_box_for_every_frame_of_every_video(network: torch.nn.Module):
    assert network(features_for(network)).shape == (2, 6, 4)


def test_every_parameter_learns_something(network: torch.nn.Module):
    network(features_for(network)).square().sum().backward()
    for name, parameter in network.named_parameters():
        assert parameter.grad is not None, name
        assert parameter.grad.abs().sum() > 0, name


def test_gradients_are_those_of_the_function(network: torch.nn.Module):
    network.double().eval()
    features = features_for(network, 3).double().requires_grad_()
    assert torch.autograd.gradcheck(network, (features,), atol=1e-4)


def test_no_frame_looks_ahead(network: torch.nn.Module):
    network.eval()
    features = features_for(network)
    changed = features.clone()
    changed[:, 4:] += 1
    before, after = network(features), network(changed)
    assert torch.equal(before[:, :4], after[:, :4])
    assert not torch.equal(before[:, 4:], after[:, 4:])


def test_videos_do_not_see_each_other(network: torch.nn.Module):
    network.eval()
    features = features_for(network)
    alone = network(features[:1])
    assert torch.allclose(network(features)[:1], alone, atol=1e-6)


def test_a_layer_computes_what_the_equations_say():
    torch.manual_seed(1)
    layer = Lstm(3, 4)
    sequence = torch.rand(2, 5, 3)
    state, cell = torch.zeros(2, 4), torch.zeros(2, 4)
    expected = []
    for frame in range(5):
        gates = sequence[:, frame] @ layer.weight_ih_l0.T + state @ layer.weight_hh_l0.T
        write, keep, new, show = gates.chunk(4, dim=1)
        cell = keep.sigmoid() * cell + write.sigmoid() * new.tanh()
        state = show.sigmoid() * cell.tanh()
        expected.append(state)
    assert torch.allclose(layer(sequence), torch.stack(expected, dim=1), atol=1e-6)


def test_attention_is_shares_that_add_up_to_one():
    torch.manual_seed(1)
    opnet = OPNet(5, 7)
    shares = opnet.who(features_for(opnet))
    assert shares.shape == (2, 6, 15)
    assert torch.allclose(shares.sum(dim=-1), torch.ones(2, 6))
    assert (shares > 0).all()


def guided(features: torch.Tensor, weights: torch.Tensor, opnet: OPNet) -> torch.Tensor:
    """What the second network is handed."""
    handed: list[torch.Tensor] = []
    hook = opnet.where.register_forward_pre_hook(lambda _module, given: handed.append(given[0]))
    opnet(features, weights)
    hook.remove()
    return handed[0]


def test_w_multiplies_the_attention_after_the_softmax_and_nothing_is_renormalised():
    torch.manual_seed(1)
    opnet = OPNet(5, 7)
    features = features_for(opnet)
    weights = torch.ones(2, 6, 15)
    weights[..., 3] = 100
    shares = opnet.who(features)
    expected = (shares[..., None] * weights[..., None] * features).sum(dim=2)
    assert torch.allclose(guided(features, weights, opnet), expected, rtol=1e-4)
    assert torch.equal(opnet(features, torch.ones(2, 6, 15)), opnet(features))


def test_where_the_slot_to_follow_is_empty_the_product_is_nothing():
    torch.manual_seed(1)
    opnet = OPNet(5, 7)
    features = torch.zeros(1, 2, 15, 6)
    weights = torch.ones(1, 2, 15)
    weights[..., 3] = 100
    assert not guided(features, weights, opnet).any()


def test_renormalised_it_remains_an_attention():
    torch.manual_seed(1)
    opnet = OPNet(5, 7)
    opnet.renormalise = True
    features = torch.ones(2, 6, 15, 6)
    weights = torch.ones(2, 6, 15)
    weights[..., 3] = 100
    assert torch.allclose(guided(features, weights, opnet), torch.ones(2, 6, 6))


def test_the_transformer_attends_to_the_slots_of_its_frame():
    torch.manual_seed(1)
    network = build_network("transformer-lstm", TINY["transformer-lstm"]).eval()
    features = features_for(network)
    changed = features.clone()
    changed[:, 2, 9] += 1  # neither the snitch's slot nor another frame
    assert not torch.equal(network(features)[:, 2], network(changed)[:, 2])
    assert torch.equal(network(features)[:, :2], network(changed)[:, :2])


@pytest.mark.parametrize(
    ("name", "sizes", "said"),
    [
        ("opnett", {}, "no network 'opnett'; did you mean 'opnet'"),
        ("opnet", {"hidden": 4}, "opnet has no size 'hidden'; it has who_hidden, where_hidden"),
        ("opnet", {"who_hidden": 0}, "who_hidden is 0; it has to be from 1 to"),
        ("opnet", {"who_hidden": 10**9}, "it has to be from 1 to 8192"),
        ("opnet", {"who_hidden": True}, "who_hidden is True"),
        ("opnet", {"who_hidden": "8"}, "who_hidden is '8'"),
        ("transformer-lstm", {"slot_hidden": 5}, "multiple of heads, 2"),
        ("transformer-lstm", {"layers": 1000}, "layers is 1000"),
    ],
)
def test_what_cannot_be_built_is_refused_in_words(name: str, sizes: dict[str, object], said: str):
    with pytest.raises(AnchoringError) as refused:
        build_network(name, sizes)
    assert said in str(refused.value)
