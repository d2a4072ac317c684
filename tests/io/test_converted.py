"""Assemblies whose exporter wrote every face as a spline, or every round face as a curve that is swept about an axis.

The shipped examples, converted by the modelling kernel as exporters do it: all their faces to rational splines, or
cylinders, cones and spheres to surfaces of revolution. Their joints have to be those of the faces as drawn.
"""

import lzma
from collections import Counter
from pathlib import Path

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples import EXAMPLES, path
from jaxkin.geometry.fit_together import Piece, fit_together
from jaxkin.geometry.surfaces import Cone

CONVERTED = Path(__file__).parent / "data" / "converted"


@pytest.mark.long
@pytest.mark.parametrize(
    ("name", "written"), [("cam", "B_SPLINE_SURFACE"), ("fourbar", "B_SPLINE_SURFACE"), ("slider_crank", "REVOLUTION")]
)
def test_converted_assemblies_have_the_same_faces_and_joints(name, written, tmp_path):
    how = "revolved" if written == "REVOLUTION" else "splines"
    text = lzma.decompress((CONVERTED / f"{name}.{how}.step.xz").read_bytes())
    assert b"CYLINDRICAL_SURFACE" not in text and text.count(written.encode()) > 10
    (tmp_path / "converted.step").write_bytes(text)
    drawn, converted = jk.load(path(name)), jk.load(tmp_path / "converted.step")
    for part, other in zip(drawn.parts, converted.parts, strict=True):
        assert part.name == other.name and part.notes == other.notes
        kinds = (Counter(face.surface.kind for face in each.faces) for each in (part, other))
        assert next(kinds) == next(kinds)
    fixed = EXAMPLES[name].fixed
    given, found = (each.mechanism(fixed=fixed).all_joints for each in (drawn, converted))
    assert [(joint.name, joint.kind) for joint in given] == [(joint.name, joint.kind) for joint in found]
    for joint, other in zip(given, found, strict=True):
        # corners are float32, 6e-8 of parts of 200 mm; x may point either way along the axis of a cam
        np.testing.assert_allclose(other.frames_1[..., 2:], joint.frames_1[..., 2:], atol=2e-5)


def cone_piece(turn, width, noise, seed):
    """A patch of a cone of half angle 60 degrees between the radii 3 and 4, turned about z, with noise of corners."""
    phi, radius = np.meshgrid(turn + np.linspace(0, width, 9), np.linspace(3, 4, 3))
    phi, radius = phi.ravel(), radius.ravel()
    corners = np.stack([radius * np.cos(phi), radius * np.sin(phi), radius / np.tan(np.pi / 3)], axis=-1)
    out = np.stack([np.cos(phi), np.sin(phi), np.full_like(phi, -np.tan(np.pi / 3))], axis=-1) / 2
    return Piece(corners + noise * np.random.default_rng(seed).uniform(-1, 1, corners.shape), out, None)


def test_pieces_of_one_cone_are_known_together():
    """Six narrow patches, as in the chamfer of a nut: alone each has an axis of its own, a strip of one has none."""
    noise = 2e-6
    pieces = [cone_piece(k * np.pi / 3, 0.2, noise, k) for k in range(6)]
    alone = [fit_together([piece], 10 * noise, 1e-5, 1e-3)[0] for piece in pieces]
    assert alone == [None] * 6  # a piece brings the surface that was fitted to it
    fitted = [Piece(p.corners, p.normals, tilted(k)) for k, p in enumerate(pieces)]
    strip = cone_piece(0.1, 0.01, 0.0, 9)
    few = Piece(strip.corners[:4], strip.normals[:4], None)
    *found, of_strip = fit_together([*fitted, few], 10 * noise, 1e-5, 1e-3)
    assert isinstance(of_strip, Cone) and all(each is of_strip for each in found)
    # the mean of 162 corners
    np.testing.assert_allclose(of_strip.axis, [0, 0, 1], atol=noise)
    np.testing.assert_allclose(of_strip.apex, 0.0, atol=4 * noise)  # outside of the corners, by three of their widths


def tilted(seed):
    """The cone, as a narrow piece knows it: its axis is off by some 1e-5."""
    x, y = 2e-5 * np.random.default_rng(seed).normal(size=2)
    return Cone(np.array([-3 * x, -3 * y, 0.0]), np.array([x, y, 1.0]) / np.hypot(1.0, np.hypot(x, y)), np.pi / 3, 1)


def test_another_surface_beside_it_is_not_taken_in():
    """A patch of the mirrored cone, which meets the first at its apex, keeps its own surface."""
    one = cone_piece(0.0, 2.0, 0.0, 0)
    first = Cone(np.zeros(3), np.array([0.0, 0.0, 1.0]), np.pi / 3, 1)
    second = Cone(np.zeros(3), np.array([0.0, 0.0, -1.0]), np.pi / 3, 1)
    mirror = np.array([1.0, 1.0, -1.0])
    pieces = [Piece(one.corners, one.normals, first), Piece(one.corners * mirror, one.normals * mirror, second)]
    assert fit_together(pieces, 1e-6, 1e-5, 1e-3) == [first, second]
