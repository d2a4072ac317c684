"""An oval cam with a roller follower that swings: a mechanism for tests of joints along curves."""

import numpy as np

import jaxkin as jk

TURN = np.linspace(0.0, 2 * np.pi, 13)


def roller(profile=None, unit=1.0, place=None, names=("ground", "cam", "arm"), backwards=False):
    """An oval cam that swings an arm by a roller, at any place, in any unit."""
    turn = 2 * np.pi * np.arange(60) / 60
    oval = np.stack([28 * np.cos(turn), 20 * np.sin(turn) - 2 * np.sin(3 * turn)], axis=1)
    profile = oval if profile is None else profile
    place = np.eye(4) if place is None else place

    def at(point):
        return place[:3, :3] @ (unit * np.array(point, float)) + place[:3, 3]

    ground, cam, arm = names
    joints = [
        jk.revolute("shaft", ground, cam, point=at((0, 0, 0)), axis=place[:3, 2]),
        jk.cam(
            "contact",
            cam,
            arm,
            profile=unit * profile,
            follower="roller",
            radius=unit * 5.0,
            point=at((0, 0, 0)),
            axis=place[:3, 2],
            direction=place[:3, 0],
            point2=at((0, 27, 0)),
        ),
        jk.revolute("pivot", ground, arm, point=at((45, 20, 0)), axis=place[:3, 2]),
    ]
    return jk.Mechanism.build(fixed=[ground], joints=joints[::-1] if backwards else joints)


def swings(mechanism):
    """The angle of its arm over a turn of the shaft."""
    return np.asarray(mechanism.sweep({"shaft": TURN}, throw=True).coordinates["pivot"])[:, 0]


def flat_on_oval(**more):
    """The same cam lifts a flat face; `more` replaces what `jk.cam` is given."""
    turn = 2 * np.pi * np.arange(60) / 60
    oval = np.stack([28 * np.cos(turn), 20 * np.sin(turn) - 2 * np.sin(3 * turn)], axis=1)
    given = {"profile": oval, "follower": "flat", "point2": (0, 22, 0), "direction2": (1, 0, 0)} | more
    return jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("shaft", "ground", "cam", point=(0, 0, 0), axis=(0, 0, 1)),
            jk.cam("contact", "cam", "follower", **given),
            jk.prismatic("guide", "ground", "follower", axis=(0, 1, 0)),
        ],
    )
