"""`sigma_min`: zero at singular poses, the same in every unit, and what accuracy it leaves."""

import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference import planar
from reference.catalogue import parallelogram
from reference.mechanisms import bennett_linkage, planar_fourbar, rssr_linkage, slider_crank
from reference.overconstrained import shaft_in_contacts


@pytest.mark.long
def test_zero_at_change_points_only():
    motion = parallelogram().sweep({"A": np.array([-1.0, -0.5, 0.0, np.pi - 1.0, np.pi - 0.5])})
    assert np.all(motion.closed)  # assembled at 1 rad: flat at -1 and at pi - 1
    found = np.asarray(motion.sigma_min)
    assert np.all(found[[0, 3]] < 1e-7) and np.all(found[[1, 2, 4]] > 0.05)


@pytest.mark.long
@pytest.mark.parametrize("angle", [0.3, 1.0, np.pi / 2])
def test_a_range_that_ends_at_a_change_point_stays_on_its_branch(angle):
    """The other branch is 0.01 away beside it; rounding of 1e-15 moves a pose by its root."""
    inputs = np.linspace(0.0, np.pi - angle, 101)
    motion = parallelogram(angle=angle).sweep({"A": inputs})
    assert np.all(motion.closed)
    np.testing.assert_allclose(motion.coordinates["B"][:, 0], inputs, atol=1e-7)


@pytest.mark.long
def test_what_is_not_determined_at_a_change_point_is_told():
    """Beside it the cranks turn alike: velocities are 1, accelerations 0."""
    mechanism = parallelogram()
    own = jk.masses(mechanism, given={"crank A": jk.Mass(2.0, (40.0, 0.0, 0.0)), "crank B": 0, "coupler": 0})
    for beside, told in ((0.0, True), (1e-3, False)):
        inputs = np.linspace(0.0, np.pi - 1.0, 31) - beside
        motion = mechanism.sweep({"A": inputs})
        rates = jk.velocities(motion, {"A": 1.0})
        found = rates, jk.accelerations(motion, {"A": 1.0}), jk.drive_forces(motion, own), jk.reactions(motion, own)
        for each in found:
            line = next((line for line in str(each).splitlines() if "sigma_min" in line), "")
            assert ("at 1 pose (30), singular" in line) == told, each
        assert np.isfinite(np.asarray(rates.coordinates["B"])).all()
        error = np.abs(np.asarray(rates.coordinates["B"])[:, 0] - 1.0)
        assert (error[-1] > 0.1) == told  # what is told is so: rates of least norm are not those of the branch
        assert np.all(error[:-1] < 1e-6)  # eps over the square of 1e-3 and less


@pytest.mark.long
def test_it_falls_with_the_root_of_the_distance_to_a_limit():
    """At a limit of the input two branches meet: the pose moves with the root of the distance, so the slope is its
    inverse."""
    mechanism = planar_fourbar(1.0, crank=95.0, coupler=60.0)
    reach = np.arccos((100.0**2 + 95.0**2 - (60.0 + 80.0) ** 2) / (2 * 100.0 * 95.0))
    distance = np.array([1e-4, 1e-6, 1e-8])
    motion = mechanism.sweep({"A": reach - 1.0 - distance})
    assert np.all(motion.closed)
    found = np.asarray(motion.sigma_min)
    np.testing.assert_allclose(found[:-1] / found[1:], 10.0, rtol=2e-2)  # to first order in the root of 1e-4
    exact = planar.fourbar(1.0 + np.asarray(motion.inputs["A.phi"]), crank=95.0, coupler=60.0).rocker
    start = planar.fourbar(np.array([1.0]), crank=95.0, coupler=60.0).rocker
    error = np.abs(np.asarray(motion.coordinates["D"][:, 0]) - (exact - start))
    assert np.all(error < 100 * np.finfo(float).eps / found)  # the law; both forms lose as many digits


@pytest.mark.long
@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_it_depends_on_no_unit(scale):
    turn = np.linspace(0.0, 6.0, 20)
    one = slider_crank(1.0).sweep({"A": turn}).sigma_min
    other = slider_crank(1.0, 40.0 * scale, 120.0 * scale, -20.0 * scale).sweep({"A": turn}).sigma_min
    np.testing.assert_allclose(one, other, rtol=1e-12)


@pytest.mark.long
@pytest.mark.parametrize(
    "mechanism",
    [bennett_linkage(), rssr_linkage(), shaft_in_contacts(3)],
    ids=["overconstrained", "idle", "slides that leave the plane"],
)
def test_redundant_equations_and_idle_freedoms_are_not_singular(mechanism):
    first = mechanism.all_joints[0]
    drive = f"{first.name}.{first.coordinates[-1]}"
    found = np.asarray(mechanism.sweep({drive: np.linspace(0.0, 1.0, 10)}).sigma_min)
    assert np.all(found > 0.01) and np.all(found < 10)


def test_nothing_to_solve():
    from jaxkin.joints.pairs import revolute
    from jaxkin.mechanism.mechanism import Mechanism

    arm = Mechanism.build(fixed=["base"], joints=[revolute("A", "base", "arm", point=(0, 0, 0), axis=(0, 0, 1))])
    assert np.all(jnp.isinf(arm.sweep({"A": [0.0, 1.0]}).sigma_min))
