"""The main job end to end: the shipped STEP assemblies against their closed forms, on 3600 poses a turn.

From STEP, angles and lengths are held to 5e-7 of the size (placements pass through float32 in the reader) and closure
to 1e-12. Joints combined or one a contact: the same motion.
"""

import inspect

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples import EXAMPLES, path
from jaxkin.linkage.linkage import Linkage
from reference import planar

TURN = np.linspace(0.0, 2 * np.pi, 3600)
HINGES = {"fourbar": "ground-crank", "slider_crank": "ground-crank", "cam": "cam-frame"}


def expected(name, turn):
    """The joint to look at and its displacement by the closed form, for the crank turned about z of the drawing."""
    size = EXAMPLES[name].dimensions
    angles = size["angle"] + turn
    if name == "fourbar":
        rocker = np.unwrap(
            planar.fourbar(angles, size["ground"], size["crank"], size["coupler"], size["rocker"]).rocker
        )
        return "ground-rocker", rocker - rocker[0]
    if name == "slider_crank":
        slider = planar.slider_crank(angles, size["crank"], size["rod"], size["offset"]).slider
        return "ground-slider", slider - slider[0]
    lift = size["eccentricity"] * (np.sin(angles) - np.sin(size["angle"]))
    return "follower-frame", -lift  # displacement of the second part, the frame, relative to the follower


def axis_sign(mechanism, joint, direction):
    """+1 where the joint's axis points along a direction of the drawing, -1 against it: files have it either way."""
    return np.sign(float(np.asarray(mechanism.joints[joint].frames_1)[0][:3, 2] @ direction))


LONG = pytest.mark.long


@pytest.mark.long
@pytest.mark.parametrize("name", ["fourbar", *(pytest.param(name, marks=LONG) for name in ("slider_crank", "cam"))])
def test_closed_form_and_both_ways_of_taking_contacts(name):
    example = EXAMPLES[name]
    assembly = jk.load(path(name))
    mechanism = assembly.mechanism(fixed=example.fixed)
    hinge = mechanism.joints_between(*example.drive)[0]
    assert hinge == HINGES[name]
    assert mechanism.mobility().freedoms == 1
    # the crank turns about z of the drawing relative to the fixed part; the joint's own sign may be the other one
    z, x, y = (example.placement[:3, :3] @ axis for axis in np.eye(3)[[2, 0, 1]])
    swapped = mechanism.joints[hinge].parts[0] not in example.fixed
    sign = axis_sign(mechanism, hinge, z) * (-1 if swapped else 1)
    motion = mechanism.sweep({hinge: sign * TURN})
    assert np.all(motion.closed)
    assert np.max(motion.residual) < 1e-12

    joint, displacement = expected(name, TURN)
    along = {"fourbar": z, "slider_crank": x, "cam": y}[name]
    found = axis_sign(mechanism, joint, along) * np.asarray(motion.coordinates[joint][:, 0])
    size = 100.0 if mechanism.joints[joint].kind == "prismatic" else 1.0
    np.testing.assert_allclose(found, displacement, atol=5e-7 * size)

    apart = assembly.mechanism(fixed=example.fixed, combine=False)
    assert len(apart.all_joints) == len([c for c in assembly.contacts() if set(c.parts) - set(example.fixed)])
    other = apart.sweep({f"{hinge}:e.phi": sign * TURN})
    assert np.all(other.closed)
    assert np.max(other.residual) < 1e-12
    for part in mechanism.parts:
        difference = np.asarray(motion.transforms[part]) - np.asarray(other.transforms[part])
        np.testing.assert_allclose(difference, 0.0, atol=1e-10 * 100)  # mm; both ways start from the same frames


@pytest.mark.long
@pytest.mark.parametrize("prefix, unit", [("$", "m"), (".MICRO.", "um")])
def test_the_same_file_in_other_units_gives_the_same_angles(tmp_path, prefix, unit):
    """The numbers of the file taken as metres or micrometres: a mechanism a thousand times larger or smaller."""
    text = path("fourbar").read_text(encoding="latin-1")
    assert "SI_UNIT(.MILLI.,.METRE.)" in text
    file = tmp_path / "fourbar.step"
    file.write_text(text.replace("SI_UNIT(.MILLI.,.METRE.)", f"SI_UNIT({prefix},.METRE.)"), encoding="latin-1")
    turn = TURN[::10]
    assembly = jk.load(file)
    assert assembly.unit == unit
    scaled = assembly.mechanism(fixed=["ground"]).sweep({"ground-crank": turn})
    original = jk.load(path("fourbar")).mechanism(fixed=["ground"]).sweep({"ground-crank": turn})
    assert np.all(scaled.closed)
    assert np.max(scaled.residual) < 1e-12
    for joint, angles in original.coordinates.items():
        np.testing.assert_allclose(scaled.coordinates[joint], angles, atol=5e-7)


@pytest.mark.long
def test_a_gradient_through_the_whole_path():
    """How the swing of the rocker changes with the place of a pin that was read from the file."""
    mechanism = jk.load(path("fourbar")).mechanism(fixed=["ground"])
    angles = jnp.linspace(0.0, 2 * jnp.pi, 64)

    def swing(shift):
        """The pin's place in the coupler shifted in its plane; across it the loop could not close any more."""
        joints = list(mechanism.all_joints)
        index = [joint.name for joint in joints].index("crank-coupler")
        pin = joints[index]
        after = jnp.asarray(pin.frames_2)
        after = after.at[0, :3, 3].add(after[0, :3, :2] @ shift)
        joints[index] = jk.Joint(pin.name, pin.parts, pin.kind, pin.movements, pin.frames_1, after, pin.pitch)
        moved = jk.Mechanism(Linkage.of(joints, mechanism.structure))
        rocker = moved.sweep({"ground-crank": angles}).coordinates["ground-rocker"][:, 0]
        return jnp.max(rocker) - jnp.min(rocker)

    slope = jax.grad(swing)(jnp.zeros(2))
    step = 1e-4  # mm: central differences are good to about step^2 and 1e-16 / step
    numeric = [(swing(step * e) - swing(-step * e)) / (2 * step) for e in jnp.eye(2)]
    np.testing.assert_allclose(slope, numeric, atol=1e-8)


def test_importing_changes_no_global_setting_and_public_names_are_few():
    public = [name for name in dir(jk) if not name.startswith("_") and not inspect.ismodule(getattr(jk, name))]
    # what users write, and what public calls return: twenty joints, what curves and surfaces are made of, seven
    # couplings, five targets, some twenty effects
    assert len(public) <= 157
