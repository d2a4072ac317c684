"""Numbers that JAX traces, given to what looks at them: an error that says what to do, and not one of JAX."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples import path
from reference.mechanisms import planar_fourbar

CRANK = ("crank", "A", "B")
INPUTS = np.linspace(0.0, 1.0, 3)


def given(mechanism: jk.Mechanism) -> jk.Masses:
    return jk.masses(mechanism, given={"crank": 0, "coupler": jk.Mass(1.0, centre=(60.0, 60.0, 0.0)), "rocker": 0})


@pytest.mark.long
def test_what_is_found_on_the_host_says_so_of_each_of_its_numbers():
    """Settings and loads, too, and not the mechanism and its drive alone."""
    mechanism = planar_fourbar()
    solid = jk.load(path("fourbar")).mechanism(fixed=["ground"])
    motion = solid.sweep({"ground-crank": INPUTS})
    place = {jk.point("coupler", (60.0, 60.0, 0.0)): [(60.0, 60.0, 0.0)]}
    stroke = jk.design.stroke_of
    calls = {
        "gravity": lambda x: jk.equilibrium(mechanism, {"A": INPUTS}, given(mechanism), gravity=(0.0, -x, 0.0)),
        "sigma": lambda x: jk.calibrate(mechanism, {"A": INPUTS}, {"D": INPUTS}, lengths=[CRANK], sigma=x),
        "one sigma": lambda x: jk.calibrate(mechanism, {"A": INPUTS}, {"D": INPUTS}, lengths=[CRANK], sigma={"D": x}),
        "within": lambda x: jk.clashes(motion, within=x),
        "overlap": lambda x: jk.clashes(motion, tolerance=x),
        "grid": lambda x: jk.swept_volume(motion, "rocker", resolution=x),
        "accuracy": lambda x: jk.work_precision(mechanism, {"A": x * INPUTS}),
        "mobility": lambda x: mechanism.with_lengths({CRANK: x}).mobility(),
        "rest": lambda x: jk.inverse(mechanism, place, rest={"A": x}),
        "weights": lambda x: jk.inverse(mechanism, place, weights={next(iter(place)): x}),
        "target": lambda x: jk.optimize(stroke("D", x), mechanism, drive={"A": INPUTS}, lengths={CRANK: (30, 50)}),
        "drive": lambda x: jk.optimize(stroke("D", 1.0), mechanism, drive={"A": x * INPUTS}, lengths={CRANK: (30, 50)}),
    }
    for name, call in calls.items():
        with pytest.raises(ValueError, match="jit, vmap and grad"):
            jax.eval_shape(call, 40.0)
            pytest.fail(f"{name} was taken")


@pytest.mark.long
def test_results_of_traced_numbers_say_so_where_they_are_looked_at(tmp_path):
    def look(length):
        mechanism = planar_fourbar().with_lengths({CRANK: length})
        motion, masses = mechanism.sweep({"A": INPUTS}), given(mechanism)
        rates = jk.velocities(motion, {"A": 1.0})
        stated = {CRANK: 0.1}
        spreads = jk.tolerances(mechanism, stated, lambda pose: pose.coordinates["D"][0], drive={"A": 0.3}, samples=0)
        friction = [jk.joint_friction("D", 0.1, radius=4.0)]
        rubbed = jk.drive_forces(motion, masses, applied=friction, rates={"A": 1.0})
        moving = jk.masses(
            mechanism, given={"crank": 0, "coupler": jk.Mass(length, centre=(60.0, 60.0, 0.0)), "rocker": 0}
        )
        for each in (rates, jk.screw_axes(rates, "coupler"), rubbed, rubbed.friction, jk.reactions(motion, masses)):
            assert "traced by JAX" in str(each)
        for each in (mechanism, jk.transmission(motion, "D"), spreads, moving):
            assert "traced by JAX" in str(each)
        for each in (rates, rubbed, jk.reactions(motion, masses), jk.transmission(motion, "D"), spreads):
            for write in (each.save, each.plot):
                with pytest.raises(ValueError, match="jit, vmap and grad"):
                    write(tmp_path / "file.csv")
        with pytest.raises(ValueError, match="jit, vmap and grad"):
            spreads.allowed(0.1)
        return length

    jax.eval_shape(look, 40.0)
    assert not list(tmp_path.iterdir())


@pytest.mark.long
def test_the_remedy_for_solve_is_that_of_solve_under_grad_too():
    """It was that of `beyond_limits`, which was not called: under `grad` the status is a number already."""

    def rocker(length, throw):
        pose = planar_fourbar().with_lengths({CRANK: length}).solve({"A": 0.3}, throw=throw)
        return pose.coordinates["D"][0]

    with pytest.raises(ValueError, match="throw=False"):
        jax.grad(rocker)(40.0, True)
    assert jnp.isfinite(jax.grad(rocker)(40.0, False))
