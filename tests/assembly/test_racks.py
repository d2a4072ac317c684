"""Gears proposed from sectors and racks: the full turn and the pitch circle follow from the distance of the teeth."""

import numpy as np
import pytest

import jaxkin as jk
from assembly.toothed import Z, ratio, walls_between, wheel, with_solids
from jaxkin.geometry.part import Part
from jaxkin.geometry.teeth import find_teeth


def sector(name, number, module, there, **more):
    """A piece of a wheel with some of its teeth, in the middle about x, and a hub of half its radius elsewhere."""
    whole = wheel(name, number, module, **more)
    at = np.asarray(more.get("at", (0, 0, 0)), float)
    corners = whole.triangles - at
    # what is drawn of `wheel` for the z axis has its own x axis: angles are from there
    x = np.cross([0.3, 0.5, 0.1], Z)
    x /= np.linalg.norm(x)
    angle = np.arctan2(corners @ np.cross(Z, x), corners @ x)
    radius = np.hypot(corners[..., 0], corners[..., 1])
    away = np.abs(angle) > np.pi * there / number
    hub = 0.5 * number * module / 2
    shrink = np.where(away & (radius > hub), hub / np.maximum(radius, 1e-9), 1.0)[..., None]
    return Part(name, (), np.concatenate([corners[..., :2] * shrink, corners[..., 2:]], axis=2) + at)


def row(name, count, module, *, centre, along=(1.0, 0, 0), up=(0, 1.0, 0), width=8.0, plain=0.0):
    """A rack whose pitch line passes `centre`, with teeth that point against `up`; `plain` ends without teeth."""
    pitch = np.pi * module
    s = np.linspace(-count * pitch / 2, count * pitch / 2, 24 * count + 1)
    wave = np.clip(4.0 * np.abs((s / pitch + 0.5 * (count % 2)) % 1.0 - 0.5) - 1.0, -0.6, 0.6) / 0.6
    top = module * (1.125 * wave - 0.125)
    s = np.concatenate([[s[0] - plain], s, [s[-1] + plain]])
    top = np.concatenate([[-1.25 * module], top, [-1.25 * module]])
    x, y, z = np.asarray(along, float), np.asarray(up, float), np.cross(along, up)
    layers = []
    for depth in (-width / 2, width / 2):
        ends = [centre + s[:, None] * x - height[:, None] * y + depth * z for height in (top, 0 * top - 4 * module)]
        layers.append(np.concatenate([ends[0], ends[1][::-1]]))
    return Part(name, (), np.concatenate(walls_between(*layers)))


@pytest.mark.parametrize("there", [5, 9, 20])
@pytest.mark.parametrize("number", [24, 60])
def test_teeth_of_a_sector_are_counted_and_the_full_turn_follows_from_their_distance(number, there):
    part = sector("sector", number, 2.0, there)
    found = find_teeth(part.triangles, np.zeros(3), Z, (-4.0, 4.0))
    assert {(each.number, each.side) for each in found} == {(number, "outer")}
    assert all(abs(each.counted - there) <= 1 for each in found)  # the teeth at its ends are cut in two
    assert all(abs(each.pitch_radius - number) < 0.3 for each in found)


def test_a_sector_and_a_pinion_are_a_gear():
    facing = np.cross([0.3, 0.5, 0.1], Z)  # where the middle of its teeth is drawn
    at = -60 * facing / np.linalg.norm(facing)
    joints = [
        jk.revolute("A", "ground", "pinion", point=(0, 0, 0), axis=(0, 0, 1)),
        jk.revolute("B", "ground", "wheel", point=at, axis=(0, 0, 1)),
    ]
    part = sector("wheel", 40, 2.0, 9, at=at)
    (found,) = jk.gear_proposals(with_solids(joints, wheel("pinion", 20, 2.0), part))
    assert found.teeth == (20, 40) and found.counted[0] == 20 and found.counted[1] in (8, 9, 10)
    assert ratio(found.coupling, "A.phi", "B.phi") == pytest.approx(-0.5, abs=1e-12)
    assert f"'wheel' ({found.counted[1]} of 40 teeth)" in str(found)


@pytest.mark.parametrize("above", [1, -1])
@pytest.mark.parametrize("sense", [1, -1])
@pytest.mark.parametrize("reversed_parts", [False, True])
def test_a_rack_slides_as_the_pitch_circle_rolls(above, sense, reversed_parts):
    number, module = 20, 2.0
    parts = ("rack", "ground") if reversed_parts else ("ground", "rack")
    joints = [
        jk.revolute("A", "ground", "pinion", point=(0, 0, 0), axis=(0, 0, sense)),
        jk.prismatic("B", *parts, axis=(1, 0, 0)),
    ]
    teeth = row("rack", 12, module, centre=np.array([5.0, above * 20.0, 0.0]), up=(0, above, 0), plain=15.0)
    mechanism = with_solids(joints, wheel("pinion", number, module), teeth)
    (found,) = jk.gear_proposals(mechanism)
    assert (found.parts, found.meshing, found.ratio) == (("pinion", "rack"), "rack", None)
    assert found.teeth[0] == number and abs(found.teeth[1] - 12) <= 1
    assert found.module == pytest.approx(module, rel=2e-3)  # of outlines in 4096 samples
    # for a turn about +z what is above the axis moves along -x, in the world, by the radius of the pitch circle
    moved = ratio(found.coupling, "A.phi", "B.z") * sense * (-1 if reversed_parts else 1)
    assert moved == pytest.approx(-above * number * module / 2, rel=2e-3)


@pytest.mark.parametrize("wrong", ["far", "module", "aside", "plain"])
def test_what_is_no_rack_of_a_wheel(wrong):
    joints = [
        jk.revolute("A", "ground", "pinion", point=(0, 0, 0), axis=(0, 0, 1)),
        jk.prismatic("B", "ground", "rack", axis=(1, 0, 0)),
    ]
    far = {"far": 23.0}.get(wrong, 20.0)
    module, x = {"module": 2.6}.get(wrong, 2.0), {"aside": 70.0}.get(wrong, 0.0)
    teeth = row("rack", 12, module, centre=np.array([x, far, 0.0]), plain=80.0)
    if wrong == "plain":  # a bar with as many corners
        flat = teeth.triangles.copy()
        flat[..., 1] = np.where(flat[..., 1] < 24.0, 19.0, flat[..., 1])
        teeth = Part("rack", (), flat)
    assert jk.gear_proposals(with_solids(joints, wheel("pinion", 20, 2.0), teeth)) == ()
