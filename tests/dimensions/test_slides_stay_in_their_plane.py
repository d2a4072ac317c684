"""Lengths of a part with a slide and two hinges, placed askew: what the lengths leave free does not move by rounding.

The slide may be anywhere along the normal of the plane. Loops whose slide has left the plane by 1e-11 of their size are
told `UNREACHABLE` at every pose.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk

TURN = np.linspace(0.0, 0.3, 5)


def _askew(seed: int):
    """A rotation, as a function of vectors, from random numbers."""
    turn = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))[0]
    return lambda vector: turn @ np.asarray(vector, float)


def _rack_and_rocker(seed: int) -> jk.Mechanism:
    """A pinion on the ground moves a rack, which a rod ties to a rocker."""
    placed = _askew(seed)
    normal = placed((0, 0, 1))
    joints = [
        jk.revolute("A", "ground", "pinion", point=placed((0, 0, 0)), axis=normal),
        jk.prismatic("S", "ground", "rack", point=placed((0, 3.6, 0)), axis=placed((1, 0, 0))),
        jk.revolute("E", "rack", "rod", point=placed((0, 6, 0)), axis=normal),
        jk.revolute("F", "rod", "rocker", point=placed((9.6, 10.8, 0)), axis=normal),
        jk.revolute("G", "ground", "rocker", point=placed((12, 0, 0)), axis=normal),
    ]
    return jk.Mechanism.build(fixed=["ground"], joints=joints, couplings=[jk.rack("A", "S", -3.6)], unit="mm")


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("change", [1e-7, 1e-4, 1e-2])
def test_all_poses_close_after_a_change_of_the_ground(seed, change):
    mechanism = _rack_and_rocker(seed)
    key = ("ground", "S", "G")
    changed = mechanism.with_lengths({key: mechanism.lengths[key] * (1 + change)})
    slide = changed.joints["S"]
    normal = _askew(seed)((0, 0, 1))
    off = (np.asarray(slide.frames_1) - np.asarray(slide.frames_2))[0, :3, 3] @ normal
    assert abs(off) < 1e-14 * 12  # rounding of its place
    assert changed.sweep({"A": TURN}).closed.all()


@pytest.mark.long
def test_traced_lengths_close_too():
    mechanism = _rack_and_rocker(0)
    key = ("ground", "S", "G")

    @jax.jit
    def residual(length):
        return jnp.max(mechanism.with_lengths({key: length}).sweep({"A": TURN}).residual)

    assert residual(3.6 * (1 + 1e-4)) < 1e-13
