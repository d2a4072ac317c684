"""The kinds of joints: lower pairs, other joints by hand and the contact states of the paper."""

from __future__ import annotations

from enum import StrEnum


class JointKind(StrEnum):
    """The kind of a joint; it prints as, and is equal to, its text, such as "revolute" or "contact b"."""

    REVOLUTE = "revolute"
    PRISMATIC = "prismatic"
    CYLINDRICAL = "cylindrical"
    PLANAR = "planar"
    SPHERICAL = "spherical"
    UNIVERSAL = "universal"
    SCREW = "screw"
    FIXED = "fixed"
    FREE = "free"
    RECTANGULAR = "rectangular"
    CARTESIAN = "cartesian"
    SCHOENFLIES = "schoenflies"
    CONSTANT_ANGLE = "constant angle"
    CONSTANT_VELOCITY = "constant velocity"
    PIN_IN_SLOT = "pin in slot"
    POINT_ON_CURVE = "point on curve"
    CAM = "cam"
    CURVE_ON_CURVE = "curve on curve"
    POINT_ON_SURFACE = "point on surface"
    CONTACT_A = "contact a"
    CONTACT_B = "contact b"
    CONTACT_C = "contact c"
    CONTACT_D = "contact d"
    CONTACT_E = "contact e"
    CONTACT_F = "contact f"
    CONTACT_G = "contact g"
    CONTACT_H = "contact h"
    CONTACT_I = "contact i"
    CONTACT_J = "contact j"
    CONTACT_K = "contact k"
    CONTACT_L = "contact l"
    CONTACT_M = "contact m"
    CONTACT_N = "contact n"
    CONTACT_O = "contact o"
    CONTACT_P = "contact p"

    @classmethod
    def of_state(cls, letter: str) -> JointKind:
        """Find the kind of a joint that is one contact state, by the letter of the state in the paper."""
        return cls(f"contact {letter}")
