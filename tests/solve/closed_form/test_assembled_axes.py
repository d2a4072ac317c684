"""Axes of the assembled pose: as far apart as the bars are long, and the same in NumPy and in JAX."""

from functools import partial

import jax
import numpy as np
import pytest

from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.solve.closed_form.assembled_axes import assembled_axes
from reference.mechanisms import planar_fourbar, slider_crank, spherical_linkage


def test_centres_of_a_fourbar_are_as_far_apart_as_its_bars_are_long():
    (group,) = plan_drive(planar_fourbar().linkage, ("A",)).loop_groups
    axes = group.axes
    centres = axes.centre[:, 0]
    bars = axes.length * np.linalg.norm(centres - np.roll(centres, 1, axis=0), axis=1)
    # rounding of sums of ten numbers of that size
    np.testing.assert_allclose(sorted(bars), [40.0, 80.0, 100.0, 120.0], rtol=1e-14)


@pytest.mark.parametrize("make", [planar_fourbar, slider_crank, spherical_linkage])
def test_axes_of_traced_joints_are_those_of_known_ones(make):
    (group,) = plan_drive(make().linkage, ("A",)).loop_groups
    for one, other in zip(
        jax.tree.leaves(group.axes),
        jax.tree.leaves(jax.jit(partial(assembled_axes, group.system))(group.joints)),
        strict=True,
    ):
        # a chain of some ten products of matrices
        np.testing.assert_allclose(other, one, atol=1e-14)
