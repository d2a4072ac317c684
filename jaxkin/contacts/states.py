"""The sixteen contact states of the paper as a table: Fig. 1, Table 1 (frames) and Table 2 (movements) side by side.

Table 2 is printed with errors in (j), (l) and (n); the movements here are the corrected ones. Two states have a second
form, which the paper does not have, with contact on a circle: a ball that fills its bore (j), and a ball seated in a
cone (n). The order of the states of two kinds of surface is that in which they are tried: a fit, such as a pin that
fills its hole, comes before the contact on a line or at a point of the same surfaces with more clearance.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

from jaxkin.contacts import rulings, separation, touch

RegionKind = Literal["surface", "line", "point", "circle"]

OUTSIDE = ((1, 1),)
"""Sides of two bodies next to each other: the material is inside of both surfaces (see `ContactState.sides`)."""
INSIDE = ((1, -1), (-1, 1))
"""Sides of a body in the hollow of another one, either of them first."""
HOLLOW_1 = ((-1, 1),)
"""Sides of body 2 in the hollow of body 1."""


@dataclass(frozen=True)
class ContactState:
    """One row of Tables 1 and 2."""

    letter: str
    """Letter of the state in the paper, "a" to "p"."""
    name: str
    """The state in words: surface 2, how it lies, surface 1."""
    kinds: tuple[str, str]
    """Kinds of surface 1 and surface 2, in the order plane, cylinder, cone, sphere."""
    sides: tuple[tuple[int, int], ...]
    """Sides (of surface 1, of surface 2) that the state allows: +1 material inside (pin, ball, also plane), -1 outside
    (hole, socket)."""
    region: RegionKind
    """What the surfaces have in common where they touch."""
    frames: tuple[tuple[str, str], ...]
    """Table 1: for each frame what z is parallel to and what the origin lies on, in symbols of the paper: surface f,
    its normal n, axis a, centre c, apex v, with 1 or 2; common normal m, line l, point p of contact."""
    movements: tuple[str, ...]
    """Table 2, corrected: the movement of each frame, a key of `jaxkin.geometry.movements.MOVEMENTS`."""
    freedoms: int
    """Number of freedoms of surface 2 relative to surface 1."""
    touch: Callable[..., touch.Touch | None]
    """Function (surface 1, surface 2, a point near the contact) that finds where the unbounded surfaces touch, and by
    how much they miss; see `touch.py`."""
    gaps: Callable[..., separation.Gaps] | None = None
    """Function (face 1, face 2, displacements) that measures how far the faces are apart on surfaces that still touch;
    see `separation.py`. None where the surfaces only turn on each other, about one axis or centre: (k), (o), (n) on a
    circle; and where no such function exists: (i), (l), (m), (p)."""
    lengths: tuple[str | None, ...] = ()
    """Name of the length between each two successive frames of the chain, or None where it cannot be changed: it
    depends on the half-angle of a cone, which the frames do not hold."""

    @property
    def is_flat(self) -> bool:
        """Whether the state is a plane on a plane: (a)."""
        return self.kinds == ("plane", "plane")

    @property
    def is_fit(self) -> bool:
        """Whether the state is a fit, a curved surface that fills another one: (e), (k), (o)."""
        return self.region == "surface" and not self.is_flat

    @property
    def is_pin(self) -> bool:
        """Whether the state is a pin that fills its hole: (e)."""
        return self.is_fit and self.kinds == ("cylinder", "cylinder")


# fmt: off
CONTACT_STATES: tuple[ContactState, ...] = (
    ContactState("a", "plane on plane", ("plane", "plane"), OUTSIDE, "surface",
                 (("n1", "f1"),), ("T_xy_phi",), 3, touch.plane_plane, separation.on_plane),
    ContactState("b", "cylinder on plane", ("plane", "cylinder"), OUTSIDE, "line",
                 (("n1", "f1"), ("a2", "a2")), ("T_xy_phi", "T_phi"), 4, touch.plane_cylinder, separation.on_plane,
                 lengths=("radius",)),
    ContactState("c", "cone on plane", ("plane", "cone"), OUTSIDE, "line",
                 (("n1", "f1"), ("a2", "a2")), ("T_xy_phi", "T_phi"), 4, rulings.plane_cone, separation.on_plane),
    ContactState("d", "ball on plane", ("plane", "sphere"), OUTSIDE, "point",
                 (("n1", "f1"), ("n1", "c2")), ("T_xy_phi", "T_theta_phi"), 5, touch.plane_sphere, separation.on_plane,
                 lengths=("radius",)),
    ContactState("e", "cylinder in cylinder", ("cylinder", "cylinder"), INSIDE, "surface",
                 (("a1", "a1"),), ("T_z_phi",), 2, touch.cylinder_in_cylinder, separation.along_axis),
    ContactState("f", "cylinder along cylinder", ("cylinder", "cylinder"), OUTSIDE + INSIDE, "line",
                 (("a1", "a1"), ("a2", "a2")), ("T_z_phi", "T_phi"), 3,
                 touch.cylinder_along_cylinder, separation.along_axis,
                 lengths=("distance",)),
    ContactState("g", "cylinder across cylinder", ("cylinder", "cylinder"), OUTSIDE, "point",
                 (("a1", "a1"), ("m", "p"), ("a2", "a2")), ("T_phi", "T_xy_phi", "T_phi"), 5,
                 touch.cylinder_across_cylinder, separation.across,
                 lengths=("radius 1", "radius 2")),
    ContactState("h", "cone along cylinder", ("cylinder", "cone"), OUTSIDE + INSIDE, "line",
                 (("a1", "a1"), ("a2", "a2")), ("T_z_phi", "T_phi"), 3,
                 rulings.cylinder_along_cone, separation.along_axis),
    ContactState("i", "cone across cylinder", ("cylinder", "cone"), OUTSIDE, "point",
                 (("a1", "a1"), ("m", "p"), ("a2", "a2")), ("T_phi", "T_xy_phi", "T_phi"), 5,
                 rulings.cylinder_across_cone,
                 lengths=("radius 1", None)),
    ContactState("j", "ball filling its bore", ("cylinder", "sphere"), HOLLOW_1, "circle",
                 (("a1", "a1"), ("a1", "c2")), ("T_z", "T_theta_phi_psi"), 4,
                 touch.sphere_in_bore, separation.along_axis),
    ContactState("j", "ball on cylinder", ("cylinder", "sphere"), OUTSIDE + HOLLOW_1, "point",
                 (("a1", "a1"), ("a1", "c2")), ("T_z_phi", "T_theta_phi_psi"), 5,
                 touch.cylinder_sphere, separation.along_axis,
                 lengths=("distance",)),
    ContactState("k", "cone in cone", ("cone", "cone"), INSIDE, "surface",
                 (("a1", "a1"),), ("T_phi",), 1, rulings.cone_in_cone),
    ContactState("l", "cone along cone", ("cone", "cone"), OUTSIDE + INSIDE, "line",
                 (("a1", "a1"), ("l", "l"), ("a2", "a2")), ("T_phi", "T_z", "T_phi"), 3, rulings.cone_along_cone),
    ContactState("m", "cone across cone", ("cone", "cone"), OUTSIDE, "point",
                 (("a1", "a1"), ("m", "p"), ("a2", "a2")), ("T_phi", "T_xy_phi", "T_phi"), 5,
                 rulings.cone_across_cone),
    ContactState("n", "ball seated in cone", ("cone", "sphere"), HOLLOW_1, "circle",
                 (("a1", "c2"),), ("T_theta_phi_psi",), 3, rulings.sphere_in_seat),
    ContactState("n", "ball on cone", ("cone", "sphere"), OUTSIDE + HOLLOW_1, "point",
                 (("a1", "a1"), ("v1 - p", "p"), ("a1", "c2")), ("T_phi", "T_z", "T_theta_phi_psi"), 5,
                 rulings.cone_sphere, separation.on_ruling,
                 lengths=(None, "radius")),
    ContactState("o", "ball in socket", ("sphere", "sphere"), INSIDE, "surface",
                 (("any", "c1"),), ("T_theta_phi_psi",), 3, touch.sphere_in_sphere),
    ContactState("p", "ball on ball", ("sphere", "sphere"), OUTSIDE + INSIDE, "point",
                 (("m", "c1"), ("m", "c2")), ("T_theta_phi", "T_theta_phi_psi"), 5, touch.sphere_on_sphere,
                 lengths=("distance",)),
)
# fmt: on


def find_state(letter: str, region: str | None = None) -> ContactState:
    """Look up a contact state by its letter; `region="circle"` selects the second forms of (j) and (n).

    Raises ValueError if there is no such state, or if it has no such region.
    """
    rows: dict[str, ContactState] = {state.region: state for state in CONTACT_STATES if state.letter == letter}
    if not rows:
        letters = sorted(state.letter for state in CONTACT_STATES)
        raise ValueError(f"a contact state is a letter from {letters[0]!r} to {letters[-1]!r}, got {letter!r}")
    if region is None:
        return rows.get("point") or next(iter(rows.values()))
    if region not in rows:
        raise ValueError(f"contact state ({letter}) has the region {' or '.join(map(repr, rows))}, got {region!r}")
    return rows[region]
