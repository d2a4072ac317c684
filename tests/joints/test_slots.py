"""Pins in slots, straight and circular, against closed forms: the same mechanisms drawn with slots."""

from functools import cache

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.joints.kinds import JointKind
from jaxkin.view.sticks import stick_parts
from reference import planar

Z = (0.0, 0.0, 1.0)
TURN = np.linspace(0.0, 2 * np.pi, 13)


def yoke_of(crank, slot=np.pi / 2):
    """A Scotch yoke: a pin on a crank in the slot of a slider."""
    return jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=Z),
            jk.pin_in_slot(
                "pin",
                "yoke",
                "crank",
                point=jnp.array([crank, 0, 0]),
                axis=Z,
                direction=(np.cos(slot), np.sin(slot), 0),
            ),
            jk.prismatic("rail", "ground", "yoke", axis=(1, 0, 0)),
        ],
    )


def quick_return(limits=None):
    """Whitworth's quick return: the pin of the crank in the slot of an arm."""
    return jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("crank", "ground", "wheel", point=(120, 0, 0), axis=Z),
            jk.pin_in_slot("pin", "arm", "wheel", point=(170, 0, 0), axis=Z, direction=(1, 0, 0), limits=limits),
            jk.revolute("D", "ground", "arm", point=(0, 0, 0), axis=Z),
        ],
        unit="mm",
    )


def round_slot(start=0.9):
    """A four-bar whose rocker is a circular slot in the ground."""
    found = planar.fourbar(np.array(start))
    pin, joint = (*found.rocker_pin, 3.0), (*found.crank_pin, 0.0)
    return jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=Z),
            jk.revolute("B", "crank", "coupler", point=joint, axis=Z),
            jk.pin_in_slot("pin", "ground", "coupler", point=pin, axis=Z, centre=(100, 0, 0)),
        ],
        unit="mm",
    )


@cache
def mechanisms():
    return {"yoke": yoke_of(30.0, 1.1), "quick return": quick_return({"z": (-110, 10)}), "round": round_slot()}


@pytest.mark.parametrize("slot", [np.pi / 2, 1.1])
def test_scotch_yoke(slot):
    motion = yoke_of(30.0, slot).sweep({"A": TURN}, throw=True)
    # 1e-12 of 30: rounding of a linear loop
    wanted = planar.scotch_yoke(TURN, 30.0, slot) - 30.0
    np.testing.assert_allclose(motion.coordinates["rail"][:, 0], wanted, atol=3e-11)
    np.testing.assert_allclose(motion.coordinates["pin"][:, 1], TURN, atol=1e-13)  # the yoke does not turn
    # the pin's height in the slot is r sin(theta) over the slot's slope
    np.testing.assert_allclose(motion.coordinates["pin"][:, 0], 30 * np.sin(TURN) / np.sin(slot), atol=3e-11)


@pytest.mark.long
def test_quick_return():
    mechanism = mechanisms()["quick return"]
    motion = mechanism.sweep({"crank": TURN}, throw=True)
    wanted = planar.quick_return(TURN)
    np.testing.assert_allclose(motion.coordinates["D"][:, 0], wanted.arm, atol=1e-13)
    np.testing.assert_allclose(motion.coordinates["pin"][:, 0], wanted.slide - 170.0, atol=1e-11)
    assert mechanism.joints["pin"].limits == ((-110.0, 10.0), (-np.inf, np.inf))
    found = mechanism.mobility()
    assert (found.freedoms, found.idle_freedoms) == (1, 0)


def test_a_circular_slot_is_a_link():
    theta = 0.9 + TURN
    motion = round_slot().sweep({"A": TURN}, throw=True)
    wanted = planar.fourbar(theta)
    around, turned = np.asarray(motion.coordinates["pin"]).T
    np.testing.assert_allclose(around, np.unwrap(wanted.rocker) - wanted.rocker[0], atol=1e-13)
    np.testing.assert_allclose(around + turned, np.unwrap(wanted.coupler) - wanted.coupler[0], atol=1e-13)


@pytest.mark.long
def test_derivative_with_respect_to_the_place_of_the_pin():
    def stroke(crank):
        motion = yoke_of(crank).sweep({"A": jnp.array([0.4])})
        return motion.coordinates["rail"][0, 0]

    # x = r (cos - 1)
    assert float(jax.jit(jax.grad(stroke))(30.0)) == pytest.approx(np.cos(0.4) - 1, abs=1e-13)


@pytest.mark.parametrize(
    "name", ["yoke", *(pytest.param(name, marks=pytest.mark.long) for name in ("quick return", "round"))]
)
def test_it_is_written_drawn_and_read_back(name, tmp_path):
    given = mechanisms()[name]
    drive = given.mobility().drivable[0]
    expected = given.sweep({drive: [0.0, 0.3]}, throw=True).transforms
    jk.write_study(given, tmp_path / "study.toml")
    given.save(tmp_path / "m.json")
    for back in (jk.load_study(tmp_path / "study.toml").mechanism, jk.load(tmp_path / "m.json").mechanism()):
        assert back.joints["pin"].kind is JointKind.PIN_IN_SLOT
        assert back.joints["pin"].limits == given.joints["pin"].limits
        np.testing.assert_allclose(back.joints["pin"].frames_1, given.joints["pin"].frames_1, atol=1e-12)
        found = back.sweep({drive: [0.0, 0.3]}, throw=True).transforms
        for part, wanted in expected.items():
            np.testing.assert_allclose(found[part], wanted, atol=1e-11)
    back = jk.load(jk.write_mjcf(given, tmp_path / "model.xml")).mechanism()
    assert back.mobility().freedoms == 1
    assert {part.name for part in stick_parts(given)} == set(given.parts)
    assert "pin in slot" in str(given) and "pin" in str(given.plan([drive]))


@pytest.mark.long
def test_the_same_from_another_pose():
    given = mechanisms()["quick return"]
    motion = given.sweep({"crank": [0.0, 0.7, 1.1]}, throw=True)
    again = given.at(motion, 1).sweep({"crank": [0.4]}, throw=True)
    np.testing.assert_allclose(
        again.coordinates["pin"][0], motion.coordinates["pin"][2] - motion.coordinates["pin"][1], atol=1e-11
    )


@pytest.mark.parametrize(
    "given, message",
    [
        ({}, "give one of them, got neither"),
        ({"direction": (1, 0, 0), "centre": (1, 0, 0)}, "give one of them, got both"),
        ({"direction": (1, 0, 1)}, "perpendicular to the axis of its pin, the cosine between them is 0.707"),
        ({"direction": (0, 0, 0)}, "direction must be a direction"),
        ({"direction": (1, 0)}, "direction must be three finite numbers"),
        ({"centre": (0, 0, 7)}, "must lie beside the axis of its pin.*use a revolute joint"),
        ({"centre": (1, 0)}, "centre must be three finite numbers"),
        ({"direction": (1, 0, 0), "limits": (0, 1)}, "has the coordinates z, phi: write limits="),
    ],
)
def test_refused(given, message):
    with pytest.raises(ValueError, match=message):
        jk.pin_in_slot("j", "a", "b", point=(0, 0, 0), axis=Z, **given)
