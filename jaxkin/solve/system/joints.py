"""Hold the numbers of a loop system: frames and pitches of its joints."""

from __future__ import annotations

from typing import NamedTuple

from jaxtyping import Array, Float


class Joints(NamedTuple):
    """Frames and pitches of the joints of a loop system, one entry a joint, in the unit of the mechanism: see
    `Joint`."""

    frames_1: tuple[Float[Array, "frames 4 4"], ...]
    frames_2: tuple[Float[Array, "frames 4 4"], ...]
    pitch: tuple[Float[Array, ""], ...]
