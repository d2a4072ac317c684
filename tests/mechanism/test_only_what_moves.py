"""The program of a sweep holds what its mechanism and drive need: numbers that it computes, counted in its jaxpr.

The programs are traced, not compiled. The body of a scan counts as often as it runs, that of another loop once.
"""

from dataclasses import replace
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.joints.pairs import revolute
from jaxkin.linkage.loop_class import LoopClass
from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.solve.closure.closure import closure, loop_geometry
from jaxkin.solve.execution.known_numbers import _solve
from jaxkin.solve.options import SolverOptions
from jaxkin.solve.status import ClosureTolerance
from jaxkin.solve.system.state import assembled
from reference.mechanisms import planar_fourbar, rssr_linkage, spherical_linkage

RANGE = np.linspace(0.0, 1.0, 20)


def solved(mechanism, joint):
    """Arguments of each solve that a sweep over the range asks for, by the plan of its drive."""
    tolerance = ClosureTolerance(np.asarray(1e-12), np.asarray(0.0))
    elements = plan_drive(mechanism.linkage, (joint,)).loop_groups
    return [(element.system, SolverOptions(), element.joints, RANGE[None], tolerance) for element in elements]


def operations(function, *given) -> int:
    return computed(jax.make_jaxpr(function)(*given).jaxpr)


def computed(jaxpr) -> int:
    """How many numbers the equations of a jaxpr compute, those of the jaxprs inside in place of their own results."""
    total = 0
    for equation in jaxpr.eqns:
        values = [
            each for value in equation.params.values() for each in (value if isinstance(value, tuple) else [value])
        ]
        inside = [getattr(each, "jaxpr", each) for each in values if hasattr(each, "eqns")]
        times = equation.params["length"] if equation.primitive.name == "scan" else 1
        results = sum(int(np.prod(result.aval.shape)) for result in equation.outvars)
        total += times * sum(map(computed, inside)) if inside else results
    return total


def with_idle_loops(count: int) -> Mechanism:
    """The four-bar, and as many others beside it that nothing drives."""
    joints = list(planar_fourbar().all_joints)
    for number in range(count):
        for joint in planar_fourbar(crank=30.0).all_joints:
            parts = ["ground" if part == "ground" else f"{part} {number}" for part in joint.parts]
            joints.append(revolute(f"{joint.name} {number}", *parts, point=joint.frames_1[0][:3, 3], axis=(0, 0, 1)))
    return Mechanism.build(fixed=["ground"], joints=joints)


@pytest.mark.long
def test_loops_that_do_not_move_are_absent():
    alone = solved(planar_fourbar(), "A")
    among = solved(with_idle_loops(10), "A")
    assert len(alone) == len(among) == 1
    assert among[0][0] == alone[0][0]
    one, other = (
        operations(partial(_solve, system, options), *given) for ((system, options, *given),) in (alone, among)
    )
    assert one == other > 0


def closures(mechanism: Mechanism, joint: str, loop_class: LoopClass | None = None) -> int:
    """Operations of one evaluation of the closure, residual and Jacobian, for a hundred poses."""
    ((system, _, joints, *_),) = solved(mechanism, joint)
    system = system if loop_class is None else replace(system, loop_class=loop_class)
    geometry, _ = loop_geometry(system, joints)
    return operations(partial(closure, system), geometry, assembled(system, 100, jnp.zeros(0).dtype))


@pytest.mark.long
def test_equations_that_a_planar_loop_lacks_are_absent():
    """The same four-bar in its plane and in space."""
    assert closures(planar_fourbar(), "A") < 0.8 * closures(planar_fourbar(), "A", LoopClass())


@pytest.mark.long
def test_turns_of_balls_are_absent_where_there_is_none():
    """Four hinges about one point, and a linkage of as many joints of which two are balls, whole and cut at one."""
    hinges, cut, whole = (
        closures(mechanism, "A", loop_class)
        for mechanism, loop_class in (
            (spherical_linkage(), None),
            (rssr_linkage(), None),
            (rssr_linkage(), LoopClass()),
        )
    )
    assert hinges < 0.75 * whole and cut < 0.75 * whole


def test_what_is_not_read_is_not_computed():
    """A sweep returns displacements, status and residual; states, singular values and transforms are for who asks."""
    ((system, options, *given),) = solved(planar_fourbar(), "A")
    found = jax.eval_shape(lambda *given: _solve(system, options, *given), *given)
    assert sorted(leaf.shape[:-1] for leaf in jax.tree.leaves(found)) == [(), (), (4,)]
