"""Stages that slide: on round rods, in a guide."""

from __future__ import annotations

from bd_warehouse.bearing import SingleRowCappedDeepGrooveBallBearing
from bd_warehouse.fastener import HexNut, LowProfileScrew, SetScrew, SocketHeadCapScrew
from bd_warehouse.open_builds import (
    AcmeAntiBacklashNutBlock8mm,
    AluminumSpacer,
    FlexibleCoupler,
    LockCollar,
    MetricLeadScrew,
    ShimWasher,
    StepperMotor,
    TNut,
    VSlotLinearRail,
    XtremeSolidVWheelAssembly,
)
from bd_warehouse.retaining_ring import InternalSnapRing, RetainingRingGroove
from build123d import Box, Cylinder, Plane, Pos
from kit import BACK, DOWN, Drawing, X, Y, Z, holed, ring, rod

CORNERS = [(-1, -1), (-1, 1), (1, -1), (1, 1)]
RODS, HEIGHT = (-35.0, 35.0), 40.0
"""Where the rods of the screw stage run: across, and above its base."""


def screw_stage() -> Drawing:
    """Draw a carriage with bushings on two rods, moved by a lead screw through a nut block, coupled to a stepper."""
    d = Drawing("screw_stage", ["base"], 1)
    feet = [(x, y) for x in (5, 215) for y in (-45, 45)]
    base = holed(Pos(110, 0, -5) * Box(240, 120, 10), [(x, y, 2.75) for x, y in feet], 10, -10)
    d.add("base", holed(base, [(x, y, 4.75) for x, y in feet], 5.5, -10))
    for k, (x, y) in enumerate(feet):
        d.add(f"foot screw {k + 1}", SocketHeadCapScrew("M5-0.8", length=15), (x, y, -4.5), DOWN)
    for name, x, along in (("motor end", 10.0, BACK), ("far end", 210.0, X)):
        plate = holed(Pos(0, 0, 5) * Box(80, 120, 10), [(0, y, 4) for y in RODS] + [(0, 0, 5)], 10)
        plate = holed(plate, [(0, 0, 8)], 5)
        if name == "motor end":
            plate = holed(plate, [(28 * i, 28 * j, 2.1) for i, j in CORNERS], 10)
        d.add(name, plate, (x, 0, HEIGHT), along, Z)
        d.add(f"{name} bearing", SingleRowCappedDeepGrooveBallBearing("M8-16-5"), (x, 0, HEIGHT), along)
        inwards = (-along[0], 0, 0)
        d.add(f"{name} shim", ShimWasher("12x8x1"), (x, 0, HEIGHT), inwards)
        d.add(f"{name} collar", LockCollar("8mm"), (x + inwards[0], 0, HEIGHT), inwards)
        d.weld("base", name)
    for k, y in enumerate(RODS):
        d.add(f"rod {k + 1}", rod(4, 220), (0, y, HEIGHT), X)
        d.weld("base", f"rod {k + 1}")
    add_carriage(d)
    add_motor(d)
    d.add("lead screw", MetricLeadScrew(234), (-17, 0, HEIGHT), X)
    d.weld("lead screw", "coupler")
    d.label("Prismatic", "base", "carriage", (0, 0, HEIGHT), X)
    d.label("Revolute", "base", "lead screw", (0, 0, HEIGHT), X)
    return d


def add_carriage(d: Drawing) -> None:
    """Add the carriage of the screw stage: a bushing and a circlip in each end of its bores, a nut block below."""
    block = Pos(100, 0, HEIGHT) * Box(60, 100, 30) - Pos(100, 0, HEIGHT - 4.5) * Box(60, 40, 21)
    across = [Pos(100, y, HEIGHT) * Cylinder(7.5, 60, rotation=(0, 90, 0)) for y in RODS]
    screws = [(106.5, -10, 2.75), (106.5, 10, 2.75)]
    block = holed(block - across, screws, 20, HEIGHT)
    circlip, names = InternalSnapRing("15"), []
    for y in RODS:
        for x, along in ((70.0, X), (130.0, BACK)):
            seat = (x + 1.5 * along[0], y, HEIGHT)
            block -= Plane(origin=seat, z_dir=along).location * RetainingRingGroove(circlip)
            names.append(f"bushing {len(names) + 1}")
            d.add(names[-1], ring(7.5, 4.025, 24), (x + 2.6 * along[0], y, HEIGHT), along)
            d.add(f"circlip of {names[-1]}", InternalSnapRing("15"), seat, along)
    d.add("carriage", block)
    d.add("nut block", AcmeAntiBacklashNutBlock8mm(), (100, 0, HEIGHT), Z, Y)
    for k, (x, y, _) in enumerate(screws):
        d.add(f"nut block screw {k + 1}", SocketHeadCapScrew("M5-0.8", length=20), (x, y, HEIGHT + 15))
        d.add(f"nut block nut {k + 1}", HexNut("M5-0.8"), (x, y, HEIGHT - 1), DOWN, X)
    d.weld("carriage", "nut block", *names)


def add_motor(d: Drawing) -> None:
    """Add a stepper on a plate that stands off the end of the screw stage, and its coupler."""
    d.add("motor", StepperMotor("Nema17"), (-45, 0, HEIGHT), X)
    plate = holed(Pos(0, 0, 2.5) * Box(76, 76, 5), [(0, 0, 11.1)], 5)
    plate = holed(plate, [(15.5 * i, 15.5 * j, 1.7) for i, j in CORNERS], 5)
    d.add("motor plate", holed(plate, [(28 * i, 28 * j, 2.75) for i, j in CORNERS], 5), (-45, 0, HEIGHT), X)
    for k, (i, j) in enumerate(CORNERS):
        at = (-40, 15.5 * i, HEIGHT + 15.5 * j)
        d.add(f"motor screw {k + 1}", SocketHeadCapScrew("M3-0.5", length=10), at, X)
        d.add(f"standoff {k + 1}", AluminumSpacer("40mm"), (-40, 28 * i, HEIGHT + 28 * j), X)
        d.add(f"standoff screw {k + 1}", SocketHeadCapScrew("M5-0.8", length=55), (-45, 28 * i, HEIGHT + 28 * j), BACK)
    d.add("coupler", FlexibleCoupler("8mm"), (-30, 0, HEIGHT), X)
    d.weld("base", "motor plate")


def v_slot_gantry() -> Drawing:
    """Draw a plate on four wheels, two of them on eccentric spacers, along a rail with a motor and its pulley."""
    d = Drawing("v_slot_gantry", ["rail"], 2)
    d.add("rail", Pos(0, 0, -150) * VSlotLinearRail("20x40", 300), (0, 0, 0), X, Z)
    reach, turn = 30.32, 0.79  # from the axis of the rail to that of a wheel, and of a spacer from its bore
    plate = Pos(0, 0, 15.5) * Box(100, 100, 6)
    for k, (i, j) in enumerate(CORNERS):
        d.add(f"wheel {k + 1}", XtremeSolidVWheelAssembly(j < 0), (30 * i, reach * j, 0), Z, X)
        plate = holed(plate, [(30 * i, reach * j - turn * (j < 0), 3.57 if j < 0 else 2.55)], 6, 12.5)
        plate = holed(plate, [(30 * i, reach * j, 4.9)], 1.55, 16.95)
    d.add("gantry plate", plate)
    screws = [(x, y) for x in (-140, -120) for y in (-10, 10)]
    mount = holed(Pos(-160, 0, -13) * Box(100, 50, 6), [(*each, 2.75) for each in screws] + [(-180, 0, 11.1)], 6, -16)
    corners = [(-180 + 15.5 * i, 15.5 * j) for i, j in CORNERS]
    d.add("motor plate", holed(mount, [(*each, 1.7) for each in corners], 6, -16))
    for k, (x, y) in enumerate(screws):
        d.add(f"plate screw {k + 1}", LowProfileScrew("M5-0.8", length=10), (x, y, -16), DOWN)
        d.add(f"plate nut {k + 1}", TNut(), (x, y, -10), DOWN, X)
    d.add("motor", StepperMotor("Nema17"), (-180, 0, -16))
    for k, each in enumerate(corners):
        d.add(f"motor screw {k + 1}", SocketHeadCapScrew("M3-0.5", length=10), (*each, -10))
    pulley = holed(rod(8, 16) - Pos(0, 0, 5) * (rod(8, 10) - rod(6, 10)), [(0, 0, 2.5)], 16)
    pulley -= Pos(4, 0, 2.5) * Cylinder(1.25, 10, rotation=(0, 90, 0))
    d.add("pulley", pulley, (-180, 0, -8))
    d.add("pulley set screw", SetScrew("M3-0.5", length=4), (-180 + 6.3, 0, -5.5), X)
    d.weld("rail", "motor plate", "motor")
    d.label("Prismatic", "rail", "gantry plate", (0, 0, 0), X)
    d.label("Revolute", "rail", "pulley", (-180, 0, 0))
    return d
