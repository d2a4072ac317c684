"""Screws with a ball on their end in the socket of a pad, at a place, a size and in an order at random, which change
nothing."""

import pytest
import trimesh

from jaxkin.geometry.surfaces import Sphere
from reference.round_parts import SEEDS, Z, anywhere, assembly, block, kind_of, owners, part, pin, ring


def ball(radius, centre, side):
    """Surface and triangles of a ball about a point of the axis, or of its socket, open towards +z."""
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=radius)
    kept = mesh.triangles[mesh.triangles.mean(axis=1)[:, 2] < 0.6 * radius] + centre * Z
    return [(Sphere(centre * Z, radius, side), kept if side > 0 else kept[:, ::-1])]


def clamp(knob):
    """A screw through a frame with a ball on its end, in the socket of a pad, with play; a knob on the other end."""
    frame = part("frame", ring(4.0, 12.0, 0, 12), block((12, -10, -60), (20, 10, 12)))
    screw = part("screw", pin(4.0, -20, 25), pin(12.0 if knob else 3.9, 25, 31), ball(3.0, -22.0, 1))
    socket = [ball(3.15, -22.0, -1), block((-10, -10, -40), (10, 10, -26))]
    return assembly(frame, screw, part("pad", *socket))


@pytest.mark.parametrize("seed", SEEDS)
def test_a_screw_with_a_knob_and_a_swivelling_pad_moves_in_its_thread(seed):
    mechanism = anywhere(clamp(True), seed).mechanism(fixed=["frame"])
    assert kind_of(mechanism, "frame", "screw") == "cylindrical"
    assert kind_of(mechanism, "screw", "pad") == "spherical"


@pytest.mark.parametrize("seed", SEEDS)
def test_the_stud_of_a_ball_joint_without_a_knob_is_held_in_its_thread(seed):
    body = owners(anywhere(clamp(False), seed).mechanism(fixed=["frame"]))
    assert body["screw"] == body["frame"]
