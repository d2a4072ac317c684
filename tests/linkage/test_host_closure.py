"""The loops on the host: units of their columns, and places of parts."""

import numpy as np
import pytest

from jaxkin.geometry.pose import apply, frame
from jaxkin.joints.coupling import gear
from jaxkin.joints.joint import joint
from jaxkin.joints.kinds import JointKind
from jaxkin.joints.pairs import planar, revolute
from jaxkin.linkage.closed_loops import closed_loops
from jaxkin.linkage.host_closure import ClosedLoops
from jaxkin.linkage.linkage import Linkage
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.placed_at import part_places

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


COUPLED = {
    "A": ("frame", "crank", (0.0, 0.0, 0.0)),
    "B": ("crank", "rod", (1.0, 0.0, 0.0)),
    "C": ("rod", "rocker", (3.2, 2.9, 0.0)),
    "D": ("frame", "rocker", (4.0, 0.0, 0.0)),
    "arm": ("crank", "arm", (0.5, 0.5, 0.0)),
    "wheel": ("wheel", "arm", (0.5, 2.5, 0.0)),
    "E": ("wheel", "bar", (0.7, 3.5, 0.0)),
    "F": ("bar", "link", (1.7, 4.0, 0.0)),
    "G": ("link", "wheel", (1.5, 2.5, 0.0)),
}
"""A four-bar, a chain of two joints on its crank, and a loop at the end of that: one loop group by two gears."""


@pytest.mark.parametrize("seed", range(6))
def test_parts_are_where_the_joints_put_them_in_whichever_order_these_are_given(seed):
    """In no loop are those of the chain: one group of loops and couplings places parts on both sides of it."""
    names = [*np.random.default_rng(seed).permutation([*COUPLED])]
    joints = [revolute(name, *COUPLED[name][:2], point=COUPLED[name][2], axis=(0, 0, 1)) for name in names]
    gears = [gear("A", "arm", 2.0), gear("wheel", "arm", -1.5), gear("E", "arm", 0.7)]
    linkage = Mechanism.build(fixed=["frame"], joints=joints, couplings=gears).linkage
    loops, values = loops_of(linkage), {name: 0.1 * k - 0.3 for k, name in enumerate(COUPLED)}
    q = np.array([values[linkage.joints[joint].name] for joint, _ in loops.columns])
    travel = loops.travel(q)
    placed = part_places(linkage, [np.array([values[name]]) for name in names])
    for part, place in placed.items():
        turn, shift = place[:3, :3], place[:3, 3]
        found = travel.places[part]
        np.testing.assert_allclose(found[:3, :3], turn, atol=1e-14)
        np.testing.assert_allclose(loops.length * found[:3, 3], shift + turn @ loops.centre - loops.centre, atol=1e-14)
    for name in ("arm", "wheel"):
        column = next(k for k, (number, _) in enumerate(loops.columns) if names[number] == name)
        on = travel.places[COUPLED[name][0]]
        pin = (np.array(COUPLED[name][2]) - loops.centre) / loops.length
        expected = [0, 0, 1, *np.cross(apply(on, pin), [0, 0, 1])]
        np.testing.assert_allclose(travel.screws[:, column], expected, atol=1e-14)
