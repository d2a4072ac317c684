"""Blocks of loops: a partition in which no block holds an unknown of a later one."""

from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.solve.closure.closure import closure, loop_geometry
from jaxkin.solve.system.equation_blocks import equation_blocks
from jaxkin.solve.system.state import State
from reference.catalogue import hexapod, jansen, parallelogram, sarrus, watt
from reference.mechanisms import cam, planar_fourbar, rssr_linkage, spherical_linkage
from reference.overconstrained import wrist

CASES = {
    planar_fourbar: ("A", [3]),
    watt: ("A", [3, 3]),
    jansen: ("O", [3, 3, 3]),
    rssr_linkage: ("A", [1]),
    cam: ("shaft", [3]),
    spherical_linkage: ("A", [3]),
    sarrus: ("x0", [6]),
    hexapod: ("leg 0", [5]),
}


def system_and_joints(mechanism, drive):
    """The loop system of a drive of one joint, and the frames of its joints."""
    (element,) = plan_drive(mechanism.linkage, (drive,)).loop_groups
    return element.system, element.joints


@pytest.mark.long
@pytest.mark.parametrize("make", CASES, ids=lambda make: make.__name__)
def test_no_block_holds_an_unknown_of_a_later_one(make):
    """Told by the Jacobian itself, anywhere."""
    drive, sizes = CASES[make]
    system, joints = system_and_joints(make(), drive)
    found = equation_blocks(system)
    assert [len(block.rows) for block in found] == sizes
    assert sorted(row for block in found for row in block.rows) == list(range(system.equations))
    assert sorted(column for block in found for column in block.columns) == sorted(system.used)
    x = np.random.default_rng(0).uniform(-0.5, 0.5, (system.columns, 4))
    turns = jnp.broadcast_to(jnp.array([1.0, 0.0, 0.0, 0.0])[:, None], (len(system.turned_balls), 4, 4))

    @jax.jit
    def jacobian_of(joints, state):
        return closure(system, loop_geometry(system, joints)[0], state).jacobian

    jacobian = np.asarray(jacobian_of(joints, State(jnp.asarray(x), turns)))
    for number, block in enumerate(found):
        later = [column for other in found[number + 1 :] for column in other.columns]
        np.testing.assert_array_equal(jacobian[np.ix_(block.rows, later)], 0.0)


def test_a_redundant_loop_follows_the_loop_that_it_repeats():
    """The third crank of a parallelogram brings two unknowns in three equations."""
    system, _ = system_and_joints(parallelogram(bars=3), "A")
    assert [(len(block.rows), len(block.columns)) for block in equation_blocks(system)] == [(3, 3), (3, 2)]


def test_where_all_is_driven_there_is_nothing_to_solve():
    """A wrist: three driven hinges, and a ball at which the loop is cut."""
    mechanism = wrist()
    hinges = [f"{joint.name}.phi" for joint in mechanism.all_joints if joint.freedoms == 1]
    (element,) = plan_drive(mechanism.linkage, tuple(hinges)).loop_groups
    assert equation_blocks(element.system) == ()


def test_without_an_order_all_loops_are_one_block():
    system, _ = system_and_joints(jansen(), "O")
    assert [len(block.rows) for block in equation_blocks(replace(system, order=()))] == [9]
