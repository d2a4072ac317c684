"""Blocks of loops: a partition in which no block holds an unknown of a later one."""

from dataclasses import replace
from itertools import permutations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.solve.closure.closure import closure, loop_geometry
from jaxkin.solve.system.equation_blocks import blocks
from jaxkin.solve.system.from_linkage import block_joints, block_system
from jaxkin.solve.system.state import State
from reference.catalogue import hexapod, jansen, parallelogram, sarrus, watt
from reference.mechanisms import cam, planar_fourbar, rssr_linkage, spherical_linkage
from reference.overconstrained import wrist

CASES = {
    planar_fourbar: [3],
    watt: [3, 3],
    jansen: [3, 3, 3],
    rssr_linkage: [1],
    cam: [6],
    spherical_linkage: [6],
    sarrus: [6],
    hexapod: [5],
}


def system_and_joints(mechanism):
    (block,), (form,) = mechanism.structure.blocks, mechanism.linkage.classes
    system, _ = block_system(mechanism.linkage, block, ((block.joints[0], 0),), form)
    return system, block_joints(mechanism.all_joints, block)


@pytest.mark.parametrize("make", CASES, ids=lambda make: make.__name__)
def test_no_block_holds_an_unknown_of_a_later_one(make):
    """Told by the Jacobian itself, anywhere."""
    system, joints = system_and_joints(make())
    found = blocks(system)
    assert [len(block.rows) for block in found] == CASES[make]
    assert sorted(row for block in found for row in block.rows) == list(range(system.equations))
    assert sorted(column for block in found for column in block.columns) == sorted(system.used)
    x = np.random.default_rng(0).uniform(-0.5, 0.5, (system.columns, 4))
    turns = jnp.broadcast_to(jnp.array([1.0, 0.0, 0.0, 0.0])[:, None], (len(system.turned_balls), 4, 4))

    @jax.jit
    def jacobian_of(joints, state):
        return closure(system, loop_geometry(system, *joints)[0], state).jacobian

    jacobian = np.asarray(jacobian_of(joints, State(jnp.asarray(x), turns)))
    for number, block in enumerate(found):
        later = [column for other in found[number + 1 :] for column in other.columns]
        np.testing.assert_array_equal(jacobian[np.ix_(block.rows, later)], 0.0)


def test_blocks_do_not_depend_on_the_order_of_the_loops():
    system, _ = system_and_joints(jansen())
    expected = {frozenset(block.columns) for block in blocks(system)}
    for loops in permutations(system.loops):
        assert {frozenset(block.columns) for block in blocks(replace(system, loops=loops))} == expected


def test_where_all_is_driven_there_is_nothing_to_solve():
    """A wrist: three driven hinges, and a ball at which the loop is cut."""
    mechanism = wrist()
    (block,), (form,) = mechanism.structure.blocks, mechanism.linkage.classes
    hinges = [joint for joint in block.joints if mechanism.all_joints[joint].freedoms == 1]
    assert blocks(block_system(mechanism.linkage, block, tuple((joint, 0) for joint in hinges), form)[0]) == ()


def test_a_redundant_loop_is_solved_last():
    """The third crank of a parallelogram brings two unknowns in three equations."""
    system, _ = system_and_joints(parallelogram(bars=3))
    assert [(len(block.rows), len(block.columns)) for block in blocks(system)] == [(3, 3), (3, 2)]
