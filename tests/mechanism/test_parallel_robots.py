"""Robots with several inputs: the legs of a hexapod, in order and shuffled, against its inverse kinematics."""

import numpy as np
import pytest

from jaxkin.joints.pairs import prismatic, revolute, spherical
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.solve.options import SolverOptions
from reference import parallel
from reference.catalogue import delta, hexapod
from reference.mechanisms import rssr_linkage, spherical_linkage

MANY = SolverOptions().interpolate_from
LEGS = [f"leg {i}" for i in range(6)]


@pytest.mark.long
@pytest.mark.study
@pytest.mark.parametrize("shuffled", [False, True])
def test_a_hexapod_follows_its_legs(shuffled):
    mechanism = hexapod()
    home = np.array([mechanism.joints[f"top {i}"].frames_1[0][:3, 3] for i in range(6)])
    moved, legs = parallel.curve(parallel.hexapod().base, home, 60)
    which = np.random.default_rng(5).permutation(60) if shuffled else np.arange(60)
    motion = mechanism.sweep(dict(zip(LEGS, legs[which].T, strict=True)))
    assert np.all(motion.closed)
    # mm and radians: rounding of lengths of 300 mm, through a Jacobian of condition 100
    np.testing.assert_allclose(motion.transforms["platform"], moved[which], atol=1e-10)


@pytest.mark.long
@pytest.mark.study
def test_many_poses_of_a_hexapod():
    """So many that neighbours share an inverse; there and back along the curve."""
    mechanism = hexapod()
    home = np.array([mechanism.joints[f"top {i}"].frames_1[0][:3, 3] for i in range(6)])
    moved, legs = (part.reshape(MANY, *part.shape[2:]) for part in _twice(home))
    motion = mechanism.sweep(dict(zip(LEGS, legs.T, strict=True)))
    assert np.all(motion.closed)
    np.testing.assert_allclose(motion.transforms["platform"], moved, atol=1e-10)  # as above


def _twice(home):
    moved, legs = parallel.curve(parallel.hexapod().base, home, MANY // 2)
    return np.stack([moved, moved[::-1]]), np.stack([legs, legs[::-1]])


def test_which_rods_spin_idly():
    assert rssr_linkage().linkage.classes[0].spins == ((0, 1, 1, -1),)
    assert len(hexapod().linkage.classes[0].spins) == 6 and len(delta().linkage.classes[0].spins) == 6
    assert spherical_linkage().linkage.classes[0].spins == ()


def test_a_door_on_two_balls_turns():
    """The turn about the line of two balls is of use on one body; beside an oblique slide there is none."""
    hinges = [spherical(name, "frame", "door", point=(0, 0, z)) for name, z in (("low", 0.0), ("high", 9.0))]
    door = Mechanism.build(fixed=["frame"], joints=hinges)
    assert door.linkage.classes[0].spins == ()
    oblique = [
        revolute("in", "ground", "crank", point=(0, 0, 0), axis=(0, 0, 1)),
        spherical("a", "crank", "tube", point=(1, 0, 0)),
        prismatic("slide", "tube", "rod", axis=(1, 1, 0)),
        spherical("b", "rod", "rocker", point=(5, 0, 0)),
        revolute("out", "ground", "rocker", point=(5, 1, 0), axis=(0, 0, 1)),
    ]
    assert Mechanism.build(fixed=["ground"], joints=oblique).linkage.classes[0].spins == ()
