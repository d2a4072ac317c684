"""Poses that are equally spaced over a turn are nodes themselves: found, and judged as by nodes of their own."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.solve.closed_form.input_line import NODES, unknown_angles
from jaxkin.solve.closed_form.loop_angles import left_angles, measured_angles
from jaxkin.solve.closed_form.turn_grid import MAX_INTERVALS, turn_grid
from jaxkin.solve.status import Status
from reference import catalogue
from reference.mechanisms import planar_fourbar, slider_crank, spherical_linkage

TURN = 2 * np.pi
WITHIN = 1e-12
"""Of radians and lengths over the size: some thousand roundings."""
GRIDS = {
    "a turn": np.linspace(0.0, TURN, 200),
    "its end left out": np.linspace(0.0, TURN, 144, endpoint=False),
    "to either side": np.linspace(-np.pi, np.pi, 181),
    "backwards to the start": np.linspace(-TURN, 0.0, 161),
    "every second node": np.linspace(0.0, TURN, 101),
    "most of a turn": np.linspace(-0.5 * np.pi, np.pi, 151),
}


@pytest.mark.parametrize("name", GRIDS)
def test_inputs_are_found_among_the_nodes_of_a_turn(name):
    values = GRIDS[name]
    grid = turn_grid(values)
    assert grid is not None and NODES <= len(grid.nodes) <= len(values) + NODES
    assert grid.nodes[0] == 0.0 and np.isclose(grid.nodes[-1], TURN)
    np.testing.assert_allclose(np.diff(grid.nodes), TURN / (len(grid.nodes) - 1), atol=1e-14)
    np.testing.assert_allclose(grid.poses_of(grid.nodes), np.where(grid.rising, values, values + TURN), atol=1e-14)
    # what is reached by a rising input is the very number that was given, but that the first node is zero
    rising = values > 1e-9
    np.testing.assert_array_equal(grid.poses_of(grid.nodes)[rising], values[rising])
    np.testing.assert_array_equal(grid.rising, values > -1e-9)


@pytest.mark.parametrize(
    "values",
    [
        np.zeros(1),
        np.zeros(200),
        np.linspace(TURN, 0.0, 200),  # falling
        np.linspace(0.0, 2 * TURN, 400),  # two turns
        np.linspace(0.0, 1.0, 200),  # more nodes over the rest of the turn than it has poses
        np.linspace(0.01, TURN + 0.01, 200),  # none is the assembled pose
        np.linspace(0.0, TURN, 200) ** 2 / TURN,
        np.linspace(0.0, TURN, 200) + 1e-12 * np.sin(np.arange(200)),
        np.linspace(0.0, TURN, MAX_INTERVALS + 2),
        np.linspace(0.0, TURN, 40),  # three nodes out of four were no poses
    ],
)
def test_other_inputs_have_no_grid(values):
    assert turn_grid(values) is None


CASES = {
    "four-bar": (planar_fourbar, "A", "a turn"),
    "rocker as drive": (planar_fourbar, "D", "to either side"),
    "double rocker": (
        lambda: planar_fourbar(1.0, crank=90.0, coupler=60.0, rocker=80.0),
        "A",
        "backwards to the start",
    ),
    "slider-crank": (slider_crank, "A", "every second node"),
    "Jansen": (catalogue.jansen, "O", "its end left out"),
    "spherical four-bar": (spherical_linkage, "A", "most of a turn"),
}


@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_poses_of_a_grid_are_those_of_inputs_that_jax_traces(name):
    """Traced inputs are judged by nodes of their own: another route to the same statuses, displacements and slopes."""
    make, drive, label = CASES[name]
    mechanism, values = make(), GRIDS[label]
    key = next(key for key, value in mechanism.lengths.items() if len(key) == 3 and float(value) > 0)
    designs = float(mechanism.lengths[key]) * jnp.array([0.99, 1.01])
    along = jnp.cos(jnp.arange(len(values)))

    def swept(length, inputs):
        motion = mechanism.with_lengths({key: length}).sweep({drive: inputs})
        rows = jnp.concatenate(motion.displacements, axis=1)
        return jnp.sum(along @ jnp.where(motion.closed[:, None], rows, 0.0)), (rows, motion.status)

    with_slope = jax.value_and_grad(swept, has_aux=True)
    (_, (x, status)), slope = jax.jit(jax.vmap(lambda length: with_slope(length, values)))(designs)
    traced = jax.jit(jax.vmap(with_slope, (0, None)))
    (_, (wanted, wanted_status)), wanted_slope = traced(designs, jnp.asarray(values))
    # a pose next to a limit may be in doubt by the nodes of either
    sure = (status != Status.STALLED.value) & (wanted_status != Status.STALLED.value)
    assert np.mean(sure) > 0.97
    np.testing.assert_array_equal(status[sure], wanted_status[sure])
    closed = np.asarray(sure & (status == Status.CLOSED.value))
    np.testing.assert_allclose(x[closed], wanted[closed], atol=WITHIN * max(1.0, np.max(np.abs(wanted[closed]))))
    if np.all(closed):
        np.testing.assert_allclose(slope, wanted_slope, rtol=1e-9)


def test_the_last_angle_of_each_loop_is_left():
    (element,) = plan_drive(catalogue.jansen().linkage, ("O",)).loop_groups
    system = element.system
    left = left_angles(system)
    assert len(left) == 3 and len(unknown_angles(system)) == 9
    assert set(measured_angles(system)) == set(unknown_angles(system)) - {angle.column for angle in left}
    (element,) = plan_drive(slider_crank().linkage, ("A",)).loop_groups
    assert len(measured_angles(element.system)) == 1  # of two turns and a slide
    (element,) = plan_drive(spherical_linkage().linkage, ("A",)).loop_groups
    assert not left_angles(element.system)  # turns about axes through a point do not add up
