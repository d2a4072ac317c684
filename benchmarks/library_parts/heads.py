"""What swivels: a hook block, a pan and tilt head."""

from __future__ import annotations

from bd_warehouse.bearing import (
    SingleRowAngularContactBallBearing,
    SingleRowCappedDeepGrooveBallBearing,
    SingleRowTaperedRollerBearing,
)
from bd_warehouse.fastener import HexHeadScrew, HexNut, PlainWasher, ShoulderScrew, SocketHeadCapScrew
from bd_warehouse.retaining_ring import ExternalSnapRing, RetainingRingGroove
from build123d import Box, Cylinder, Pos, Rot, Torus
from kit import DOWN, Drawing, X, Y, bar, holed, ring, rod

SIDES = ((-1, (0.0, -1.0, 0.0)), (1, Y))


def hook_block() -> Drawing:
    """Draw a hook block: a sheave between two cheeks, a crosshead that tilts in them, a hook that turns in it."""
    d = Drawing("hook_block", ["cheek 2"], 2)
    groove = Torus(37, 6)
    sheave = Pos(0, 0, -12) * holed(rod(36, 24), [(0, 0, 11)], 24)
    d.add("sheave", sheave - groove, (0, 0, 0), Y)
    d.add("bearing sleeve", ring(5.5, 4.05, 10), (0, -5, 0), Y)
    axle = Pos(0, 0, -33) * rod(4, 66)
    for z in (-30.95, 30.05):
        axle -= Pos(0, 0, z) * RetainingRingGroove(ExternalSnapRing("8"))
    d.add("axle", axle, (0, 0, 0), Y)
    crosshead = Box(44, 43, 24) + Cylinder(8, 67, rotation=(90, 0, 0)) - Cylinder(7.6, 24)
    for name, (side, along) in enumerate(SIDES, 1):
        y = 22.0 * side
        cheek = bar(100, 80, 8, (0, 4), (100, 8.05))
        cheek = holed(cheek, [(50, 32, 4.2), (50, -32, 4.2)], 8)
        d.add(f"cheek {name}", cheek, (0, y, 0), along, DOWN)
        d.add(f"sheave bearing {name}", SingleRowCappedDeepGrooveBallBearing("M8-22-7"), (0, 5 * side, 0), along)
        d.add(f"sheave spacer {name}", ring(5.5, 4.05, 10), (0, 12 * side, 0), along)
        d.add(f"axle circlip {name}", ExternalSnapRing("8"), (0, 30.1 * side, 0), along)
        trunnion = Rot(-90 * side, 0, 0) * Pos(0, 0, 30.2) * RetainingRingGroove(ExternalSnapRing("16"))
        crosshead -= trunnion
        d.add(f"crosshead circlip {name}", ExternalSnapRing("16"), (0, 30.25 * side, -100), along)
        d.add(f"stay {name}", ring(8, 4.1, 44), (32 * side, -22, -50), Y)
        d.bolt(f"stay {name}", "M8-1.25", (32 * side, 30, -50), Y, 60)
    crosshead -= Pos(0, 0, 10.5) * Cylinder(17.5, 3)  # the cage of the thrust bearing passes its outer ring
    d.add("crosshead", crosshead, (0, 0, -100))
    d.add("thrust bearing", SingleRowTaperedRollerBearing("M15-42-14.25"), (0, 0, -88))
    hook = Pos(0, 0, -130) * rod(7.5, 66) + Pos(0, 0, -152) * Torus(25, 7.5, rotation=(90, 0, 0))
    hook -= Pos(0, 0, -88 + 14.2) * RetainingRingGroove(ExternalSnapRing("15"))
    d.add("hook", hook)
    d.add("hook circlip", ExternalSnapRing("15"), (0, 0, -88 + 14.25))
    d.weld("cheek 2", "cheek 1")
    d.label("Revolute", "cheek 2", "sheave", (0, 0, 0), Y)
    d.label("Revolute", "cheek 2", "crosshead", (0, 0, -100), Y)
    d.label("Revolute", "crosshead", "hook")
    return d


def pan_tilt() -> Drawing:
    """Draw a pan and tilt head: a shaft in a pair of angular-contact bearings, a cradle on two shoulder screws."""
    d = Drawing("pan_tilt", ["base"], 2)
    base = holed(Pos(0, 0, 4) * Box(90, 90, 8) + rod(24, 32), [(0, 0, 12)], 32)
    base = holed(base, [(0, 0, 16)], 21, 11)
    d.add("base", holed(base, [(x, y, 3.3) for x in (-37, 37) for y in (-37, 37)], 8))
    d.add("lower bearing", SingleRowAngularContactBallBearing("M12-32-10"), (0, 0, 11))
    d.add("upper bearing", SingleRowAngularContactBallBearing("M12-32-10"), (0, 0, 32), DOWN)
    d.add("inner sleeve", ring(8, 6.05, 1), (0, 0, 21))
    table = Pos(0, 0, 36) * Pos(0, 0, 3) * Box(120, 60, 6) + Pos(0, 0, 32) * rod(8, 4) + Pos(0, 0, 11) * rod(6, 21)
    table = holed(table, [(0, 0, 2.5)], 20, 11)
    feet = [(x, y) for x in (-55, 55) for y in (-15, 15)]
    d.add("table", holed(table, [(*each, 2.75) for each in feet], 6, 36))
    d.add("pan washer", PlainWasher("M5", "iso7093"), (0, 0, 11), DOWN)
    thickness = PlainWasher("M5", "iso7093").bounding_box().size.Z
    d.add("pan screw", HexHeadScrew("M5-0.8", length=20, fastener_type="iso4017"), (0, 0, 11 - thickness), DOWN)
    for k, (x, y) in enumerate(feet):
        d.add(f"upright screw {k + 1}", SocketHeadCapScrew("M5-0.8", length=20), (x, y, 36), DOWN)
    cradle = Pos(0, 0, 80) * Box(70, 40, 8)
    for side in (-1, 1):
        cradle = cradle + Pos(31 * side, 0, 92) * Box(8, 40, 32)
        cradle -= Pos(31 * side, 0, 100) * Cylinder(3, 8, rotation=(0, 90, 0))
    d.add("cradle", holed(cradle, [(0, y, 3.2) for y in (-12, 12)], 8, 76))
    for name, side in (("left", -1), ("right", 1)):
        upright = Pos(0, 0, 37) * Box(10, 50, 74) - Pos(0, 0, 58) * Cylinder(8, 10, rotation=(0, 90, 0))
        upright = holed(upright, [(0, y, 2.1) for y in (-15, 15)], 16)
        out = (float(side), 0.0, 0.0)
        d.add(f"{name} upright", upright, (55 * side, 0, 42))
        bearing = SingleRowCappedDeepGrooveBallBearing("M8-16-5")
        d.add(f"{name} bearing", bearing, (50 * side, 0, 100), out)
        # the shoulder ends on the cradle's cheek, a sleeve keeps the inner ring away from it
        d.add(f"{name} sleeve", ring(5, 4.05, 15), (35 * side, 0, 100), out)
        d.add(f"{name} pivot", ShoulderScrew("M6-1", length=20), (55 * side, 0, 100), out)
        d.weld("table", f"{name} upright")
        d.weld("cradle", f"{name} pivot")
    d.add("camera screw", HexHeadScrew("M6-1", length=20, fastener_type="iso4017"), (0, -12, 76), DOWN)
    d.add("camera nut", HexNut("M6-1"), (0, -12, 84))
    d.label("Revolute", "base", "table")
    d.label("Revolute", "table", "cradle", (0, 0, 100), X)
    return d
