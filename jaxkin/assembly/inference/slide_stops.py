"""What stops a slide along the common axis of two bodies, and what is in doubt about it."""

from __future__ import annotations

from enum import IntEnum

from jaxkin.assembly.inference.stop_faces import MAX_AXIAL_PLAY
from jaxkin.joints.evidence import Certainty, Doubt
from jaxkin.joints.kinds import JointKind

NEAR_LIMIT = 2.0
"""Factor between a play and the largest one that counts as none, within which either reading is about as likely."""


class Stop(IntEnum):
    """What stops a slide, the surest first."""

    NONE = 0
    """Nothing."""
    FACES = 1
    """Faces on both sides."""
    ONE_FACE = 2
    """A face on one side, and on the other one the thread or the retaining ring of a fastener."""
    BEARING = 3
    """Nothing that is drawn, but it is in a ball bearing."""
    CENTRED = 4
    """Nothing that is drawn; the pin and its holes have their middles in one place."""
    NO_STROKE = 5
    """Nothing that is drawn, but it is about as long as what it is in."""
    BALL_STUD = 6
    """Nothing that is drawn, but one of the two ends in a ball on the axis, which turns in its socket already."""
    FLANGES = 7
    """Nothing on the other side, but both have screws in a circle round the axis, as a motor and what it turns."""
    SHORT = 8
    """Faces on both sides, but far away; the hole is too short to slide between them without jamming."""
    TIGHT = 9
    """Nothing that is drawn, but it fits exactly where something else on the same pin has play."""


_SLIDES = {
    Stop.ONE_FACE: ("on one side a fastener alone would stop its slide", Certainty.ONE_FACE),
    Stop.CENTRED: ("no face that is drawn stops its slide", Certainty.CENTRED),
    Stop.NO_STROKE: ("no face that is drawn stops its slide", Certainty.CENTRED),
    Stop.SHORT: ("only that its hole is short tells that it does not slide", Certainty.SHORT),
}
"""Why a joint that is taken to turn only may slide, too, and how often such a joint did not."""

_FOR_A_REASON = (Stop.BALL_STUD, Stop.FLANGES)
"""What stops a slide by what the parts are for: of these no drawing that no rule had seen was counted."""


def slide_doubt(stop: Stop, room: float | None, radius: float) -> Doubt | None:
    """Tell the other reading of a joint about a common axis; None where faces say without doubt whether it slides.

    `room` is the play that faces leave along the axis, None without faces on both sides; `radius` that of the hole.
    """
    if stop in _SLIDES:
        return Doubt(JointKind.CYLINDRICAL, *_SLIDES[stop])
    if stop in _FOR_A_REASON:
        return None
    if stop is Stop.NONE and room is None:
        return Doubt(JointKind.REVOLUTE, "nothing that is drawn stops its slide", Certainty.NO_STOP)
    limit = MAX_AXIAL_PLAY * radius
    if room is None or not limit / NEAR_LIMIT < room < limit * NEAR_LIMIT:
        return None
    kind = JointKind.CYLINDRICAL if room <= limit else JointKind.REVOLUTE
    why = f"faces leave it a play of {room:.2g}, where up to {limit:.2g} counts as none"
    return Doubt(kind, why, Certainty.NEAR_LIMIT)
