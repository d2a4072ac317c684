"""A leg of the robot Cassie: motors, springs, and rods that close two loops."""

import numpy as np

from jaxkin.geometry.pose import frame
from jaxkin.joints.pairs import revolute, spherical
from jaxkin.mechanism.mechanism import Mechanism

CASSIE = (
    # body, parent, place and axes x and y in it
    ("hip-roll", "pelvis", (0.021, 0.135, 0), (0, 0, -1), (0, 1, 0)),
    ("hip-yaw", "hip-roll", (0, 0, -0.07), (0, 0, 1), (0, 1, 0)),
    ("hip-pitch", "hip-yaw", (0, 0, -0.09), (0, 0, -1), (1, 0, 0)),
    ("rod", "hip-pitch", (0, 0, 0.045), (0.7922, -0.60599, -0.072096), (0.60349, 0.79547, -0.054922)),
    ("knee", "hip-pitch", (0.12, 0, 0.0045), (1, -1, 0), (1, 1, 0)),
    ("shin", "knee", (0.06068, 0.04741, 0), (1, 0, 0), (0, 1, 0)),
    ("tarsus", "shin", (0.43476, 0.02, 0), (0.52992, 0.84805, 0), (-0.84805, 0.52992, 0)),
    ("heel", "tarsus", (-0.01269, -0.03059, 0.00092), (-0.91211, 0.40829, 0.036948), (-0.40992, -0.90952, -0.068841)),
    ("foot-crank", "tarsus", (0.058, -0.034, 0.02275), (1, 0, 0), (0, 1, 0)),
    ("plantar-rod", "foot-crank", (0.055, 0, -0.00791), (1, 0, 0), (0, 1, 0)),
    ("foot", "tarsus", (0.408, -0.04, 0), (1, 0, 0), (0, 1, 0)),
)


def cassie_leg() -> Mechanism:
    """A leg of the robot Cassie by the numbers of its MJCF model (MuJoCo Menagerie, Agility Robotics, MIT), in metres.

    Every body turns about its z axis on the one before, but for the rod at the heel, which has a ball at either end.
    """
    pose, joints = {"pelvis": np.eye(4)}, []
    for name, parent, place, x, y in CASSIE:
        place, x, y = np.array([place, x, y], float)
        pose[name] = pose[parent] @ frame(place, np.cross(x, y), x)
        pin = {"point": pose[name][:3, 3]}
        ball = name == "rod"
        joints.append(
            spherical(name, parent, name, **pin)
            if ball
            else revolute(name, parent, name, **pin, axis=pose[name][:3, 2])
        )
    for rod, length, other in (("rod", 0.5012, "heel"), ("plantar-rod", 0.35012, "foot")):
        joints.append(spherical(f"connect {other}", rod, other, point=(pose[rod] @ [length, 0, 0, 1])[:3]))
    return Mechanism.build(fixed=["pelvis"], joints=joints)
