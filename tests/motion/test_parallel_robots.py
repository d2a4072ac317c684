"""Robots with several inputs: the legs of a hexapod, in order and shuffled, against its inverse kinematics."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from jaxkin.joints.pairs import prismatic, revolute, spherical
from jaxkin.motion.mechanism import Mechanism
from reference import parallel
from reference.catalogue import delta, hexapod
from reference.mechanisms import rssr_linkage, spherical_linkage

LEGS = [f"leg {i}" for i in range(6)]


def on_a_curve(poses):
    """The platform of the catalogue's hexapod on a closed curve: its displacement, and those of the legs."""
    at = parallel.hexapod()
    mechanism = hexapod()
    home = np.array([mechanism.joints[f"top {i}"].before[0][:3, 3] for i in range(6)])
    x = np.linspace(0.0, 2 * np.pi, poses)
    moved = np.tile(np.eye(4), (poses, 1, 1))
    turn = Rotation.from_rotvec(np.stack([0.1 * np.sin(x), 0.1 - 0.1 * np.cos(x), 0.2 * np.sin(2 * x)], axis=1))
    centre = home.mean(axis=0)
    moved[:, :3, :3] = turn.as_matrix()
    shift = np.stack([20 * np.sin(x), 15 - 15 * np.cos(x), 10 * np.sin(x)], axis=1)
    moved[:, :3, 3] = centre + shift - moved[:, :3, :3] @ centre
    tops = np.einsum("pij,kj->pki", moved[:, :3, :3], home) + moved[:, None, :3, 3]
    return mechanism, moved, np.linalg.norm(tops - at.base, axis=2) - np.linalg.norm(home - at.base, axis=1)


@pytest.mark.parametrize("shuffled", [False, True])
def test_a_hexapod_follows_its_legs(shuffled):
    mechanism, moved, legs = on_a_curve(60)
    which = np.random.default_rng(5).permutation(60) if shuffled else np.arange(60)
    motion = mechanism.sweep(dict(zip(LEGS, legs[which].T, strict=True)))
    assert np.all(motion.closed)
    # mm and radians: rounding of lengths of 300 mm, through a Jacobian of condition 100
    np.testing.assert_allclose(motion.transforms["platform"], moved[which], atol=1e-10)


def test_which_rods_spin_idly():
    assert rssr_linkage().forms[0].spins == ((0, 1, -1),)
    assert len(hexapod().forms[0].spins) == 6 and len(delta().forms[0].spins) == 6
    assert spherical_linkage().forms[0].spins == ()


def test_a_door_on_two_balls_turns():
    """The turn about the line of two balls is of use where both are on the same body; so is that of an oblique slide."""
    hinges = [spherical(name, "frame", "door", point=(0, 0, z)) for name, z in (("low", 0.0), ("high", 9.0))]
    door = Mechanism.build(fixed=["frame"], joints=hinges)
    assert door.forms[0].spins == ()
    oblique = [
        revolute("in", "ground", "crank", point=(0, 0, 0), axis=(0, 0, 1)),
        spherical("a", "crank", "tube", point=(1, 0, 0)),
        prismatic("slide", "tube", "rod", axis=(1, 1, 0)),
        spherical("b", "rod", "rocker", point=(5, 0, 0)),
        revolute("out", "ground", "rocker", point=(5, 1, 0), axis=(0, 0, 1)),
    ]
    assert Mechanism.build(fixed=["ground"], joints=oblique).forms[0].spins == ()
