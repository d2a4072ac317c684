"""Axes that are parallel but for 1e-12 are exactly parallel in a mechanism."""

import numpy as np

from jaxkin.mechanism.mechanism import Mechanism
from reference.rounding import EVERY, placed, tilted


def test_axes_out_of_parallel_by_what_loops_hide_become_parallel():
    """The loops moved as they were, to rounding, and counted as planar, but their poses were open by 1.1e-12."""
    exact = EVERY["Fig. 3"]()
    for seed in range(3):
        rng = np.random.default_rng(seed)
        joints = tilted(placed(exact.all_joints, rng), 1e-12, rng)
        mechanism = Mechanism.build(fixed=list(exact.fixed), joints=joints)
        for group in mechanism.structure.uncoupled_groups:
            axes = np.array([mechanism.all_joints[number].frames_1[0, :3, 2] for number in group.joints])
            assert np.array_equal(axes, axes[0] * np.sign(axes @ axes[0])[:, None])
        given = Mechanism.build(fixed=list(exact.fixed), joints=joints, align=0)
        for one, other in zip(given.all_joints, joints, strict=True):
            assert np.array_equal(one.frames_1, other.frames_1), "0 moves nothing"
