"""The two frames of a joint in the exports of CAD systems: what it leaves free between them, and what it holds."""

import numpy as np
import pytest

from jaxkin.geometry.pose import rotation
from reference.exported import FRAME, X, Y, Z, instance, load

TURN = rotation(np.array([1.0, -2.0, 3.0]) / np.sqrt(14.0), 1.1)
"""Of the frames in the world, so that none of their numbers is exact."""
AWAY = {each: (np.eye(3), 0.01 * np.array(axis, float)) for each, axis in (("x", X), ("y", Y), ("z", Z))}
TURNED = {
    f"about {each}": (rotation(np.array(axis, float), 0.1), np.zeros(3))
    for each, axis in (("x", X), ("y", Y), ("z", Z))
}
FREE = {
    "Weld": "", "Revolute": "about z", "Prismatic": "z", "Cylindrical": "z, about z", "Planar": "x, y, about z",
    "Spherical": "about x, about y, about z", "Universal": "about x, about y", "PinSlot": "x, about z",
    "Bearing": "z, about x, about y, about z", "Telescoping": "z, about x, about y, about z",
    "SixDof": "x, y, z, about x, about y, about z",
    "Rectangular": "x, y", "Cartesian": "x, y, z", "Parallel": "x, y, z, about z",
}  # fmt: skip
"""Kind of joint -> displacements of its follower that it allows."""


def placed(at, turn):
    numbers = " ".join(f"{number:.17g}" for number in turn.ravel())
    return FRAME.replace("1 0 0 0 1 0 0 0 1", numbers).format(*(f"{number:.17g}" for number in at))


def displaced(kind, turn, shift):
    """A joint whose follower is displaced from its base; both parts are in the world's frame."""
    point = np.array([0.1, 0.2, -0.3])
    frames = (("BaseFrame", "base", point, TURN), ("FollowerFrame", "arm", point + TURN @ shift, TURN @ turn))
    sides = "".join(
        f"<{tag}><InstancePath><Uid>{uid}</Uid></InstancePath>{placed(at, axes)}</{tag}>"
        for tag, uid, at, axes in frames
    )
    return f'<{kind} name="j">{sides}</{kind}>'


def mechanism_of(folder, joint):
    return load(folder, instance("base", grounded="true") + instance("arm"), joint).mechanism()


@pytest.mark.parametrize("kind", FREE)
@pytest.mark.parametrize("displacement", [*AWAY, *TURNED])
def test_what_a_joint_holds_between_its_frames_is_told_where_it_differs_and_nothing_else(tmp_path, kind, displacement):
    if (kind, displacement) == ("Universal", "about z"):
        return  # its two axes are not perpendicular then, and it is left out
    allowed = FREE[kind].split(", ")
    mechanism = mechanism_of(tmp_path, displaced(kind, *{**AWAY, **TURNED}[displacement]))
    told = [note for note in mechanism.notes if "apart as exported" in note]
    if displacement in allowed:
        assert not told
    else:
        size = "0.01 and" if displacement in AWAY else "0.1 rad"
        assert len(told) == 1 and size in told[0]
    assert mechanism.mobility().freedoms == (len(allowed) if allowed != [""] else 0)


@pytest.mark.parametrize(("kind", "held"), [("Bearing", (0, 1)), ("Telescoping", (0, 1)), ("PinSlot", (1, 2))])
def test_followers_stay_on_the_line_along_which_they_slide(tmp_path, kind, held):
    """A bearing had a fifth freedom where its numbers were not exact: its centre was a rounding beside the axis."""
    mechanism = mechanism_of(tmp_path, displaced(kind, np.eye(3), (0, 0, 0.02) if kind != "PinSlot" else (0.02, 0, 0)))
    (joint,) = mechanism.all_joints
    drive = {name: np.array([0.0, 0.3 * (k + 1)]) for k, name in enumerate(joint.full_names)}
    arm = np.asarray(mechanism.sweep(drive).transforms["arm"])[1]
    base = np.eye(4)
    base[:3, :3], base[:3, 3] = TURN, (0.1, 0.2, -0.3)
    follower = arm @ base
    follower[:3, 3] += arm[:3, :3] @ TURN @ ((0.02, 0, 0) if kind == "PinSlot" else (0, 0, 0.02))
    first, second = (follower, base) if kind == "Telescoping" else (base, follower)
    np.testing.assert_allclose((np.linalg.inv(first) @ second)[list(held), 3], 0.0, atol=1e-14)
