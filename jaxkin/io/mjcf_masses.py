"""What the bodies of a MuJoCo model weigh: what <inertial> says, or what their solids say."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from xml.etree.ElementTree import Element

import numpy as np

from jaxkin.geometry.inertial import NONE, Inertial
from jaxkin.geometry.pose import Transform
from jaxkin.io.mjcf_shapes import Shapes, group_of
from jaxkin.io.mjcf_text import Compiler
from jaxkin.io.robot_inertials import inertial
from jaxkin.io.robot_model import Weighed, numbers, tag

DENSITY = 1000.0
"""Kilograms per cubic metre of a solid that says neither its mass nor its density."""
WITHOUT_MASS = ("plane", "hfield")
"""Types of solids that are only for collisions."""
OTHERWISE = ("shell", "convex")
"""Entries of `inertia` of a mesh by which MuJoCo weighs something else than what its surface encloses."""


LEAST_MASS, LEAST_INERTIA = 1e-6, 1e-9
"""In kg and kg m^2: what is written as the least of bodies that move, of which MuJoCo asks for some. No force that
anybody computes shows it."""

_SCALED = {"settotalmass": "all masses are scaled to this sum", "boundmass": "no mass is smaller",
           "boundinertia": "no principal inertia is smaller"}  # fmt: skip
"""Settings of the compiler by which bodies weigh what is not written -> what MuJoCo makes of such a number."""
_UNSEEN = {"settotalmass": 0.0, "boundmass": LEAST_MASS, "boundinertia": LEAST_INERTIA}
"""Up to what they change nothing, or nothing that shows."""


def scaled_notes(compiler: Compiler) -> tuple[str, ...]:
    """Write a note for each setting of a compiler that changes masses: they are kept as they are written."""
    return tuple(
        f"{compiler.file}: {key}={compiler.said[key]!r} of its <compiler> is not kept ({meaning} in MuJoCo): masses "
        "are as written"
        for key, meaning in _SCALED.items()
        if float(numbers(compiler.said.get(key), 1, f"{compiler.file}: {key}", (0,))[0]) > _UNSEEN[key]
    )


def body_masses(
    own: Sequence[tuple[Element, Transform, str | None]], shapes: Shapes, where: str, notes: list[str]
) -> Inertial | tuple[Weighed, ...] | None:
    """Read what a body weighs, in its frame: its <inertial>; or the solids that weigh, of which one says how much.

    `own` are its elements with the frames in the body that they are given in, and their classes by default. None where
    it is unknown: where MuJoCo takes the density of water for all, since nothing is said.
    """
    compiler = shapes.compiler
    found = [(each, at) for each, at, _ in own if each.tag == "inertial"]
    if found and compiler.said.get("inertiafromgeom") != "true":
        return _said(*found[-1], shapes, f"{where}: inertial", notes)
    least, most = numbers(compiler.said.get("inertiagrouprange"), 2, f"{compiler.file}: inertiagrouprange", (0, 5))
    solids = [(shapes.defaults.said(each, of), at, tag(each)) for each, at, of in own if each.tag == "geom"]
    solids = [each for each in solids if each[0].get("type") not in WITHOUT_MASS and least <= group_of(each[0]) <= most]
    weighing = [each for each in solids if _said_mass(each[0], f"{where}: {each[-1]}")]
    if not weighing:
        return NONE
    if not any({"mass", "density"} & {*said} for said, *_ in solids):
        return None
    weighed = []
    for said, at, name in weighing:
        shape = shapes.solid(said, f"{where}: {name}")
        of_mesh = shapes.meshes.get(said.get("mesh", ""), {}).get("inertia")
        if shape is None or said.get("shellinertia") == "true" or of_mesh in OTHERWISE:
            notes.append(f"{where}: what its {name} weighs is not computed, so that its mass is unknown")
            return None
        weighed.append(Weighed(replace(shape, pose=at @ shape.pose), _said_mass(said, where), "mass" in said))
    return tuple(weighed)


def _said_mass(said: Mapping[str, str], where: str) -> float:
    """Read the mass of a solid, kilograms, else its density; ValueError for one below zero."""
    key = "mass" if "mass" in said else "density"
    found = float(numbers(said.get(key), 1, f"{where}: {key}", (DENSITY,))[0])
    if found < 0:
        raise ValueError(f"{where}: expected a {key} from 0 on, got {found:g}")
    return found


def _said(found: Element, at: Transform, shapes: Shapes, where: str, notes: list[str]) -> Inertial | None:
    """Read an <inertial> that is given in the frame `at` in the body."""
    mass = float(numbers(found.get("mass"), 1, where)[0])
    if (full := found.get("fullinertia")) is not None:
        six = numbers(full, 6, where)
    else:
        six = np.concatenate([numbers(found.get("diaginertia"), 3, where, (0, 0, 0)), np.zeros(3)])
    return inertial(mass, at @ shapes.compiler.pose(found.attrib, where), six, where, notes)
