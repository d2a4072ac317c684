"""Linkages of plates on shoulder screws, bolts and rivets."""

from __future__ import annotations

import numpy as np
from bd_warehouse.fastener import (
    CounterSunkScrew,
    DomedCapNut,
    HexHeadScrew,
    HexNut,
    HexNutWithFlange,
    PlainWasher,
    ShoulderScrew,
)
from build123d import Align, Box, Cone, Cylinder, Pos, Rot
from kit import DOWN, Drawing, Solid, Y, Z, bar, holed, meet, rod, towards


def shoulder_fourbar() -> Drawing:
    """Draw a four-bar linkage of plates: three shoulder screws and a bolt, with washers between what turns."""
    d = Drawing("shoulder_fourbar", ["base"], 1)
    a, b, c = 30.0, 100.0, 80.0
    crank, ground = (0.0, 0.0), (120.0, 10.0)
    p = (a * np.cos(1.1), a * np.sin(1.1))
    q = meet(p, ground, b, c)
    base = Pos(60, 0, -18) * Box(190, 80, 12)
    for x, y in (crank, ground):
        base = base + Pos(x, y, -6) * Cylinder(12, 12)
    base = holed(base, [(*crank, 3), (*ground, 3)], 24, -24)
    d.add("base", holed(base, [(x, y, 3.3) for x in (-25, 145) for y in (-30, 30)], 12, -24))
    d.add("crank", bar(a, 20, 8, (0, 4.05), (a, 3)), (*crank, 1.8), Z, (*p, 0))
    d.add("coupler", bar(b, 20, 8, (0, 4.05), (b, 4.2)), (*p, 11.6), Z, towards((*p, 0), (*q, 0))[1])
    d.add("rocker", bar(c, 20, 8, (0, 4.05), (c, 4.2)), (*ground, 1.8), Z, towards((*ground, 0), (*q, 0))[1])
    for name, (x, y), z in (("crank pivot", crank, 0.0), ("rocker pivot", ground, 0.0), ("crank pin", p, 9.8)):
        d.add(name, ShoulderScrew("M6-1", length=12), (x, y, z + 12))
        d.add(f"{name} lower washer", PlainWasher("M8", "iso7089"), (x, y, z))
        d.add(f"{name} upper washer", PlainWasher("M8", "iso7089"), (x, y, z + 9.8))
    d.add("crank pin lock nut", HexNut("M6-1", fastener_type="iso4035"), (*p, 1.8), (0, 0, -1))
    d.add("coupler washer", PlainWasher("M8", "iso7089"), (*q, 9.8))
    d.bolt("coupler pivot", "M8-1.25", (*q, 19.6), Z, 17.8)
    d.label("Revolute", "base", "crank", (*crank, 0))
    d.label("Revolute", "crank", "coupler", (*p, 0))
    d.label("Revolute", "coupler", "rocker", (*q, 0))
    d.label("Revolute", "base", "rocker", (*ground, 0))
    d.weld("base", "crank pivot", "rocker pivot")
    d.weld("crank", "crank pin", "crank pin lock nut")
    return d


def rivet(radius: float, grip: float) -> Solid:
    """Draw a rivet along z, its grip between -grip / 2 and grip / 2, with a flat round head at both ends."""
    head = Cylinder(1.8 * radius, 0.6 * radius)
    end = grip / 2 + 0.3 * radius
    return Pos(0, 0, -grip / 2) * rod(radius, grip) + Pos(0, 0, end) * head + Pos(0, 0, -end) * head


def turned(solid: Solid, start: tuple[float, float], end: tuple[float, float]) -> Solid:
    """Turn a solid about z from the x axis to a direction."""
    return Rot(0, 0, float(np.degrees(np.arctan2(end[1] - start[1], end[0] - start[0])))) * solid


def toggle_clamp() -> Drawing:
    """Draw a horizontal toggle clamp of doubled sheets on rivets; a spindle is held on its arm between two nuts."""
    d = Drawing("toggle_clamp", ["base"], 1)
    o, s, e = (0.0, 20.0), (45.0, 20.0), (10.0, 46.0)  # handle on base, arm on base, link on handle
    f = meet(e, s, 42.0, 26.0)
    base = Pos(22.5, -2, 0) * Box(90, 4, 50) + Pos(22.5, 14, 0) * Box(62, 28, 6)
    for x, z in ((x, z) for x in (-14, 59) for z in (-18, 18)):
        base -= Pos(x, -2, z) * Cylinder(2.75, 4, rotation=(90, 0, 0))
    d.add("base", holed(base, [(*o, 3.05), (*s, 3.05)], 6, -3))
    handle = bar(towards((*o, 0), (*e, 0))[0], 16, 3, (0, 3.05))
    grip = Pos(*o) * turned(handle, o, e) + Pos(*e) * turned(bar(90, 16, 3), e, (e[0] - 60, e[1] + 60))
    arm = Pos(*s) * turned(bar(26, 16, 3), s, f) + Pos(*s) * bar(60, 16, 3)
    link = Pos(*e) * turned(bar(42, 14, 3), e, f)
    sheets = {"handle": (grip, (o, e), 3.1), "arm": (arm, (s, f), 3.1), "link": (link, (e, f), 6.2)}
    for name, (sheet, pivots, z) in sheets.items():
        sheet = holed(sheet, [(*pivot, 3.05) for pivot in pivots], 3)
        d.add(f"{name} front", sheet, (0, 0, z))
        d.add(f"{name} back", sheet, (0, 0, -z - 3))
        d.weld(f"{name} front", f"{name} back")
    for name, pivot, length in (("handle", o, 12.3), ("arm", s, 12.3), ("link", e, 18.5), ("knee", f, 18.5)):
        d.add(f"{name} rivet", rivet(3, length), (*pivot, 0))
    d.add("spindle", HexHeadScrew("M6-1", length=50, fastener_type="iso4017"), (100, -8, 0), (0, -1, 0))
    for name, y, along in (("upper", 28.0, Y), ("lower", 12.0, (0, -1, 0))):
        d.add(f"{name} spindle washer", PlainWasher("M6", "iso7093"), (100, y, 0), along)
        d.add(f"{name} spindle nut", HexNutWithFlange("M6-1"), (100, y + 1.8 * along[1], 0), along)
    d.weld("arm front", "spindle")
    d.label("Revolute", "base", "handle front", (*o, 0))
    d.label("Revolute", "base", "arm front", (*s, 0))
    d.label("Revolute", "handle front", "link front", (*e, 0))
    d.label("Revolute", "link front", "arm front", (*f, 0))
    return d


def table_leg() -> Drawing:
    """Draw a folding table leg: a tube in a channel, kept open by a brace of two flat bars that folds at an elbow."""
    d = Drawing("table_leg", ["panel"], 1)
    knee, foot = (0.0, -120.0), (140.0, -20.0)  # where the brace is held: on the leg and on the panel, in x and z
    elbow = meet(knee, foot, 90.0, 85.0)
    d.add("panel", Pos(60, 0, 9) * Box(300, 160, 18))
    channel = Pos(0, 0, -20) * (Box(40, 32, 40) - Pos(0, 0, -1.5) * Box(40, 26, 37))
    channel -= Pos(0, 0, -22) * Cylinder(4.1, 40, rotation=(90, 0, 0))
    bracket = Pos(0, 1.5, -17.5) * Box(24, 3, 35) + Pos(0, 18, -1.5) * Box(24, 30, 3)
    bracket -= Pos(0, 0, foot[1]) * Cylinder(3.3, 10, rotation=(90, 0, 0))
    sink = Pos(0, 0, -3) * Cone(5.0, 2.75, 2.9, align=(Align.CENTER, Align.CENTER, Align.MIN))
    holders = {
        "channel": (channel, 0.0, 0.0, [(-14, 0), (14, 0)]),
        "bracket": (bracket, foot[0], 23.9, [(0, 14), (0, 26)]),
    }
    for name, (holder, x, y, screws) in holders.items():
        for k, (i, j) in enumerate(screws):
            holder = holed(holder, [(i, j, 2.75)], 3, -3) - Pos(i, j, 0) * sink
            d.add(f"{name} screw {k + 1}", CounterSunkScrew("M5-0.8", length=16), (x + i, y + j, -3), DOWN)
        d.add(name, holder, (x, y, 0))
        d.weld("panel", name)
    leg = Pos(0, 0, -135) * (Box(25, 25, 250) - Box(21, 21, 250))
    for z, radius in ((-22, 4.1), (knee[1], 3.3)):
        leg -= Pos(0, 0, z) * Cylinder(radius, 40, rotation=(90, 0, 0))
    d.add("leg", leg)
    d.bolt("leg pivot", "M8-1.25", (0, 16, -22), Y, 32, nut=DomedCapNut, length=45)
    bars = {"lower brace": (knee, elbow, 17.3), "upper brace": (elbow, foot, 22.1)}
    for name, (start, end, y) in bars.items():
        length, out = towards((start[0], 0, start[1]), (end[0], 0, end[1]))
        d.add(name, bar(length, 20, 3, (0, 3.3), (length, 3.3)), (start[0], y, start[1]), (0, -1, 0), out)
    pivots = {"knee": (knee, 12.5, 17.3, 29.8), "elbow": (elbow, 17.3, 22.1, 7.8), "foot": (foot, 22.1, 26.9, 7.8)}
    for name, ((x, z), gap, top, grip) in pivots.items():
        d.add(f"{name} spacing washer", PlainWasher("M6", "iso7089"), (x, gap, z), Y)
        d.bolt(name, "M6-1", (x, top, z), Y, grip)
    d.label("Revolute", "panel", "leg", (0, 0, -22), Y)
    d.label("Revolute", "leg", "lower brace", (knee[0], 0, knee[1]), Y)
    d.label("Revolute", "lower brace", "upper brace", (elbow[0], 0, elbow[1]), Y)
    d.label("Revolute", "panel", "upper brace", (foot[0], 0, foot[1]), Y)
    return d
