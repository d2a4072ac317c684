"""Inverse dynamics of closed linkages against MuJoCo.

MuJoCo finds the torques of the tree that is left when one hinge is cut, by its own mass matrix and its own Coriolis
terms; what closes the loop does no work, so that the torque of the drive is what they do along the linkage's motion.
"""

import numpy as np
import pytest

import jaxkin as jk
from reference.energies import FOURBAR_MASSES, GRAVITY, fourbar
from reference.mechanisms import bennett_linkage

RATE, CHANGE = 3.0, -4.0


def hinge(mechanism, joint, mass, metre, inside="") -> str:
    """A body in axes parallel to the world, which turns about a joint; `inside` are bodies that hang on it."""
    frame = np.asarray(mechanism.joints[joint].frames_1[0], float)
    point, axis = metre * frame[:3, 3], frame[:3, 2]
    inertia = np.asarray(mass.inertia, float)
    inertia = inertia if inertia.ndim else inertia * np.eye(3)
    six = [inertia[i, j] for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]
    place = metre * np.asarray(mass.centre, float)
    return (
        f'<body><joint name="{joint}" type="hinge" pos="{_text(point)}" axis="{_text(axis)}"/>'
        f'<inertial pos="{_text(place)}" mass="{mass.mass}" fullinertia="{_text(six)}"/>{inside}</body>'
    )


def _text(numbers) -> str:
    return " ".join(f"{float(x):.17g}" for x in numbers)


def torque_of_tree(bodies: str, motion, rates, changes) -> np.ndarray:
    """Work along the driven coordinate of what MuJoCo's inverse dynamics asks of all hinges of the tree."""
    mujoco = pytest.importorskip("mujoco")
    options = f'<option gravity="{_text(GRAVITY)}"><flag contact="disable"/></option><compiler balanceinertia="false"/>'
    model = mujoco.MjModel.from_xml_string(f"<mujoco>{options}<worldbody>{bodies}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    names = [model.joint(number).name for number in range(model.njnt)]
    speed = float(next(iter(rates.inputs.values()))[0])
    found = []
    for pose in range(len(motion)):
        data.qpos[:] = [float(motion.coordinates[name][pose, 0]) for name in names]
        data.qvel[:] = [float(rates.coordinates[name][pose, 0]) for name in names]
        data.qacc[:] = [float(changes.coordinates[name][pose, 0]) for name in names]
        mujoco.mj_inverse(model, data)
        found.append(data.qfrc_inverse @ data.qvel / speed)
    return np.array(found)


@pytest.mark.long
def test_planar_fourbar_and_bennett_linkage():
    pytest.importorskip("mujoco")
    planar = fourbar()
    masses = FOURBAR_MASSES
    tree = hinge(planar, "A", masses["crank"], 1e-3, hinge(planar, "B", masses["coupler"], 1e-3))
    tree += hinge(planar, "D", masses["rocker"], 1e-3)
    _compare(planar, masses, tree)
    spatial = bennett_linkage()  # lengths without a unit: metres
    masses = {
        "first": jk.Mass(2.0, (30.0, 10.0, 5.0), np.diag([200.0, 300.0, 400.0])),
        "second": jk.Mass(
            1.0, (60.0, 40.0, 20.0), 100.0 * np.array([[2.0, 0.3, 0.1], [0.3, 3.0, -0.2], [0.1, -0.2, 4.0]])
        ),
        "third": jk.Mass(1.5, (20.0, 50.0, 10.0), np.diag([500.0, 300.0, 400.0])),
    }
    tree = hinge(spatial, "C", masses["third"], 1.0)
    tree = hinge(spatial, "A", masses["first"], 1.0, hinge(spatial, "B", masses["second"], 1.0, tree))
    _compare(spatial, masses, tree)


def _compare(mechanism, masses, tree) -> None:
    motion = mechanism.sweep({"A": np.linspace(0.1, 2.0, 12)})
    rates, changes = jk.velocities(motion, {"A": RATE}), jk.accelerations(motion, {"A": RATE}, {"A": CHANGE})
    own = jk.masses(mechanism, given=masses)
    found = jk.drive_forces(motion, own, gravity=GRAVITY, rates={"A": RATE}, accelerations={"A": CHANGE}).forces[
        "A.phi"
    ]
    expected = torque_of_tree(tree, motion, rates, changes)
    np.testing.assert_allclose(found, expected, rtol=1e-6)
    np.testing.assert_allclose(found, expected, atol=1e-9 * np.abs(expected).max())
