"""The drives that are proposed move the loops: no motion of all joints has next to no rates of the driven ones."""

from itertools import pairwise

import numpy as np
import pytest

import jaxkin as jk


@pytest.mark.parametrize("seed", range(12))
def test_no_motion_is_nearly_at_rest_in_the_proposed_drives(seed):
    """Of random loops of eight hinges, two freedoms each: rates by the null space of their closure Jacobian.

    With the first independent joints at the fixed part, four of the twelve had a motion of unit norm with rates of
    less than 0.1 there.
    """
    random = np.random.default_rng(seed)
    parts = ["ground", *(f"bar {k}" for k in range(7)), "ground"]
    joints = [
        jk.revolute(f"J{k}", *pair, point=random.normal(size=3), axis=random.normal(size=3))
        for k, pair in enumerate(pairwise(parts))
    ]
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=joints)
    equations = mechanism.closure({})
    motions = np.linalg.svd(np.asarray(equations.jacobian))[2][6:]
    drives = mechanism.mobility().drivable
    assert len(drives) == 2
    rates = motions[:, [equations.coordinates.index(name) for name in drives]]
    assert np.linalg.svd(rates, compute_uv=False)[-1] > 0.1
