"""Mechanisms by hand, in world coordinates, for which `reference` holds closed forms. Lengths in mm."""

import numpy as np

from jaxkin.joints.pairs import contact_joint, prismatic, revolute, spherical, universal
from jaxkin.mechanism.mechanism import Mechanism
from reference.planar import FourBar, fourbar
from reference.spatial import bennett, bennett_length, rssr, spherical_fourbar

Z = (0.0, 0.0, 1.0)


def flat(point) -> tuple[float, float, float]:
    """A point of the plane z = 0."""
    x, y = np.ravel(point)
    return float(x), float(y), 0.0


def planar_fourbar(theta=1.0, pin=revolute, **lengths) -> Mechanism:
    """Crank A, coupler pins B and C, rocker D; `pin` may be `cylindrical` for the paper's own joints."""
    at: FourBar = fourbar(np.array([theta]), **lengths)
    return fourbar_through((0, 0), at.crank_pin, at.rocker_pin, (lengths.get("ground", 100.0), 0), pin)


def fourbar_through(a, b, c, d, pin=revolute) -> Mechanism:
    """The four-bar A, B, C, D whose pins are at these points of the plane."""
    return Mechanism.build(
        fixed=["ground"],
        joints=[
            pin("A", "ground", "crank", point=flat(a), axis=Z),
            pin("B", "crank", "coupler", point=flat(b), axis=Z),
            pin("C", "coupler", "rocker", point=flat(c), axis=Z),
            pin("D", "ground", "rocker", point=flat(d), axis=Z),
        ],
    )


def slider_crank(theta=1.0, crank=40.0, rod=120.0, offset=-20.0) -> Mechanism:
    """Crank A, rod B, slider pin C, slide S along x."""
    x, y = crank * np.cos(theta), crank * np.sin(theta)
    slider = x + np.sqrt(rod**2 - (y - offset) ** 2)
    return Mechanism.build(
        fixed=["ground"],
        joints=[
            revolute("A", "ground", "crank", point=(0, 0, 0), axis=Z),
            revolute("B", "crank", "rod", point=(x, y, 0), axis=Z),
            revolute("C", "rod", "slider", point=(slider, offset, 0), axis=Z),
            prismatic("S", "ground", "slider", axis=(1, 0, 0)),
        ],
    )


def cam(theta=np.pi / 6, radius=15.0, eccentricity=5.0) -> Mechanism:
    """The paper's Fig. 6: eccentric disc under a flat-faced follower, contact state (b)."""
    centre = np.array([eccentricity * np.cos(theta), eccentricity * np.sin(theta), 6.0])
    foot = np.eye(4)
    foot[:3, :3] = np.array(
        [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]
    ).T  # z1 along the normal -y of the foot
    foot[:3, 3] = centre + [0.0, radius, 0.0]
    disc = np.eye(4)
    disc[:3, 3] = centre
    return Mechanism.build(
        fixed=["frame"],
        joints=[
            revolute("shaft", "frame", "cam", point=(0, 0, 0), axis=Z),
            prismatic("guide", "frame", "follower", axis=(0, 1, 0)),
            contact_joint("touch", "follower", "cam", state="b", frames=[foot, disc]),
        ],
    )


def rssr_linkage(theta=0.3) -> Mechanism:
    """Crank A, rod with balls B and C that may spin, rocker D about a skew axis."""
    at = rssr(np.array([theta]))
    return Mechanism.build(
        fixed=["ground"],
        joints=[
            revolute("A", "ground", "crank", point=(0, 0, 0), axis=Z),
            spherical("B", "crank", "rod", point=at.crank_ball[0]),
            spherical("C", "rod", "rocker", point=at.rocker_ball[0]),
            revolute("D", "ground", "rocker", point=(100.0, 40.0, 60.0), axis=(0.2, 0.9, 0.3)),
        ],
    )


def bennett_linkage(theta=0.9, twist=0.7, other_twist=1.2, length=60.0) -> Mechanism:
    """Four hinges whose axes are neither parallel nor concurrent: overconstrained, mobility 1."""
    angles = bennett(np.array([theta]), twist, other_twist)[0]
    other = bennett_length(length, twist, other_twist)
    pose, joints = np.eye(4), []
    links = ["ground", "first", "second", "third", "ground"]
    for i, (angle, distance, tilt) in enumerate(
        zip(angles, (length, other) * 2, (twist, other_twist) * 2, strict=True)
    ):
        joints.append(revolute("ABCD"[i], links[i], links[i + 1], point=pose[:3, 3], axis=pose[:3, 2]))
        pose = pose @ denavit_hartenberg(angle, distance, tilt)
    return Mechanism.build(fixed=["ground"], joints=joints)


def denavit_hartenberg(angle: float, length: float, twist: float) -> np.ndarray:
    """Rz(angle) Tx(length) Rx(twist)."""
    c, s, ct, st = np.cos(angle), np.sin(angle), np.cos(twist), np.sin(twist)
    return np.array([[c, -s * ct, s * st, length * c], [s, c * ct, -c * st, length * s], [0, st, ct, 0], [0, 0, 0, 1]])


def spherical_linkage(theta=0.4, ground=1.2, crank=0.5, coupler=1.1, rocker=0.9) -> Mechanism:
    """Four hinges whose axes meet at the origin; their points lie on the axes, well apart."""
    at = spherical_fourbar(np.array([theta]), ground, crank, coupler, rocker)
    output = (0.0, -np.sin(ground), np.cos(ground))
    return Mechanism.build(
        fixed=["ground"],
        joints=[
            revolute("A", "ground", "crank", point=(0, 0, 50.0), axis=Z),
            revolute("B", "crank", "coupler", point=60.0 * at.input_pin[0], axis=at.input_pin[0]),
            revolute("C", "coupler", "rocker", point=40.0 * at.output_pin[0], axis=at.output_pin[0]),
            revolute("D", "ground", "rocker", point=(0, 0, 0), axis=output),
        ],
    )


def cardan_shafts(shafts=0.5) -> Mechanism:
    """Two shafts in the plane x z that meet at the origin at an angle; at zero the input yoke is along the normal y."""
    other = np.array([np.sin(shafts), 0.0, np.cos(shafts)])
    return Mechanism.build(
        fixed=["ground"],
        joints=[
            revolute("in", "ground", "shaft", point=(0, 0, -80.0), axis=Z),
            universal("cross", "shaft", "output", point=(0, 0, 0), axis1=(0, 1, 0), axis2=np.cross(other, (0, 1.0, 0))),
            revolute("out", "ground", "output", point=80.0 * other, axis=other),
        ],
    )


def ball_in_bore(theta=0.3, crank=30.0, distance=80.0) -> Mechanism:
    """A ball on a crank fills a bore along an arm: contact state (j) on a circle."""
    ball = np.array([crank * np.cos(theta), crank * np.sin(theta), 0.0])
    arm = ball + [distance, 0.0, 0.0]
    bore = np.eye(4)
    bore[:3, 2] = arm / np.linalg.norm(arm)
    bore[:3, 0] = Z
    bore[:3, 1] = np.cross(bore[:3, 2], bore[:3, 0])
    bore[:3, 3] = ball
    return Mechanism.build(
        fixed=["ground"],
        joints=[
            revolute("A", "ground", "crank", point=(0, 0, 0), axis=Z),
            revolute("D", "ground", "arm", point=(-distance, 0, 0), axis=Z),
            contact_joint("ball", "arm", "crank", state="j", region="circle", frames=[bore, bore]),
        ],
    )
