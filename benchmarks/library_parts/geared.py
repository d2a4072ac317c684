"""Machines with gears and racks: a planetary stage, an arbor press."""

from __future__ import annotations

import numpy as np
from bd_warehouse.bearing import (
    SingleRowCappedDeepGrooveBallBearing,
    SingleRowCylindricalRollerBearing,
    SingleRowDeepGrooveBallBearing,
)
from bd_warehouse.fastener import ButtonHeadScrew, SetScrew, SocketHeadCapScrew
from bd_warehouse.gear import RackGear, SpurGear, SpurGearPlan
from bd_warehouse.open_builds import ShimWasher
from bd_warehouse.retaining_ring import ExternalSnapRing, RetainingRingGroove
from build123d import Box, Cylinder, Pos, Rot, extrude
from kit import DOWN, Drawing, X, Y, Z, holed, ring, rod

MODULE, TEETH, RING_TEETH = 1.5, 18, 54


def planetary() -> Drawing:
    """Draw a planetary stage: sun and three planets of 18 teeth in a ring of 54, its plates and ring bolted."""
    d = Drawing("planetary", ["ring"], 1)
    bolts = [(46.2 * np.cos(a), 46.2 * np.sin(a), 2.75) for a in np.arange(4) * np.pi / 2]
    teeth = SpurGearPlan(MODULE, RING_TEETH, 20, addendum=1.25 * MODULE, dedendum=MODULE)
    half_pitch = 180 / RING_TEETH
    d.add("ring", holed(rod(50, 22), bolts, 22) - Rot(0, 0, -half_pitch) * extrude(teeth, amount=22))
    back = holed(Pos(0, 0, -12) * rod(50, 12), [*bolts, (0, 0, 8)], 12, -12)
    d.add("back plate", holed(back, [(0, 0, 11)], 7, -7))
    front = holed(Pos(0, 0, 22) * rod(50, 14), [*bolts, (0, 0, 15)], 14, 22)
    d.add("front plate", holed(front, [(0, 0, 17.5)], 12.5, 23.5))
    for k, (x, y, _) in enumerate(bolts):
        d.bolt(f"housing {k + 1}", "M5-0.8", (x, y, 36), Z, 48, screw=SocketHeadCapScrew)
    d.add("sun bearing", SingleRowDeepGrooveBallBearing("M8-22-7"), (0, 0, -7))
    d.add("carrier bearing", SingleRowCylindricalRollerBearing("M15-35-11"), (0, 0, 23.5))
    sun = Pos(0, 0, 9) * SpurGear(MODULE, TEETH, 20, 10) + rod(6, 4) + Pos(0, 0, -30) * rod(4, 34)
    d.add("sun", sun - Pos(0, 0, -7.85) * RetainingRingGroove(ExternalSnapRing("8")))
    d.add("sun circlip", ExternalSnapRing("8"), (0, 0, -7.8))
    angles = np.arange(3) * 2 * np.pi / 3
    places = [MODULE * TEETH * np.array([np.cos(a), np.sin(a)]) for a in angles]
    carrier = Pos(0, 0, 15) * rod(35, 5) + Pos(0, 0, 20) * rod(9.5, 3.5) + Pos(0, 0, 23.5) * rod(7.5, 30)
    carrier -= Pos(0, 0, 34.45) * RetainingRingGroove(ExternalSnapRing("15"))
    d.add("carrier", holed(carrier, [(*place, 2.1) for place in places], 5, 15))
    d.add("carrier circlip", ExternalSnapRing("15"), (0, 0, 34.5))
    for k, (angle, place) in enumerate(zip(angles, places, strict=True)):
        planet = holed(Pos(0, 0, 4) * SpurGear(MODULE, TEETH, 20, 8), [(0, 0, 8)], 8)
        phase = np.degrees(2 * angle) + 180 - 180 / TEETH
        d.add(f"planet {k + 1}", Rot(0, 0, float(phase)) * planet, (*place, 5))
        d.add(f"planet bearing {k + 1}", SingleRowCappedDeepGrooveBallBearing("M5-16-5"), (*place, 6.5))
        d.add(f"planet screw {k + 1}", ButtonHeadScrew("M5-0.8", length=15), (*place, 5.5), DOWN)
        d.add(f"planet shim {k + 1}", ShimWasher("10x5x1"), (*place, 5.5))
        d.add(f"planet sleeve {k + 1}", ring(3.75, 2.55, 3.5), (*place, 11.5))
        d.weld("carrier", f"planet screw {k + 1}")
        d.label("Revolute", "carrier", f"planet {k + 1}", (*place, 0))
    d.weld("ring", "back plate", "front plate")
    d.label("Revolute", "ring", "sun")
    d.label("Revolute", "ring", "carrier")
    return d


def arbor_press() -> Drawing:
    """Draw an arbor press: a pinion on a shaft in two bushes drives the rack of a ram behind a bolted cover."""
    d = Drawing("arbor_press", ["frame"], 1)
    frame = Pos(-45, 0, 90) * Box(50, 60, 220) + Pos(5, 0, 160) * Box(50, 60, 80) + Pos(20, 0, -10) * Box(180, 100, 20)
    frame -= Pos(13.5, 0, 160) * Box(33, 20.1, 80)  # the guide of the ram, open to the front
    frame -= Pos(-12, 0, 160) * Cylinder(15, 20.1, rotation=(90, 0, 0))
    frame -= Pos(-12, -20, 160) * Cylinder(10, 20, rotation=(90, 0, 0))
    frame -= Pos(-12, 20, 160) * Cylinder(15, 20, rotation=(90, 0, 0))
    screws = [(y, z) for y in (-20, 20) for z in (130, 190)]
    for y, z in screws:
        frame -= Pos(22, y, z) * Cylinder(2.5, 16, rotation=(0, 90, 0))
    d.add("frame", holed(frame, [(x, y, 5.5) for x in (-55, 95) for y in (-40, 40)], 20, -20))
    cover = Pos(35, 0, 160) * Box(10, 60, 80)
    for k, (y, z) in enumerate(screws):
        cover -= Pos(35, y, z) * Cylinder(3.3, 10, rotation=(0, 90, 0))
        d.add(f"cover screw {k + 1}", SocketHeadCapScrew("M6-1", length=20), (40, y, z), X)
    d.add("cover", cover)
    # the rack's pitch line is 12 mm from the pinion's axis, its teeth point to it
    rack = RackGear(2, 22, 20, 20, base_height=10)
    box = rack.bounding_box()
    middle = (box.min + box.max) * 0.5
    rack = Rot(0, -90, 0) * Pos(-middle.X, -middle.Y, 0) * rack
    depth = 29.9 - rack.bounding_box().max.X
    ram = rack + Pos(29.9 - depth / 2, 0, 0) * Box(depth, 20, box.size.X)
    d.add("ram", ram, (0, 0, 160 - 2 * 2 * np.pi))
    gear = Pos(0, 0, 10) * SpurGear(2, 12, 20, 19) + Pos(0, 0, -30) * rod(8, 73) + Pos(0, 0, -45) * rod(13, 15)
    gear -= Pos(0, 0, 40.95) * RetainingRingGroove(ExternalSnapRing("16"))
    gear -= Pos(0, 0, -37.5) * Rot(0, 0, -float(np.degrees(np.arctan2(4, 3)))) * Rot(0, 90, 0) * Cylinder(5, 40)
    gear -= Pos(0, 0, -45) * rod(2.1, 5)
    d.add("pinion", gear, (-12, -10, 160), Y, X)
    d.add("left bush", ring(10, 8.03, 20), (-12, -30, 160), Y)
    d.add("right bush", ring(15, 8.03, 20), (-12, 10, 160), Y)
    d.add("pinion shim", ring(12, 8.1, 10), (-12, -40, 160), Y)
    d.add("shaft circlip", ExternalSnapRing("16"), (-12, 31, 160), Y)
    d.add("handle", Pos(0, 0, -110) * rod(5, 220), (-12, -47.5, 160), (0.6, 0, 0.8))
    d.add("handle set screw", SetScrew("M5-0.8", length=6), (-12, -58.5, 160), (0, -1, 0))
    for name, sign in (("upper", 1), ("lower", -1)):
        along = (0.6 * sign, 0, 0.8 * sign)
        knob = holed(rod(9, 20), [(0, 0, 5)], 14)
        d.add(f"{name} knob", knob, np.array([-12, -47.5, 160]) + 96 * np.array(along), along)
        d.weld("handle", f"{name} knob")
    d.weld("frame", "cover", "left bush", "right bush")
    d.weld("pinion", "handle")
    d.label("Revolute", "frame", "pinion", (-12, 0, 160), Y)
    d.label("Prismatic", "frame", "ram", (20, 0, 160))
    return d
