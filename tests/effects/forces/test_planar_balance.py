"""The balance of loops in a plane against that of the same loops without a class, whose unknowns are all held alike.

Tolerance: 1e-11 of the largest wrench, rounding times the condition of the equations, about 1e3.
"""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.effects.forces.balance import balance, solve
from jaxkin.effects.forces.places import places
from jaxkin.geometry.pose import frame
from jaxkin.linkage.loop_class import LoopClass

CORNERS = {"A": (0, 0, 0.3), "B": (1, 0, -0.2), "C": (3.2, 2.9, 0.1), "D": (4, 0, 0.7)}
"""Hinges of a four-bar linkage, no two of them at the same height."""
PARTS = {"A": ("ground", "crank"), "B": ("crank", "rod"), "C": ("rod", "rocker"), "D": ("ground", "rocker")}


def _fourbar(normal, sliding: str) -> jk.Mechanism:
    """Make a four-bar linkage in a plane across `normal`; the joints `sliding` slide along it, too."""
    turn = frame(np.zeros(3), np.asarray(normal, float))[:3, :3]
    joints = [
        (jk.cylindrical if name in sliding else jk.revolute)(name, *PARTS[name], point=turn @ at, axis=turn[:, 2])
        for name, at in CORNERS.items()
    ]
    return jk.Mechanism.build(fixed=["ground"], joints=joints)


def _door() -> jk.Mechanism:
    """Make a door on two hinges: the plane leaves open how they share what acts across their axis."""
    hinges = [jk.revolute(name, "wall", "door", point=(0, 0, z), axis=(0, 0, 1)) for name, z in (("A", 2), ("B", 0))]
    return jk.Mechanism.build(fixed=["wall"], joints=hinges)


CASES = {
    "upright": lambda: _fourbar((0, 0, 1), ""),
    "against x": lambda: _fourbar((-1, 0, 0), ""),
    "oblique": lambda: _fourbar((-0.48, 0.6, 0.64), ""),
    "one slides": lambda: _fourbar((0.48, 0.6, 0.64), "C"),
    "two slide": lambda: _fourbar((0.48, 0.6, 0.64), "BC"),
    "door": _door,
}


@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_loops_in_a_plane_are_balanced_as_loops_in_space(name):
    mechanism, rng = CASES[name](), np.random.default_rng(0)
    motion = mechanism.sweep({"A.phi": np.linspace(0.1, 0.9, 3)})
    linkage = mechanism.linkage
    assert all(each.plane for each in linkage.classes)
    in_space = replace(linkage, classes=(LoopClass(),) * len(linkage.classes))
    acting = {part: jnp.asarray(rng.normal(size=(6, 3))) for part in mechanism.parts if part not in mechanism.fixed}

    @jax.jit
    def both(displacements):
        found = balance(linkage, places(linkage, displacements, chords=True), displacements, [(0, 0)])
        return [solve(each, found, [(0, 0)], acting, {}) for each in (linkage, in_space)]

    planar, general = both(motion.displacements)
    largest = max(float(jnp.abs(wrench).max()) for wrench in general.wrenches)
    for one, other in zip(jax.tree.leaves(planar), jax.tree.leaves(general), strict=True):
        np.testing.assert_allclose(one, other, atol=1e-11 * largest)
