from __future__ import annotations

import pytest

from aapa.lacater.generator.simulation import Simulation, simulate


@pytest.fixture(scope="session")
def simulations() -> tuple[Simulation, ...]:
    """The same forty videos for every test that only looks."""
    return tuple(simulate(11, number) for number in range(40))
