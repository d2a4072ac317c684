"""Mechanisms by hand at one assembled pose, most of them from the closed forms of `reference`. Lengths in mm.

Made for questions about structure and mobility, which cost no compilation; `reference.mechanisms` holds those that are
swept against closed forms.
"""

from collections.abc import Mapping

import numpy as np

from jaxkin.joints.joint import Joint
from jaxkin.joints.pairs import contact_joint, prismatic, revolute, spherical
from jaxkin.mechanism.mechanism import Mechanism
from reference import parallel, planar
from reference.mechanisms import Z, flat

GROUND = "ground"


def pinned(
    points: Mapping[str, object], bars: Mapping[str, str], extra: tuple[Joint, ...] = (), pin=revolute
) -> Mechanism:
    """Bars pinned at points: `bars["crank"] = "OA"` says which. A point of several bars is a hinge from the first to
    each other; bars of the ground come first."""
    joints = []
    for point, place in points.items():
        first, *others = [bar for bar, at in bars.items() if point in at]
        joints += [
            pin(f"{point}{i}" if len(others) > 1 else point, first, other, point=flat(place), axis=Z)
            for i, other in enumerate(others)
        ]
    return Mechanism.build(fixed=[GROUND], joints=[*joints, *extra])


def parallelogram(bars=2, angle=1.0, pin=revolute) -> Mechanism:
    """Cranks side by side under one coupler: each above two is redundant."""
    up = np.array([50 * np.cos(angle), 50 * np.sin(angle)])
    points = {f"{name}": np.array([40.0 * i, 0]) for i, name in enumerate("ABCDE"[:bars])}
    points |= {name.lower(): place + up for name, place in points.items()}
    cranks = {f"crank {name}": name + name.lower() for name in "ABCDE"[:bars]}
    return pinned(points, {GROUND: "ABCDE"[:bars], "coupler": "abcde"[:bars], **cranks}, pin=pin)


def antiparallelogram(theta=0.8) -> Mechanism:
    rocker = planar.polar(50.0, planar.antiparallelogram(np.array([theta]), 50.0, 120.0)) + [120.0, 0.0]
    points = {"A": (0, 0), "B": planar.polar(50.0, theta), "C": rocker[0], "D": (120, 0)}
    return pinned(points, {GROUND: "AD", "crank": "AB", "coupler": "BC", "rocker": "CD"})


def scotch_yoke(theta=0.7) -> Mechanism:
    pin = planar.polar(30.0, theta)
    return Mechanism.build(
        fixed=[GROUND],
        joints=[
            revolute("A", GROUND, "crank", point=(0, 0, 0), axis=Z),
            revolute("B", "crank", "block", point=flat(pin), axis=Z),
            prismatic("slot", "block", "yoke", axis=(0, 1, 0), point=flat(pin)),
            prismatic("guide", GROUND, "yoke", axis=(1, 0, 0)),
        ],
    )


def quick_return(theta=0.7) -> Mechanism:
    pin = np.array([50 * np.sin(theta), 120 + 50 * np.cos(theta)])
    return Mechanism.build(
        fixed=[GROUND],
        joints=[
            revolute("A", GROUND, "crank", point=(0, 120, 0), axis=Z),
            revolute("B", "crank", "block", point=flat(pin), axis=Z),
            prismatic("slot", "block", "arm", axis=flat(pin), point=flat(pin)),
            revolute("C", GROUND, "arm", point=(0, 0, 0), axis=Z),
        ],
    )


def watt(theta=0.9) -> Mechanism:
    """Two four-bars in series."""
    at = planar.watt_sixbar(np.array([theta]))
    second = np.array([100.0, 0.0])
    points = {"A": (0, 0), "B": at.first.crank_pin[0], "C": at.first.rocker_pin[0], "D": second}
    points |= {"E": second + at.second.crank_pin[0], "F": second + at.second.rocker_pin[0], "G": second + [90, 0]}
    bars = {"crank": "AB", "coupler": "BC", "rocker": "CDE", "second coupler": "EF", "output": "FG"}
    return pinned(points, {GROUND: "ADG", **bars})


def stephenson() -> Mechanism:
    """A four-bar whose coupler carries a dyad to the ground; driven at that end, nothing smaller than it all moves."""
    points = {"A": (0, 0), "B": (10, 30), "C": (70, 50), "D": (80, 0), "E": (40, 80), "F": (120, 90), "G": (140, 10)}
    bars = {"crank": "AB", "coupler": "BCE", "rocker": "CD", "link": "EF", "output": "FG"}
    return pinned(points, {GROUND: "ADG", **bars})


def jansen(theta=1.0) -> Mechanism:
    at = planar.jansen(np.array([theta]))
    points = dict(zip("ZWVUTS", (place[0] for place in at), strict=True))
    points = {"O": (0, 0), "Y": (-planar.JANSEN["a"], -planar.JANSEN["l"]), **points}
    points.pop("S")  # the foot is a corner of the shin, no joint
    bars = {
        "crank": "OZ",
        "upper rod": "ZW",
        "thigh": "YWV",
        "lower rod": "ZU",
        "rocker": "YU",
        "link": "VT",
        "shin": "UT",
    }
    return pinned(points, {GROUND: "OY", **bars})


def peaucellier(psi=0.3) -> Mechanism:
    at = planar.peaucellier(np.array([psi]))
    points = {"O": (0, 0), "Q": (35, 0), "A": at.near[0], "D": at.far[0], "B": at.left[0], "C": at.right[0]}
    bars = {"crank": "QA", "OB": "OB", "OC": "OC", "AB": "AB", "AC": "AC", "BD": "BD", "CD": "CD"}
    return pinned(points, {GROUND: "OQ", **bars})


def andrews() -> Mechanism:
    """Andrews' squeezing mechanism, seven bodies (Schiehlen 1990; lengths and angles of Hairer and Wanner, VII.7)."""
    beta, gamma, phi, delta = -0.0617138900142764, 0.4552798191630704, 0.2226683901658859, 0.4873649795438426
    omega, epsilon = -0.2226683901658859, 1.2305474445498212

    def along(length: float, angle: float) -> np.ndarray:
        return 1000 * planar.polar(length, angle)

    crank = along(0.007, beta)
    e = crank - along(0.028, beta)
    fixed_a, fixed_b = 1000 * np.array([-0.06934, -0.00227]), 1000 * np.array([-0.03635, 0.03273])
    corner_g, corner_h = e + along(0.02, phi + delta + np.pi / 2), e - along(0.02, omega + epsilon)
    for corner, end, length in ((e, fixed_b, 0.035), (corner_g, fixed_a, 0.04), (corner_h, fixed_a, 0.04)):
        assert np.isclose(np.linalg.norm(corner - end), 1000 * length, rtol=1e-9)  # consistent as published
    points = {"O": (0, 0), "F": crank, "E": e, "A": fixed_a, "B": fixed_b, "G": corner_g, "H": corner_h}
    bars = {"K1": "OF", "K2": "FE", "K3": "EB", "K4": "EG", "K5": "GA", "K6": "EH", "K7": "HA"}
    assert np.isclose(gamma, np.arctan2(*(e - fixed_b)[::-1]) + np.pi / 2)
    return pinned(points, {GROUND: "OAB", **bars})


def oldham(theta=0.4, offset=10.0) -> Mechanism:
    slot, other = planar.polar(1.0, theta), planar.polar(1.0, theta + np.pi / 2)
    centre = planar.oldham(np.array([theta]), offset)[0]
    return Mechanism.build(
        fixed=[GROUND],
        joints=[
            revolute("in", GROUND, "input", point=(0, 0, 0), axis=Z),
            prismatic("first", "input", "disc", axis=flat(slot), point=flat(centre)),
            prismatic("second", "disc", "output", axis=flat(other), point=flat(centre)),
            revolute("out", GROUND, "output", point=(offset, 0, 0), axis=Z),
        ],
    )


def sarrus(theta=0.6, link=50.0) -> Mechanism:
    """Two chains of three parallel hinges in perpendicular planes: the platform moves straight."""
    knee, top = link * np.cos(theta), 2 * link * np.sin(theta)
    joints = []
    for side, out, axis in (("x", (1, 0, 0), (0, 1, 0)), ("y", (0, 1, 0), (1, 0, 0))):
        foot = 30 * np.array(out, float)
        places = (foot, foot + knee * np.array(out) + [0, 0, top / 2], foot + [0, 0, top])
        chain = (GROUND, f"lower {side}", f"upper {side}", "platform")
        joints += [
            revolute(f"{side}{i}", chain[i], chain[i + 1], point=place, axis=axis) for i, place in enumerate(places)
        ]
    return Mechanism.build(fixed=[GROUND], joints=joints)


def fivebar() -> Mechanism:
    """Two arms of two links, from (0, 0) and from (4, 0), that meet at (1.5, 2) in C."""
    return Mechanism.build(
        fixed=[GROUND],
        joints=[
            revolute("A", GROUND, "a", point=(0, 0, 0), axis=Z),
            revolute("B", "a", "b", point=(-0.5, 1.5, 0), axis=Z),
            revolute("C", "b", "c", point=(1.5, 2, 0), axis=Z),
            revolute("D", "c", "d", point=(4.2, 1.5, 0), axis=Z),
            revolute("E", GROUND, "d", point=(4, 0, 0), axis=Z),
        ],
    )


def hexapod() -> Mechanism:
    """Six legs between balls, each a slide: six freedoms, and the spin of each half of a leg."""
    at = parallel.hexapod()
    turn = np.array([[0.98, -0.17, 0.1], [0.18, 0.97, -0.12], [-0.08, 0.13, 0.99]])
    platform = at.platform @ np.linalg.qr(turn)[0].T * [1, 1, 1] + [5.0, -8.0, 220.0]
    return hexapod_between(at.base, platform)


def hexapod_between(bases, platform) -> Mechanism:
    """Six legs from balls of the base to balls of the platform, each (6, 3)."""
    joints = []
    for i, (base, top) in enumerate(zip(bases, platform, strict=True)):
        joints += [
            spherical(f"base {i}", GROUND, f"tube {i}", point=base),
            prismatic(f"leg {i}", f"tube {i}", f"rod {i}", axis=top - base, point=base),
            spherical(f"top {i}", f"rod {i}", "platform", point=top),
        ]
    return Mechanism.build(fixed=[GROUND], joints=joints)


def delta(position=(20.0, -30.0, -420.0)) -> Mechanism:
    """Clavel's robot: the platform moves in parallel, three freedoms, and six forearms spin between their balls."""
    angles = parallel.delta(np.array([position]))[0]
    joints = []
    for i, (turn, angle) in enumerate(zip(2 * np.pi / 3 * np.arange(3), angles, strict=True)):
        out, across = np.array([np.cos(turn), np.sin(turn), 0]), np.array([-np.sin(turn), np.cos(turn), 0])
        elbow = (200 + 240 * np.cos(angle)) * out - [0, 0, 240 * np.sin(angle)]
        joints.append(revolute(f"motor {i}", GROUND, f"arm {i}", point=200 * out, axis=across))
        for side in (-1, 1):
            shift, name = 30 * side * across, f"forearm {i}{'+' if side > 0 else '-'}"
            joints.append(spherical(f"elbow {name}", f"arm {i}", name, point=elbow + shift))
            wrist = np.array(position) + 45 * out + shift
            joints.append(spherical(f"wrist {name}", name, "platform", point=wrist))
    return Mechanism.build(fixed=[GROUND], joints=joints)


def cam_roller(theta=0.5) -> Mechanism:
    """An eccentric disc lifts a roller: contact state (f)."""
    centre = np.array([8 * np.cos(theta), 8 * np.sin(theta), 0.0])
    height = centre[1] + np.sqrt(31.0**2 - (centre[0] - 3.0) ** 2)
    disc, roller = np.eye(4), np.eye(4)
    disc[:3, 3], roller[:3, 3] = centre, (3.0, height, 0.0)
    return Mechanism.build(
        fixed=[GROUND],
        joints=[
            revolute("shaft", GROUND, "cam", point=(0, 0, 0), axis=Z),
            prismatic("guide", GROUND, "follower", axis=(0, 1, 0)),
            contact_joint("touch", "cam", "follower", state="f", frames=[disc, roller]),
        ],
    )


def swash_plate(tilt=0.35) -> Mechanism:
    """A ball on a piston rests on a tilted plate: contact state (d)."""
    normal = np.array([0.0, -np.sin(tilt), np.cos(tilt)])
    plane, ball = np.eye(4), np.eye(4)
    plane[:3, :3] = ball[:3, :3] = np.stack([[1, 0, 0], np.cross(normal, [1, 0, 0]), normal], axis=1)
    ball[:3, 3] = (40.0, 0.0, 6.0 / normal[2])
    plane[:3, 3] = ball[:3, 3] - 6.0 * normal
    return Mechanism.build(
        fixed=[GROUND],
        joints=[
            revolute("shaft", GROUND, "plate", point=(0, 0, 0), axis=Z),
            prismatic("bore", GROUND, "piston", axis=Z, point=(40, 0, 0)),
            contact_joint("touch", "plate", "piston", state="d", frames=[plane, ball]),
        ],
    )
