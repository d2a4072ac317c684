"""Which legs of a hexapod idle: by what joins their halves, and by what holds them."""

from functools import partial

import numpy as np
import pytest

from jaxkin.joints.joint import Joint
from jaxkin.joints.pairs import cylindrical, prismatic, revolute, spherical, universal
from jaxkin.mechanism.mechanism import Mechanism
from reference import catalogue
from reference.mechanisms import Z


def with_legs(make) -> Mechanism:
    """The hexapod with other legs: `make(name, base, top)` gives the joints of one from "ground" to "platform"."""
    joints = {joint.name: joint for joint in catalogue.hexapod().all_joints}
    made = []
    for i in range(6):
        ends = [np.asarray(joints[f"{end} {i}"].frames_1)[0, :3, 3] for end in ("base", "top")]
        made += make(str(i), *ends)
    return Mechanism.build(fixed=["ground"], joints=made)


def cross_and_ball(name, base, top, sleeve=prismatic, other=spherical) -> list[Joint]:
    line = top - base
    across = np.cross(line, Z)
    tube, rod = f"tube {name}", f"rod {name}"
    cross = {"axis1": across, "axis2": np.cross(line, across)}
    return [
        universal(f"base {name}", "ground", tube, point=base, **cross),
        sleeve(f"leg {name}", tube, rod, point=base, axis=line),
        other(f"top {name}", rod, "platform", point=top, **(cross if other is universal else {})),
    ]


def with_knee(name, base, top) -> list[Joint]:
    knee, across = (base + top) / 2 + [40.0, 10.0, 0.0], np.cross(top - base, (1.0, 2.0, 3.0))
    return [
        spherical(f"base {name}", "ground", f"thigh {name}", point=base),
        revolute(f"leg {name}", f"thigh {name}", f"shin {name}", point=knee, axis=across),
        spherical(f"top {name}", f"shin {name}", "platform", point=top),
    ]


def turning_halves(name, base, top) -> list[Joint]:
    tube, rod = f"tube {name}", f"rod {name}"
    return [
        spherical(f"base {name}", "ground", tube, point=base),
        cylindrical(f"leg {name}", tube, rod, point=base, axis=top - base),
        spherical(f"top {name}", rod, "platform", point=top),
    ]


@pytest.mark.parametrize(
    ("make", "freedoms", "idle", "parts"),
    [
        (cross_and_ball, 6, 0, 0),
        (partial(cross_and_ball, sleeve=cylindrical, other=universal), 6, 0, 0),
        (partial(cross_and_ball, sleeve=cylindrical), 12, 6, 1),  # the rod turns in its tube
        (turning_halves, 18, 12, 1),
        (with_knee, 12, 0, 0),  # thigh and shin swing about the line of the balls, and the knee with them
    ],
    ids=["UPS", "UCU", "UCS", "SCS", "SRS"],
)
def test_legs_of_a_hexapod(make, freedoms, idle, parts):
    found = with_legs(make).mobility()
    assert (found.freedoms, found.idle_freedoms) == (freedoms, idle)
    assert all(len(motion.parts) == parts for motion in found.idle_motions)
    assert not {name for name in found.idle if name.startswith("leg") and name.endswith(".z")}
