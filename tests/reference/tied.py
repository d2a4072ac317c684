"""Mechanisms whose coordinates are tied: couplings, and the pitch of a screw."""

import jaxkin as jk
from reference.catalogue import GROUND

Z = (0.0, 0.0, 1.0)


def coupled():
    """A differential behind a polynomial: three coordinates in one relation, two in a curved one."""
    names = ("a", "b", "carrier")
    joints = [
        jk.revolute(name, GROUND, f"{name} wheel", point=(0, 0, 10.0 * k), axis=Z) for k, name in enumerate(names)
    ]
    slide = jk.prismatic("slide", GROUND, "bar", axis=(1, 0, 0))
    couplings = [jk.differential("a", "b", "carrier"), jk.polynomial("slide", "a", [0.0, 2.0, 0.5], name="curve")]
    return jk.Mechanism.build(fixed=[GROUND], joints=[*joints, slide], couplings=couplings, unit="mm")


def press():
    """A screw that lifts the end of a rod between balls: a pitch, in inches."""
    return jk.Mechanism.build(
        fixed=[GROUND],
        unit="in",
        joints=[
            jk.screw("spindle", GROUND, "nut", point=(0, 0, 0), axis=Z, pitch=0.5),
            jk.spherical("low", "nut", "rod", point=(1, 0, 0)),
            jk.universal("top", "rod", "slider", point=(1, 1, 3), axis1=(1, 0, 0), axis2=(0, 1, 0)),
            jk.prismatic("rail", "slider", GROUND, axis=(0, 0, 1)),
        ],
    )
