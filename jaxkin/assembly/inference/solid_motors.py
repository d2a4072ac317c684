"""Motors that are drawn as one solid with their shaft: steppers and servos, known by their sizes, others by names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NamedTuple

from jaxkin.assembly.inference.bores import Bore
from jaxkin.assembly.inference.named_motors import is_named_motor, is_shaft_of_case
from jaxkin.assembly.inference.servos import servo_size
from jaxkin.assembly.inference.steppers import stepper_size
from jaxkin.geometry.part import Part


class SolidMotor(NamedTuple):
    """A motor that is one solid with its shaft."""

    part: str
    shaft: Bore
    told: str
    """What tells that it is a motor, as a clause: its sizes, or its name."""
    named: bool = False
    """Whether nothing but its name tells that."""


def solid_motors(parts: Sequence[Part], bores: Mapping[str, Sequence[Bore]], metre: float = 1e-3) -> list[SolidMotor]:
    """Find the motors among parts, each pin of a part taken for its shaft in turn.

    `bores` are the bores and pins of each part by its name, and `metre` is the unit of lengths in metres.
    """
    result = []
    for part in parts:
        own = bores[part.name]
        pins = [bore for bore in own if not bore.hole]
        for shaft in pins:
            if (size := stepper_size(part, shaft, pins, metre / 1e-3)) is not None:
                result.append(SolidMotor(part.name, shaft, f"has the sizes of a stepper motor of NEMA {size}"))
            elif (size := servo_size(part, shaft, own, metre / 1e-3)) is not None:
                result.append(SolidMotor(part.name, shaft, f"has the sizes of a {size} servo"))
            elif is_named_motor(part.name) and is_shaft_of_case(part, shaft, pins):
                result.append(SolidMotor(part.name, shaft, "is a motor by its name", named=True))
    return result
