"""Ranges by formulas: what they prove is reachable and right, and all else is left to the general program."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.solve.closed_form.assembled_axes import assembled_axes
from jaxkin.solve.closed_form.range_by_formula import find_poses_by_formula
from jaxkin.solve.range.solve_range import displacements
from jaxkin.solve.status import ClosureTolerance, Status
from jaxkin.solve.system.joints import Joints
from reference.random_linkages import LINKAGES
from reference.random_sweeps import checked

TOLERANCE = ClosureTolerance(np.asarray(1e-12), np.asarray(16 * np.finfo(float).eps))


def program_of(linkage):
    """The formulas of many designs as a program for `checked`; ranges that are not proven are STALLED."""
    template = linkage.build(*(each[0] for each in linkage.draw(np.random.default_rng(0), 1, linkage.stages)))
    (element,) = plan_drive(template.linkage, ("A",)).elements
    names = [name for name, *_ in linkage.joints]
    places = [names.index(template.linkage.joints[joint].name) for joint in element.loop_group.joints]

    @jax.jit
    @jax.vmap
    def solved(joints, axes, inputs):
        found = find_poses_by_formula(element.system, axes, inputs, TOLERANCE)
        return displacements(element.system, joints, inputs, found.poses), found

    def program(frames, inputs):
        frames = np.asarray(frames)
        designs = [
            Joints(*[tuple(each[place][None] for place in places)] * 2, tuple(0.0 for _ in places)) for each in frames
        ]
        axes = [assembled_axes(element.system, joints) for joints in designs]
        stack = lambda many: jax.tree.map(lambda *leaves: jnp.stack(leaves), *many)  # noqa: E731
        x, (poses, proven) = solved(stack(designs), stack(axes), jnp.asarray(inputs)[:, None])
        rows = {name: [] for name in names}
        for row, (joint, _) in enumerate(element.columns):
            rows[template.linkage.joints[joint].name].append(row)
        status = jnp.where(proven[:, None], poses.status, Status.STALLED.value)
        return [jnp.moveaxis(x[:, np.array(rows[name])], 1, 2) for name in names], status, poses.residual_norm

    return program


@pytest.mark.long
@pytest.mark.parametrize("linkage", LINKAGES, ids=lambda linkage: linkage.name)
def test_what_is_proven_can_be_reached_and_is_right(linkage):
    count = checked(linkage, program_of(linkage), np.random.default_rng(1), 40)
    assert count.residual == count.branch == count.behind == 0
    assert count.closed
    assert count.error < 1e-12
