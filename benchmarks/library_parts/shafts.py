"""Machines of shafts in bearings: a compressor, a universal joint."""

from __future__ import annotations

import numpy as np
from bd_warehouse.bearing import (
    SingleRowCappedDeepGrooveBallBearing,
    SingleRowCylindricalRollerBearing,
    SingleRowDeepGrooveBallBearing,
)
from bd_warehouse.fastener import PlainWasher, ShoulderScrew, SocketHeadCapScrew
from bd_warehouse.retaining_ring import ExternalSnapRing, InternalSnapRing, RetainingRingGroove
from bd_warehouse.shaft_key import Keyway, ShaftKey
from build123d import Box, Cylinder, Pos, Rot, extrude
from kit import BACK, DOWN, Drawing, Solid, X, Z, bar, holed, ring, rod, towards


def compressor() -> Drawing:
    """Draw a piston compressor: a shaft in roller bearings, a keyed crank, a connecting rod on a ball bearing and a
    bush, and a piston whose pin is held by circlips."""
    d = Drawing("compressor", ["base"], 1)
    feet = [(x, z) for z in (7.5, 67.5) for x in (-25, 25)] + [(x, z) for x in (95, 155) for z in (-50, -22)]
    base = Pos(62.5, -55, 10) * Box(215, 10, 150)
    for k, (x, z) in enumerate(feet):
        base -= Pos(x, -55, z) * Cylinder(3.3, 10, rotation=(90, 0, 0))
        d.add(f"foot screw {k + 1}", SocketHeadCapScrew("M6-1", length=25), (x, -60, z), (0, -1, 0))
    d.add("base", base)
    seat = InternalSnapRing("35")
    block = Pos(0, -10, 7.5) * Box(70, 80, 15)
    block = holed(holed(block, [(0, 0, 15)], 15), [(0, 0, 17.5)], 13.5) - Pos(0, 0, 0.9) * RetainingRingGroove(seat)
    for x in (-25, 25):
        block -= Pos(x, -42, 7.5) * Cylinder(2.5, 16, rotation=(90, 0, 0))
    shaft, collar = rod(7.5, 115), ExternalSnapRing("15")
    for z in (4.0 - 0.1, 48.5, 95.5 - 0.1):
        shaft -= Pos(0, 0, z) * RetainingRingGroove(collar)
    key = ShaftKey(15, 12, "B")
    d.add("shaft", shaft - Pos(0, 0, 11) * Keyway(key, "shaft"), (0, 0, -35))
    for k, (z, along) in enumerate(((0.0, Z), (75.0, DOWN))):
        d.add(f"bearing block {k + 1}", block, (0, 0, z), along, (along[2], 0, 0))
        d.add(
            f"roller bearing {k + 1}", SingleRowCylindricalRollerBearing("M15-35-11"), (0, 0, z + 2.5 * along[2]), along
        )
        d.add(f"housing circlip {k + 1}", InternalSnapRing("35"), (0, 0, z + 0.95 * along[2]), along)
        d.add(f"shaft circlip {k + 1}", ExternalSnapRing("15"), (0, 0, z + 13.5 * along[2]), along)
        d.weld("base", f"bearing block {k + 1}")
    pin = 25 * np.array([np.cos(0.9), np.sin(0.9)])
    crank = holed(rod(35, 12), [(0, 0, 7.5), (*pin, 2.5)], 12) - extrude(Keyway(key, "hub").broach_profile(), amount=12)
    d.add("crank", crank, (0, 0, -30))
    d.add("key", key, (4.5, 0, -24), X, Z)
    d.add("crank circlip", ExternalSnapRing("15"), (0, 0, -31))
    d.add("crank spacer", ring(10, 7.55, 20.5), (0, 0, -18))
    d.weld("shaft", "crank", "key")
    add_piston(d, pin)
    d.label("Revolute", "base", "shaft")
    return d


def add_piston(d: Drawing, pin: np.ndarray) -> None:
    """Add to the compressor what its crank pin moves, and the cylinder."""
    d.add("crank pin", ShoulderScrew("M6-1", length=12), (*pin, -42), DOWN)
    for k, z in enumerate((-30.0, -38.8)):
        d.add(f"crank pin washer {k + 1}", PlainWasher("M8", "iso7089"), (*pin, z), DOWN)
    d.add("big end bearing", SingleRowCappedDeepGrooveBallBearing("M8-22-7"), (*pin, -38.8))
    rod_length, middle = 90.0, -35.3
    small = (pin[0] + (rod_length**2 - pin[1] ** 2) ** 0.5, 0.0)
    shape = holed(bar(rod_length, 16, 7) + rod(15, 7), [(0, 0, 11), (rod_length, 0, 6)], 7)
    d.add("connecting rod", shape, (*pin, -38.8), Z, towards((*pin, 0), (*small, 0))[1])
    d.add("bush", ring(6, 4.02, 7), (*small, -38.8))
    circlip = InternalSnapRing("8")
    piston = Pos(4, 0, 0) * Cylinder(15, 36, rotation=(0, 90, 0)) - Pos(-4, 0, 0) * Box(30, 25, 8)
    piston = holed(piston, [(0, 0, 4)], 40, -20)
    for name, along in (("upper", Z), ("lower", DOWN)):
        d.add(f"{name} pin circlip", InternalSnapRing("8"), (*small, middle + 12 * along[2]), along)
        piston -= (Pos(0, 0, 12) if along is Z else Pos(0, 0, -12) * Rot(180, 0, 0)) * RetainingRingGroove(circlip)
    d.add("piston", piston, (*small, middle))
    d.add("piston pin", rod(4, 24), (*small, middle - 12))
    cylinder = Pos(125, -14, middle) * Box(80, 72, 44) - Pos(125, 0, middle) * Cylinder(15.05, 80, rotation=(0, 90, 0))
    for x, z in ((x, z) for x in (95, 155) for z in (-50, -22)):
        cylinder -= Pos(x, -42, z) * Cylinder(2.5, 16, rotation=(90, 0, 0))
    d.add("cylinder", cylinder)
    d.weld("base", "cylinder")
    d.label("Revolute", "crank", "connecting rod", (*pin, 0))
    d.label("Revolute", "connecting rod", "piston", (*small, 0))
    d.label("Prismatic", "base", "piston", (*small, middle), X)


def yoke(reach: float) -> Solid:
    """Draw a yoke whose shaft points along -x, with bores for cups along y and grooves for their circlips."""
    shaft = rod(5, reach - 20) + Pos(0, 0, 12) * rod(6.5, reach - 36)  # a shoulder for the ring of its bearing
    shape = Pos(-reach, 0, 0) * Rot(0, 90, 0) * shaft + Pos(-24, 0, 0) * Box(8, 40, 18.4)
    for side in (-1, 1):
        arm = Pos(-10, 15 * side, 0) * Box(20, 10, 18.4) + Pos(0, 15 * side, 0) * Cylinder(9.2, 10, rotation=(90, 0, 0))
        arm -= Pos(0, 15 * side, 0) * Cylinder(7, 10, rotation=(90, 0, 0))
        shape = shape + arm
        shape -= Pos(0, 17.5 * side, 0) * Rot(-90 * side, 0, 0) * RetainingRingGroove(InternalSnapRing("14"))
    groove = RetainingRingGroove(ExternalSnapRing("10"))
    return shape - Pos(-reach + 3, 0, 0) * Rot(0, 90, 0) * groove


def cardan() -> Drawing:
    """Draw two shafts at an angle that a universal joint couples: cups and circlips around the ends of its cross."""
    d = Drawing("cardan", ["base"], 1)
    bend = np.radians(25.0)
    directions = (BACK, (float(np.cos(bend)), float(np.sin(bend)), 0.0))
    trunnions = (Z, (-float(np.sin(bend)), float(np.cos(bend)), 0.0))
    base = Pos(0, 20, -45) * Box(240, 140, 10)
    cross = Box(13, 13, 13) + Cylinder(4, 32.8) + Cylinder(4, 32.8, rotation=(90, 0, 0))
    d.add("cross", cross, (0, 0, 0), Z, directions[1])
    cup = ring(7, 4.02, 6) + Pos(0, 0, 6) * rod(7, 1)
    for name, out, trunnion in zip(("input", "output"), directions, trunnions, strict=True):
        unit, away = np.array(trunnion), np.array(out)
        back = tuple(-away)
        d.add(f"{name} yoke", yoke(90), (0, 0, 0), tuple(np.cross(back, unit)), back)
        for k, side in enumerate((-unit, unit)):
            d.add(f"{name} cup {k + 1}", cup, 10.5 * side, side)
            d.add(f"{name} circlip {k + 1}", InternalSnapRing("14"), 17.5 * side, side)
        block = Pos(7.5, 0, 6) * Box(65, 50, 12) - Pos(0, 0, 6) * Cylinder(9, 12) - Pos(0, 0, 8) * Cylinder(13, 8)
        for j in (-18, 18):
            block -= Pos(32, j, 6) * Cylinder(2.1, 16, rotation=(0, 90, 0))
        d.add(f"{name} block", block, 74 * away, out, DOWN)
        d.add(f"{name} bearing", SingleRowDeepGrooveBallBearing("M10-26-8"), 78 * away, out)
        d.add(f"{name} shaft circlip", ExternalSnapRing("10"), 86 * away, out)
        across = np.cross(out, DOWN)
        for k, j in enumerate((-18, 18)):
            at = 80 * away + j * across + [0, 0, -50]
            base = holed(base, [(at[0], at[1], 2.75)], 10, -50)
            d.add(f"{name} block screw {k + 1}", SocketHeadCapScrew("M5-0.8", length=25), at, DOWN)
        d.weld("base", f"{name} block")
        d.label("Revolute", "base", f"{name} yoke", (0, 0, 0), out)
        d.label("Revolute", f"{name} yoke", "cross", (0, 0, 0), trunnion)
    d.add("base", base)
    return d
