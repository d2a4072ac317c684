"""Machines of workshops and their tools: a shaper, a gripper, a castor."""

from __future__ import annotations

import numpy as np
from bd_warehouse.bearing import (
    SingleRowAngularContactBallBearing,
    SingleRowCappedDeepGrooveBallBearing,
    SingleRowDeepGrooveBallBearing,
)
from bd_warehouse.fastener import (
    ButtonHeadScrew,
    HexHeadScrew,
    HexNut,
    PlainWasher,
    SetScrew,
    ShoulderScrew,
    SocketHeadCapScrew,
)
from bd_warehouse.gear import SpurGear
from bd_warehouse.open_builds import AluminumSpacer, ShimWasher, StepperMotor
from bd_warehouse.retaining_ring import ExternalSnapRing, RetainingRingGroove
from build123d import Box, Cylinder, Plane, Pos, Rot
from kit import DOWN, Drawing, X, Y, Z, bar, holed, ring, rod, towards


def quick_return() -> Drawing:
    """Draw a shaper: a crank's roller runs in the slot of a lever, which a link ties to a ram between gibs."""
    d = Drawing("quick_return", ["base"], 1)
    crank, pin = (0.0, 90.0), (24.0, 108.0)
    reach, up = towards((0, 0, 0), (*pin, 0))
    top = (190 * up[0], 190 * up[1])
    ram = (top[0] - (80.0**2 - (240.0 - top[1]) ** 2) ** 0.5, 240.0)
    screws = [(x, y) for x in (-80, 0, 80) for y in (212.5, 267.5)]
    base = Pos(0, 130, -15) * Box(260, 320, 30) + Pos(0, 0, 4.75) * Cylinder(12, 9.5)
    base = holed(base, [(0, 0, 3)], 39.5, -30)
    base = holed(base, [(*crank, 11)] + [(*each, 2.1) for each in screws], 30, -30)
    base = holed(holed(base, [(*crank, 13)], 8, -8), [(*crank, 13)], 8, -30)
    base -= Pos(*crank, -1) * (Cylinder(34, 2) - Cylinder(16, 2))  # the crank pin's thread passes here
    d.add("base", base)
    for name, z in (("upper bearing", -8), ("lower bearing", -30)):
        d.add(name, SingleRowDeepGrooveBallBearing("M10-26-8"), (*crank, z))
    circlip = ExternalSnapRing("10")
    disc = Pos(0, 0, -34) * rod(5, 36) + rod(7, 2) + Pos(0, 0, 2) * rod(40, 8)
    disc -= Pos(0, 0, -31.05) * RetainingRingGroove(circlip)
    d.add("crank", holed(disc, [(pin[0] - crank[0], pin[1] - crank[1], 3)], 8, 2), (*crank, 0))
    d.add("crank circlip", circlip, (*crank, -31))
    d.add("crank pin", ShoulderScrew("M6-1", length=12), (*pin, 22))
    for name, z in (("lower", 10), ("upper", 18.8)):
        d.add(f"{name} roller washer", PlainWasher("M8", "iso7089"), (*pin, z))
    d.add("roller", SingleRowCappedDeepGrooveBallBearing("M8-22-7"), (*pin, 11.8))
    slot = Pos(reach - 42, 0, 0) * bar(84, 22.1, 8)
    lever = holed(bar(190, 24, 8) + Pos(reach - 47, 0, 0) * bar(94, 40, 8), [(0, 0, 4.05), (190, 0, 3)], 8) - slot
    d.add("lever", lever, (0, 0, 11.3), Z, up)
    d.add("link", bar(80, 20, 8, (0, 4.05), (80, 4.05)), (*top, 21.1), Z, towards((*top, 0), (*ram, 0))[1])
    body = Pos(0, 0, 4) * Box(160, 40, 8) + Pos(0, 0, 9.65) * Box(160, 24, 19.3)
    d.add("ram", holed(body, [(0, 0, 3)], 19.3), (*ram, 0))
    for name, (x, y), z in (("lever pivot", (0, 0), 9.5), ("lever pin", top, 19.3), ("ram pin", ram, 19.3)):
        d.add(name, ShoulderScrew("M6-1", length=12), (x, y, z + 12))
        d.add(f"{name} lower washer", PlainWasher("M8", "iso7089"), (x, y, z))
        d.add(f"{name} upper washer", PlainWasher("M8", "iso7089"), (x, y, z + 9.8))
    for name, y, inwards in (("near", 212.5, 1), ("far", 267.5, -1)):
        holes = [(x, 0, 2.75) for x in (-80, 0, 80)]
        d.add(f"{name} gib", holed(Pos(0, 0, 4.1) * Box(240, 14.8, 8.2), holes, 8.2), (0, y, 0))
        keeper = holed(Pos(0, 3 * inwards, 2.5) * Box(240, 21, 5), holes, 5)
        d.add(f"{name} keeper", keeper, (0, y, 8.2))
        d.weld("base", f"{name} gib", f"{name} keeper")
    for k, (x, y) in enumerate(screws):
        d.add(f"gib screw {k + 1}", SocketHeadCapScrew("M5-0.8", length=25), (x, y, 13.2))
    d.label("Revolute", "base", "crank", (*crank, 0))
    d.label("Revolute", "base", "lever")
    d.label("Revolute", "lever", "link", (*top, 0))
    d.label("Revolute", "link", "ram", (*ram, 0))
    d.label("Prismatic", "base", "ram", (*ram, 0), X)
    d.weld("crank", "crank pin")
    return d


def gripper() -> Drawing:
    """Draw a gripper: a stepper turns two gears with an arm on each, and links keep the fingers parallel."""
    d = Drawing("gripper", ["bottom plate"], 1)
    posts, axles = [(-44, -22), (44, -22), (0, 28)], [(15, 0), (-42, -6), (42, -6)]
    plate = Pos(0, 0, 3) * Box(104, 66, 6)
    bolts = [(x, y, 2.7) for x, y in posts + axles]
    bottom = holed(plate, [*bolts, (-15, 0, 11.1)], 6)
    motor_screws = [(-15 + 15.5 * i, 15.5 * j) for i in (-1, 1) for j in (-1, 1)]
    d.add("bottom plate", holed(bottom, [(*each, 1.7) for each in motor_screws], 6))
    d.add("top plate", holed(plate, [*bolts, (-15, 0, 8)], 6), (0, 0, 26))
    d.add("motor", StepperMotor("Nema17"), (-15, 0, 0))
    for k, at in enumerate(motor_screws):
        d.add(f"motor screw {k + 1}", SocketHeadCapScrew("M3-0.5", length=10), (*at, 6))
    for k, (x, y) in enumerate(posts):
        d.add(f"post {k + 1}", AluminumSpacer("20mm"), (x, y, 6))
        d.bolt(f"post {k + 1}", "M5-0.8", (x, y, 32), Z, 32, screw=ButtonHeadScrew)
    d.weld("bottom plate", "top plate", "motor")
    for side, name in ((-1, "driven"), (1, "idle")):
        gear = Pos(0, 0, 4) * SpurGear(1.5, 20, 20, 8) + Pos(0, 0, 8) * rod(6, 6)
        swing = (0.5 * side, 0.75**0.5, 0)
        turn = np.array([swing[:2], (-swing[1], swing[0])])
        drilled = [(*(np.array([8.6, y]) @ turn), 1.25) for y in (-4.0, 4.0)]
        gear = holed(Rot(0, 0, 9 * (side > 0)) * gear, drilled, 8)
        gear = holed(gear, [(0, 0, 2.5 if side < 0 else 2.55)], 14)
        if side < 0:
            gear -= Pos(3, 0, 11) * Cylinder(1.25, 8, rotation=(0, 90, 0))
            d.add("gear set screw", SetScrew("M3-0.5", length=4), (-15 + 6.2, 0, 19), X)
        d.add(f"{name} gear", gear, (15 * side, 0, 8))
        arm = holed(bar(50, 16, 4, (0, 6.1), (50, 2.6)), [(8.6, y, 1.7) for y in (-4, 4)], 4)
        d.add(f"{name} arm", arm, (15 * side, 0, 16), Z, swing)
        for k, (x, y, _) in enumerate(drilled):
            at = (15 * side + x, y, 20)
            d.add(f"{name} arm screw {k + 1}", ButtonHeadScrew("M3-0.5", length=8), at)
        pivots = (np.array([15.0 * side, 0]), np.array([42.0 * side, -6]))
        d.add(f"{name} link", bar(50, 10, 4, (0, 2.6), (50, 2.6)), (*pivots[1], 16), Z, swing)
        ends = [each + 50 * np.array(swing[:2]) for each in pivots]
        span, out = towards((*ends[0], 0), (*ends[1], 0))
        finger = bar(span, 20, 4, (0, 2.6), (span, 2.6))
        d.add(f"{name} finger", finger, (*ends[0], 21), Z, out)
        middle = (ends[0] + ends[1]) / 2
        jaw = holed(Pos(0, 29, 2) * Box(10, 70, 4), [(0, -4, 1.7), (0, 4, 1.7)], 4)
        d.add(f"{name} jaw", jaw, (*middle, 25))
        for k, y in enumerate((-4, 4)):
            d.add(f"{name} jaw screw {k + 1}", ButtonHeadScrew("M3-0.5", length=8), (middle[0], middle[1] + y, 29))
        for what, end in (("arm", ends[0]), ("link", ends[1])):
            d.add(f"{name} {what} shim", ShimWasher("10x5x1"), (*end, 20))
            d.bolt(f"{name} {what} pivot", "M5-0.8", (*end, 25), Z, 9, screw=ButtonHeadScrew)
        d.label("Revolute", "bottom plate", f"{name} gear", (15 * side, 0, 0))
        d.weld(f"{name} gear", f"{name} arm")
        d.weld(f"{name} finger", f"{name} jaw")
        d.label("Revolute", "bottom plate", f"{name} link", (*pivots[1], 0))
        for what, end in (("arm", ends[0]), ("link", ends[1])):
            d.label("Revolute", f"{name} {what}", f"{name} finger", (*end, 0))
    for k, (x, y) in enumerate(axles[1:]):
        d.add(f"link spacer {k + 1}", AluminumSpacer("10mm"), (x, y, 6))
        d.add(f"link upper spacer {k + 1}", AluminumSpacer("6mm"), (x, y, 20))
    for k, z in enumerate((6, 7, 25)):
        d.add(f"gear shim {k + 1}", ShimWasher("10x5x1"), (15, 0, z))
    d.add("gear spacer", AluminumSpacer("3mm"), (15, 0, 22))
    for k, (x, y) in enumerate(axles):
        d.bolt(f"axle {k + 1}", "M5-0.8", (x, y, 32), Z, 32, screw=ButtonHeadScrew)
    return d


def castor() -> Drawing:
    """Draw a castor: its fork swivels in an angular-contact bearing, its wheel runs on two bearings and a bolt."""
    d = Drawing("castor", ["plate"], 2)
    plate = Pos(0, 0, 6) * Box(100, 80, 12) - Pos(0, 0, 4.5) * Cylinder(15, 9)
    d.add("plate", holed(plate, [(0, 0, 10)] + [(x, y, 4.5) for x in (-40, 40) for y in (-30, 30)], 12))
    d.add("swivel bearing", SingleRowAngularContactBallBearing("M10-30-9"))
    d.add("swivel collar", ring(7.5, 5.05, 2), (0, 0, 9))
    d.add("king pin", HexHeadScrew("M10-1.5", length=40), (0, 0, 11))
    d.add("king pin washer", PlainWasher("M10", "iso7089"), (0, 0, -8), DOWN)
    d.add("king pin nut", HexNut("M10-1.5"), (0, 0, -10.2), DOWN)
    axle = np.array([-30.0, 0.0, -70.0])
    fork = Pos(0, 0, -5) * Box(44, 50, 6)
    length, down = towards((0, 0, -8), axle)
    for y in (-21.0, 25.0):
        leg = Plane(origin=(0, y, -8), x_dir=down, z_dir=(0, -1, 0))
        fork = fork + leg.location * bar(length, 30, 4)
    fork -= Pos(0, 0, 6) * Box(90, 60, 16)
    fork = fork + Pos(0, 0, -2) * rod(7.5, 2)
    fork = holed(fork, [(0, 0, 5.25)], 10, -9)
    d.add("fork", fork - Pos(*axle) * Cylinder(4.1, 60, rotation=(90, 0, 0)))
    hub = holed(Pos(0, 0, -16) * rod(18, 32), [(0, 0, 10)], 32, -16)
    hub = holed(holed(hub, [(0, 0, 11)], 7, -16), [(0, 0, 11)], 7, 9)
    d.add("wheel hub", hub, axle, Y)
    d.add("tyre", ring(37.5, 18, 30), axle - [0, 15, 0], Y)
    d.add("inner spacer", ring(6, 4.05, 18), axle - [0, 9, 0], Y)
    for name, side in (("left", Y), ("right", (0, -1, 0))):
        unit = np.array(side)
        d.add(f"{name} wheel bearing", SingleRowCappedDeepGrooveBallBearing("M8-22-7"), axle + 9 * unit, side)
        d.add(f"{name} spacer", ring(5.5, 4.05, 5), axle + 16 * unit, side)
    d.bolt("axle", "M8-1.25", axle + [0, 25, 0], Y, 50)
    d.label("Revolute", "plate", "fork")
    d.label("Revolute", "fork", "wheel hub", axle, Y)
    d.weld("wheel hub", "tyre")
    return d
