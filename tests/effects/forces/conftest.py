"""The four-bar with masses, over a whole turn."""

import pytest

import jaxkin as jk
from reference.energies import FOURBAR_MASSES, fourbar, whole_turn


@pytest.fixture(scope="module")
def motion() -> jk.Motion:
    return fourbar().sweep({"A": whole_turn()})


@pytest.fixture(scope="module")
def masses(motion) -> jk.Masses:
    return jk.masses(motion.mechanism, given=FOURBAR_MASSES)
