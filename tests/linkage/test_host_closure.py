"""The loops on the host: units of their columns."""

import numpy as np

from jaxkin.geometry.pose import frame
from jaxkin.joints.joint import joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.pairs import planar
from jaxkin.linkage.closed_loops import closed_loops
from jaxkin.linkage.host_closure import ClosedLoops
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.mechanism import Mechanism

X, Y = frame(np.array([40.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.0])), frame(np.zeros(3), np.array([0.0, 1.0, 0.0]))


def loops_of(linkage: Linkage) -> ClosedLoops:
    return closed_loops(linkage, linkage.structure.loop_groups[0])


def test_numbered_slides_are_lengths():
    """A cross slide of two translations in one chain has the coordinates z1 and z2, both lengths."""
    cross = joint("cross", ("table", "plate"), JointKind.PLANAR, ("T_z", "T_z"), [X, Y])
    plane = planar("plane", "table", "plate", point=(0, 30, 0), normal=(0, 0, 1))
    loops = loops_of(Mechanism.build(fixed=["table"], joints=[cross, plane]).linkage)
    assert cross.coordinates == ("z1", "z2") and loops.length > 1
    np.testing.assert_array_equal(loops.units, [loops.length] * 4 + [1.0])
