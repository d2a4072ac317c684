"""Forward kinematics of robot files, computed from their text alone: numpy and scipy, nothing of jaxkin."""

from xml.etree import ElementTree

import numpy as np
from scipy.spatial.transform import Rotation


def pose(turn, point):
    result = np.eye(4)
    result[:3, :3], result[:3, 3] = turn, point
    return result


def floats(text):
    return np.array(text.split(), float)


def urdf_poses(path, values):
    """Poses of all links of a URDF for values of its joints, each a tuple, and the axes of these in the world."""
    root = ElementTree.parse(path).getroot()
    joints = root.findall("joint")
    children = {joint.find("child").get("link") for joint in joints}
    base = next(link.get("name") for link in root.findall("link") if link.get("name") not in children)
    links, axes, left = {base: np.eye(4)}, {}, joints
    while left:
        ready = [joint for joint in left if joint.find("parent").get("link") in links]
        for joint in ready:
            origin = {} if joint.find("origin") is None else joint.find("origin").attrib
            turn = Rotation.from_euler("xyz", floats(origin.get("rpy", "0 0 0"))).as_matrix()
            frame = links[joint.find("parent").get("link")] @ pose(turn, floats(origin.get("xyz", "0 0 0")))
            step = np.eye(4)
            if joint.get("type") != "fixed":
                axis = floats(joint.find("axis").get("xyz"))
                axes[joint.get("name")] = (frame[:3, 3], frame[:3, :3] @ axis)
                (value,) = values[joint.get("name")]
                if joint.get("type") == "prismatic":
                    step[:3, 3] = axis * value
                else:
                    step[:3, :3] = Rotation.from_rotvec(axis * value).as_matrix()
            links[joint.find("child").get("link")] = frame @ step
        left = [joint for joint in left if joint not in ready]
    return links, axes


def frame_links(path):
    """The link that the name of a frame means: the child of a joint, or the link itself."""
    root = ElementTree.parse(path).getroot()
    found = {link.get("name"): link.get("name") for link in root.findall("link")}
    return found | {joint.get("name"): joint.find("child").get("link") for joint in root.findall("joint")}
