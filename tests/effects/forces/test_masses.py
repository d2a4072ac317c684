"""Masses against the formulas of boxes, in any place and unit. Tolerance: rounding of the divergence theorem, 1e-12."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest
import trimesh

import jaxkin as jk
from jaxkin.geometry.pose import rotation, unit
from reference.mechanisms import Z, planar_fourbar

TURN = np.eye(3)


def box(name="arm", size=(30.0, 20.0, 10.0), centre=(1000.0, -2000.0, 500.0), turn=TURN, flip=False) -> jk.Part:
    corners = np.asarray(trimesh.creation.box(size).triangles) @ turn.T + np.asarray(centre)
    return jk.Part(name, (), corners[:, ::-1] if flip else corners)


def pendulum(*solids, unit="mm") -> jk.Mechanism:
    hinge = jk.revolute("A", "base", "arm", point=(0, 0, 0), axis=Z)
    return replace(jk.Mechanism.build(fixed=["base"], joints=[hinge], unit=unit), solids=solids)


@pytest.mark.parametrize("flip", [False, True])
def test_a_box_has_the_mass_of_its_formula(flip):
    turn = rotation(unit(np.array([1.0, 2.0, -0.5])), 0.8)
    found = jk.masses(pendulum(box(turn=turn, flip=flip)), 7850)
    mass, sides = 7850 * 0.03 * 0.02 * 0.01, np.array([0.03, 0.02, 0.01])
    own = mass / 12 * np.diag(np.sum(sides**2) - sides**2)
    np.testing.assert_allclose(found.mass, [0.0, mass], rtol=1e-12)
    np.testing.assert_allclose(found.centre[1], [1000.0, -2000.0, 500.0], rtol=1e-12)
    np.testing.assert_allclose(found.inertia[1], turn @ own @ turn.T, atol=1e-12 * np.trace(own))
    assert "0.0471    kg at (1000, -2000, 500)" in str(found) and "base  none" in str(found)


def test_units_change_the_numbers_and_not_the_mass():
    large = jk.masses(pendulum(box(size=(0.03, 0.02, 0.01), centre=(1, -2, 0.5)), unit="m"), "steel")
    small = jk.masses(pendulum(box()), {"*": 1.0, "ar*": 2.0, "arm": "Steel"})
    np.testing.assert_allclose(large.mass, small.mass, rtol=1e-11)
    np.testing.assert_allclose(large.inertia, small.inertia, rtol=1e-10, atol=1e-20)
    np.testing.assert_allclose(1000 * large.centre, small.centre, rtol=1e-12)


def test_a_part_that_was_weighed_keeps_the_centre_and_the_shape_of_its_solid():
    mechanism = pendulum(box())
    weighed, dense = jk.masses(mechanism, given={"arm": 2.0}), jk.masses(mechanism, 1000)
    np.testing.assert_allclose(weighed.inertia / 2.0, dense.inertia / dense.total, rtol=1e-12)
    np.testing.assert_allclose(weighed.centre, dense.centre)
    moved = jk.masses(mechanism, given={"arm": jk.Mass(2.0, centre=(1, 2, 3), inertia=0.5)})
    np.testing.assert_allclose(moved.centre[1], [1, 2, 3])
    np.testing.assert_allclose(moved.inertia[1], 0.5 * np.eye(3))


def test_masses_by_jax():
    mechanism = pendulum(box())

    def inertia(density, mass):
        dense, weighed = jk.masses(mechanism, density), jk.masses(mechanism, given={"arm": jk.Mass(mass)})
        return jnp.trace(dense.inertia[1]) + jnp.trace(weighed.inertia[1])

    by_density, by_mass = jax.jit(jax.grad(inertia, (0, 1)))(1000.0, 2.0)
    expected = [
        jnp.trace(jk.masses(mechanism, 1.0).inertia[1]),
        jnp.trace(jk.masses(mechanism, given={"arm": 1}).inertia[1]),
    ]
    np.testing.assert_allclose([by_density, by_mass], expected, rtol=1e-12)


def test_what_is_missing_is_named():
    mechanism, solid = planar_fourbar(), pendulum(box())
    with pytest.raises(ValueError, match=r"no mass of 'coupler', 'rocker': .* given=\{'coupler': jk.Mass\(0.3, centre"):
        jk.masses(mechanism, given={"crank": 0})
    with pytest.raises(ValueError, match="the mass of 'crank' needs a centre"):
        jk.masses(mechanism, given={"crank": 1.0})
    with pytest.raises(ValueError, match="the inertia of 'crank' must be finite numbers of shape"):
        jk.masses(mechanism, given={"crank": jk.Mass(1.0, (0, 0, 0), [1, 2, 3])})
    with pytest.raises(ValueError, match="no inertia of a part"):
        jk.masses(mechanism, given={"crank": jk.Mass(1.0, (0, 0, 0), np.diag([1.0, 1.0, -1.0]))})
    with pytest.raises(ValueError, match="the mass of 'crank' must be one number of kilograms, got -1"):
        jk.masses(mechanism, given={"crank": -1})
    with pytest.raises(ValueError, match="no part 'crnk' to give a mass; did you mean 'crank'"):
        jk.masses(mechanism, given={"crnk": 1.0})
    with pytest.raises(ValueError, match=r"no density of 'arm': write jk.masses\(mechanism, 7850\)"):
        jk.masses(solid)
    with pytest.raises(ValueError, match=r"no material 'stel' among .*did you mean 'steel'"):
        jk.masses(solid, "stel")
    with pytest.raises(ValueError, match="a density must be one number"):
        jk.masses(solid, [1.0, 2.0])
    with pytest.raises(ValueError, match="density names 'leg', which no part matches"):
        jk.masses(solid, {"leg": 1.0})
    with pytest.raises(ValueError, match=r"masses are those of a mechanism, .*got Part"):
        jk.masses(box())


def test_open_solids_have_no_mass():
    opened = box()
    opened = replace(opened, triangles=opened.triangles[:-1])
    with pytest.raises(ValueError, match="the surface of 'arm' is not closed"):
        jk.masses(pendulum(opened), 1000)
    assert jk.masses(pendulum(opened), given={"arm": jk.Mass(1.0, (0, 0, 0), 0.0)}).total == 1.0


@pytest.mark.parametrize("mass", [None, 1 + 2j, {"mass": 1.0}, jk.Mass(1.0), -1.0])
def test_a_mass_that_is_no_number_is_told_with_its_part(mass):
    with pytest.raises(ValueError, match="the mass of 'arm' must be one number of kilograms, got"):
        jk.masses(pendulum(box()), given={"arm": jk.Mass(mass)})


def test_an_inertia_that_is_no_number_is_told_with_its_part():
    with pytest.raises(ValueError, match="the inertia of 'arm' must be one number, or a matrix"):
        jk.masses(pendulum(box()), given={"arm": jk.Mass(1.0, (0, 0, 0), "heavy")})


@pytest.mark.parametrize("turn", [TURN, rotation(unit(np.array([1.0, 2.0, -0.5])), 0.8)])
def test_an_inertia_whose_moments_no_body_has_is_refused_and_the_advice_moves_a_planar_part_alike(turn):
    """No moment is above the sum of the others; a plate with two digits, 0.33, 0.33 and 0.67, is within rounding."""
    mechanism = planar_fourbar()

    def masses(inertia):
        own = jk.Mass(1.0, (60.0, 50.0, 0.0), inertia)
        return jk.masses(mechanism, given={"crank": 0, "coupler": own, "rocker": 0})

    with pytest.raises(ValueError, match=r"sum of the other two, got 1, 1, 5; .* one number, inertia=5"):
        masses(turn @ np.diag([1.0, 1.0, 5.0]) @ turn.T)
    with pytest.raises(ValueError, match="one number, inertia=5"):
        masses(np.diag([0.0, 0.0, 5.0]))
    masses(turn @ np.diag([0.33, 0.33, 0.67]) @ turn.T)
    motion = mechanism.sweep({"A": np.linspace(0.0, 1.0, 3)})
    ball, body = (
        jk.drive_forces(motion, masses(each), rates={"A": 3.0}).forces["A.phi"] for each in (5.0, np.diag([4, 3, 5.0]))
    )
    np.testing.assert_allclose(ball, body, rtol=1e-9)


def test_masses_move_with_their_parts_to_another_assembled_pose():
    """The forces there are those of the pose from which it was assembled."""
    mechanism = planar_fourbar()
    own = jk.Mass(2.0, centre=(60.0, 50.0, 7.0), inertia=np.diag([1e-3, 2e-3, 2.5e-3]))
    masses = jk.masses(mechanism, given={"crank": own, "coupler": own, "rocker": 0})
    motion = mechanism.sweep({"A": np.linspace(0.0, 2.0, 5)})
    moved, there = mechanism.at(motion, 3), masses.at(motion, 3)
    asked = {"rates": {"A": 3.0}, "gravity": (0.0, -9.81, 0.0)}
    before = jk.drive_forces(motion, masses, **asked).forces["A.phi"][3]
    after = jk.drive_forces(moved.sweep({"A": [0.0]}), there, **asked).forces["A.phi"][0]
    assert abs(before) > 0.1
    np.testing.assert_allclose(after, before, rtol=1e-11)  # of a pose that is aligned anew
    with pytest.raises(ValueError, match="a mechanism with other parts than the masses have"):
        masses.at(pendulum().sweep({"A": [0.1]}), 0)


def test_masses_are_moved_to_closed_poses_that_are_there_only():
    """As mechanisms are: a pose behind the last one was taken for the last one, and one of NaN gave masses of NaN."""
    mechanism = planar_fourbar()
    masses = jk.masses(mechanism, given={part: jk.Mass(2.0, centre=(60.0, 50.0, 7.0)) for part in mechanism.parts})
    motion = mechanism.sweep({"A": np.array([0.0, 0.3, np.nan])})
    for index, said in (
        (3, "has 3 poses, numbered from 0, got 3"),
        (-4, "got -4"),
        (True, "got True"),
        (1.0, "got 1.0"),
        (2, "pose 2 is NONFINITE"),
    ):
        for each in (masses, mechanism):
            with pytest.raises(ValueError, match=said):
                each.at(motion, index)
    one = masses.at(mechanism.solve({"A": 0.3}))
    np.testing.assert_allclose(one.centre, masses.at(motion, -2).centre, atol=1e-9)  # one pose, to rounding of 100 mm
