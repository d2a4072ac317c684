"""Linkages with more constraints than counting allows, with their closed forms; poses as in `reference.planar`."""

from __future__ import annotations

import numpy as np

from jaxkin.joints.pairs import cylindrical, planar, revolute, spherical
from jaxkin.mechanism.mechanism import Mechanism
from reference.mechanisms import Z, denavit_hartenberg
from reference.spatial import bennett, bennett_length, half_turns, spherical_fourbar

Array = np.ndarray


def bricard(theta: Array, twist=1.2, branch=1) -> Array:
    """Every other joint angle of the threefold-symmetric Bricard linkage, theta being that of the three between them
    (poses,); links of equal length, twists of alternating sign (Chen, You and Tarnai, 2005)."""
    c, s = np.cos(twist), np.sin(twist)
    cosine = s * s + (1 + c * c) * np.cos(theta)
    return half_turns(cosine, -2 * c * np.sin(theta), -(c * c + s * s * np.cos(theta)), branch)


def bricard_linkage(theta=0.3, twist=1.2, length=50.0) -> Mechanism:
    """Six hinges A to F: mobility 1 where counting gives 0."""
    other = float(bricard(np.array([theta]), twist)[0])
    frames = [np.eye(4)]
    for angle, tilt in zip((theta, other) * 3, (twist, -twist) * 3, strict=True):
        frames.append(frames[-1] @ denavit_hartenberg(angle, length, tilt))
    links = ["ground", *(f"link {number}" for number in range(1, 6)), "ground"]
    return Mechanism.build(
        fixed=["ground"],
        joints=[
            revolute("ABCDEF"[number], *links[number : number + 2], point=frame[:3, 3], axis=frame[:3, 2])
            for number, frame in enumerate(frames[:6])
        ],
    )


GOLDBERG = {"length": 40.0, "twist": 0.6, "common": 1.1, "second": 0.85, "bend": 0.5}
"""Links of the first Bennett linkage, the twist of the link that both share, that of the second one's other links, and
the angle between those two links, at the common hinge, that are made one."""


def goldberg(phi: Array) -> dict[str, Array]:
    """Angles of the five joints (poses,) of Goldberg's linkage (1943): two Bennett linkages with a link in common.

    Of that link one hinge, the angle phi of the first linkage, is frozen against the second one; the link goes.
    """
    turned = phi + GOLDBERG["bend"]
    psi = bennett(phi, GOLDBERG["twist"], GOLDBERG["common"])[..., 1]
    other = bennett(turned, GOLDBERG["second"], GOLDBERG["common"])[..., 1]
    return {"S": -phi, "P": other - psi, "U": -turned, "T": other, "R": psi}


def goldberg_linkage(phi=0.8) -> Mechanism:
    """Five hinges, mobility 1 where counting gives -1: ground RS, then SP, PU, UT and the two links TR made one."""
    size, turned = GOLDBERG, phi + GOLDBERG["bend"]
    common = bennett_length(size["length"], size["twist"], size["common"])
    second = common * np.sin(size["second"]) / np.sin(size["common"])
    psi = float(bennett(np.array([phi]), size["twist"], size["common"])[0, 1])
    other = float(bennett(np.array([turned]), size["second"], size["common"])[0, 1])
    r = denavit_hartenberg(phi, size["length"], size["twist"])  # from the hinge that is frozen
    s = r @ denavit_hartenberg(psi, common, size["common"])
    p = np.linalg.inv(denavit_hartenberg(0.0, common, size["common"]))
    t = denavit_hartenberg(turned, second, size["second"])
    u = t @ denavit_hartenberg(other, common, size["common"])
    frames = {"S": s, "P": p, "U": u, "T": t, "R": r}
    ends = {"S": "RS SP", "P": "SP PU", "U": "UT PU", "T": "TR UT", "R": "TR RS"}
    return Mechanism.build(
        fixed=["RS"],
        joints=[
            revolute(name, *ends[name].split(), point=frame[:3, 3], axis=frame[:3, 2]) for name, frame in frames.items()
        ],
    )


def missing_axes(theta=0.4, miss=1e-4) -> Mechanism:
    """A spherical four-bar of 100 mm whose axes miss each other by fractions of `miss`: RCCC, mobility 1.

    Rotations do not feel where axes are: the angles are those of the spherical four-bar (Duffy, 1980, chapter 5).
    """
    at = spherical_fourbar(np.array([theta]))
    axes = [np.array(Z), at.input_pin[0], at.output_pin[0], np.array([0.0, -np.sin(1.2), np.cos(1.2)])]
    aside = [np.cross(axis, other) for axis, other in zip(axes, axes[1:] + axes[:1], strict=True)]
    frames = []
    for axis, off, share in zip(axes, aside, (0.3, 1.0, -0.6, 0.45), strict=True):
        frame = np.eye(4)
        frame[:3, 2], frame[:3, 3] = axis, 100.0 * (0.5 * axis + miss * share * off / np.linalg.norm(off))
        frames.append(frame)
    pairs = {"A": revolute, "B": cylindrical, "C": cylindrical, "D": cylindrical}
    parts = {"A": ("ground", "crank"), "B": ("crank", "coupler"), "C": ("coupler", "rocker"), "D": ("ground", "rocker")}
    return Mechanism.build(
        fixed=["ground"],
        joints=[
            pairs[name](name, *parts[name], point=frame[:3, 3], axis=frame[:3, 2])
            for name, frame in zip("ABCD", frames, strict=True)
        ],
    )


def shaft_in_contacts(contacts: int) -> Mechanism:
    """A shaft in its housing by two to six contacts, bearings and shoulders in turn: Eq. 1 of the paper, and more."""
    joints = []
    for number in range(contacts):
        along = 20.0 * number
        if number % 2:
            joints.append(planar(f"shoulder {number}", "housing", "shaft", normal=Z, point=(0.0, 0.0, along)))
        else:
            joints.append(cylindrical(f"bearing {number}", "housing", "shaft", point=(0.0, 0.0, along), axis=Z))
    return Mechanism.build(fixed=["housing"], joints=joints)


def wrist() -> Mechanism:
    """A body on a ball, and beside it on three hinges through the ball's centre: it turns to any attitude."""
    hinges = {"A": ("ground", "one", Z), "B": ("one", "two", (1, 0, 0)), "C": ("two", "body", Z)}
    return Mechanism.build(
        fixed=["ground"],
        joints=[
            *(
                revolute(name, one, other, point=30.0 * (number + 1) * np.array(axis, float), axis=axis)
                for number, (name, (one, other, axis)) in enumerate(hinges.items())
            ),
            spherical("ball", "ground", "body", point=(0, 0, 0)),
        ],
    )
