"""The models by name."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Final

from aapa.errors import AnchoringError
from aapa.lacater.models.anchored import AnchoredSnitch, lacater_parameters
from aapa.lacater.models.heuristic import ClosestObject
from aapa.lacater.models.last_seen import LastSeen
from aapa.lacater.models.model import Model
from aapa.lacater.models.network import SHIPPED, Network, network_named
from aapa.lacater.models.plus import BeyondAapa, Ideas
from aapa.lacater.models.refined import Refined, shipped_weights


@dataclass(frozen=True, slots=True)
class Family:
    """Models of one kind.

    Args:
        pattern: What their names look like, for the person, such as "aapa-TAU".
        matches: A regular expression for the whole name.
        build: Makes the model from the match.
    """

    pattern: str
    matches: str
    build: Callable[[re.Match[str]], Model]


def _last_seen(match: re.Match[str]) -> Model:
    return Model(match[0], lambda _cast: LastSeen())


def _heuristic(match: re.Match[str]) -> Model:
    return Model(match[0], lambda _cast: ClosestObject())


def _anchored(match: re.Match[str], *, use_attachments: bool) -> Model:
    parameters = lacater_parameters(float(match["tau"]), use_attachments=use_attachments)
    radius = round(parameters.radius, 1)
    return Model(
        match[0],
        partial(AnchoredSnitch, parameters),
        {"tau_px2": parameters.tau, "radius_px": radius},
    )


def _plus(match: re.Match[str]) -> Model:
    ideas = Ideas(camera=match["camera"] is not None)
    for name in (match["less"] or "").split("-without-")[1:]:
        ideas = ideas.without(name.replace("-", "_"))
    return Model(match[0], partial(BeyondAapa, ideas), asdict(ideas))


def _refined(match: re.Match[str]) -> Model:
    return Model(match[0], lambda cast: Refined(Ideas(), shipped_weights(), cast), asdict(Ideas()))


_TAU = r"(?P<tau>[0-9]{1,9}(?:\.[0-9]{1,9})?)"

FAMILIES: Final = (
    Family("last-seen", "last-seen", _last_seen),
    Family("heuristic", "heuristic", _heuristic),
    Family("pa-TAU", f"pa-{_TAU}", partial(_anchored, use_attachments=False)),
    Family("aapa-TAU", f"aapa-{_TAU}", partial(_anchored, use_attachments=True)),
    Family(
        "aapa-plus[-camera][-without-IDEA]",
        r"aapa-plus(?P<camera>-camera)?(?P<less>(?:-without-[a-z-]+?)*)",
        _plus,
    ),
    Family("aapa-refined", "aapa-refined", _refined),
)
"""All models that go frame by frame. TAU is in squared px, IDEA a switch of `plus.ideas`."""

PAPER_MODELS: Final = (
    "last-seen",
    "heuristic",
    "pa-6500",
    "aapa-3000",
    "aapa-6500",
    "aapa-10000",
)
"""Those that need no training, of the paper's table and of the work it compares with."""


def model_named(name: str) -> Model:
    """Give the model of a name such as "aapa-6500", one that goes frame by frame.

    Raises:
        AnchoringError: There is no such model; the text says which there are.
    """
    for family in FAMILIES:
        match = re.fullmatch(family.matches, name)
        if match is not None:
            return family.build(match)
    if name in SHIPPED:
        raise AnchoringError(
            f"{name} looks at whole videos, and cannot be asked frame by frame; "
            "`icarus cater evaluate` runs it"
        )
    patterns = [*(family.pattern for family in FAMILIES), *SHIPPED]
    near = difflib.get_close_matches(name, [*PAPER_MODELS, *patterns], n=1)
    hint = f"did you mean {near[0]!r}? " if near else ""
    raise AnchoringError(f"there is no model {name!r}; {hint}known are {', '.join(patterns)}")


def models_named(
    names: Sequence[str], weights: Mapping[str, Path] | None = None
) -> tuple[Model | Network, ...]:
    """Give the models of several names, each once, in the order given.

    Args:
        names: Of models that go frame by frame, or of networks.
        weights: The file of a network's weights, by its name. What is named here is a network,
            whatever it is called.

    Raises:
        AnchoringError: There is no such model, or no name at all; a network's weights are not
            there, or are of no model that was asked for.
    """
    if not names:
        raise AnchoringError("no model is named; for example last-seen,aapa-6500")
    known = dict(weights or {})
    for name in known:
        if name not in names:
            raise AnchoringError(
                f"there are weights for {name!r}, which is not among the models: {', '.join(names)}"
            )
    return tuple(
        network_named(name, known.get(name))
        if name in known or name in SHIPPED
        else model_named(name)
        for name in dict.fromkeys(names)
    )
