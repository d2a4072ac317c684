"""Forces of mechanisms of several loop groups against those of each by itself; to rounding of the largest force."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.effects.forces.changes import _independent
from jaxkin.mechanism.known_motion import known_motion

Z = (0, 0, 1)
TURN = np.linspace(0, 2.0, 7)
GRAVITY = (0, -9.81, 0)
MASS = jk.Mass(2.0, centre=(30.0, 10.0, 5.0), inertia=np.diag([1e-3, 2e-3, 3e-3]))


def _fourbar(name: str, at: float, coupler: float) -> list:
    """A four-bar with links of 20, 60 and `coupler`, its parts and joints named after it."""
    ground, end = np.array([at, 0, 0]), np.array([at + 70.0, 0, 0])
    pin = ground + [0, 20, 0]
    apart = np.linalg.norm(end - pin)
    along = (end - pin) / apart
    x = (apart**2 + coupler**2 - 60.0**2) / (2 * apart)
    knee = pin + x * along + np.sqrt(coupler**2 - x**2) * np.array([-along[1], along[0], 0])
    crank, rod, rocker = (f"{name} {link}" for link in ("crank", "rod", "rocker"))
    return [
        jk.revolute(f"{name} A", "ground", crank, point=ground, axis=Z),
        jk.revolute(f"{name} B", crank, rod, point=pin, axis=Z),
        jk.revolute(f"{name} C", rod, rocker, point=knee, axis=Z),
        jk.revolute(f"{name} D", "ground", rocker, point=end, axis=Z),
    ]


ARM = [jk.revolute("arm", "ground", "arm", point=(-50, 0, 0), axis=(0, 1, 0))]
EACH = [(_fourbar("one", 0.0, 55.0), "one A"), (_fourbar("other", 200.0, 65.0), "other A"), (ARM, "arm")]


def _moved(joints: list, rates: dict[str, float]):
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=joints, unit="mm")
    masses = jk.masses(mechanism, given={part: MASS for part in mechanism.parts if part != "ground"})
    motion = mechanism.sweep({name: rate * TURN for name, rate in rates.items()})
    assert motion.closed.all()
    return motion, masses, rates


def _forces(motion, masses, rates):
    given = dict(gravity=GRAVITY, rates=rates)
    load = [jk.force(part, (30, 0, 0), (3.0, 4.0, 5.0)) for part in masses.parts if part != "ground"]
    return (
        jk.drive_forces(motion, masses, gravity=GRAVITY, applied=load),
        jk.drive_forces(motion, masses, applied=load, **given),
        jk.reactions(motion, masses, gravity=GRAVITY, applied=load),
        jk.reactions(motion, masses, applied=load, **given),
    )


@pytest.mark.long
def test_loop_groups_do_not_change_each_others_forces():
    joints = [joint for own, _ in EACH for joint in own]
    every = _forces(*_moved(joints, {"one A": 3.0, "other A": 2.0, "arm": 1.0}))
    # the second four-bar by itself has the names of the first, so that the programs of the first serve
    alike = EACH[0], (_fourbar("one", 200.0, 65.0), "one A"), EACH[2]
    for (own, name), rate, group in zip(alike, (3.0, 2.0, 1.0), ("one", "other", "arm"), strict=True):
        for found, alone in zip(every, _forces(*_moved(own, {name: rate})), strict=True):
            if isinstance(alone, jk.DriveForces):
                (full,) = alone.forces
                named = full.replace("one", group)
                np.testing.assert_allclose(found.forces[named], alone.forces[full], rtol=0, atol=1e-11)
                continue
            # forces of 100 N; out of their plane the loops leave them open, so that they depend on the size of the
            # mechanism, over which torques count
            for joint in alone.forces:
                named, open_ones = joint.replace("one", group), name != "arm"
                forces, torques = (slice(0, 2), slice(2, 3)) if open_ones else (slice(0, 3),) * 2
                np.testing.assert_allclose(
                    found.forces[named][:, forces], alone.forces[joint][:, forces], rtol=0, atol=1e-10
                )
                np.testing.assert_allclose(
                    found.torques[named][:, torques], alone.torques[joint][:, torques], rtol=0, atol=1e-11
                )
            (full,) = alone.drives
            np.testing.assert_allclose(found.drives[full.replace("one", group)], alone.drives[full], rtol=0, atol=1e-11)


def test_equal_loop_groups_share_their_derivatives():
    """What is static of both is equal, so that JAX compiles the program of the first only."""
    joints = [*_fourbar("one", 0.0, 55.0), *_fourbar("other", 200.0, 65.0), *ARM]
    motion, *_ = _moved(joints, {"other A": 2.0, "one A": 3.0, "arm": 1.0})
    one, other, alone = _independent(*known_motion(motion))
    assert one.drive == other.drive and one.names == ("one A.phi",) and other.names == ("other A.phi",)
    assert alone.names == ("arm.phi",) and not alone.drive.loop_groups


@pytest.mark.long
def test_gradients_by_rates_of_several_loop_groups():
    """The drive force is quadratic in the rate of its own loops, so that central differences are exact."""
    motion, masses, _ = _moved([*EACH[0][0], *EACH[1][0]], {"one A": 3.0, "other A": 2.0})

    def work(rate):
        rates = {"one A": rate, "other A": 2.0}
        return jnp.sum(jk.drive_forces(motion, masses, gravity=GRAVITY, rates=rates).forces["one A.phi"])

    slope = (work(4.0) - work(2.0)) / 2
    np.testing.assert_allclose(jax.grad(work)(3.0), slope, rtol=1e-9)
    np.testing.assert_allclose(jax.jit(work)(3.0), work(3.0), rtol=1e-9)
