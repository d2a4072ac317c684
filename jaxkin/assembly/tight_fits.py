"""What fits a pin exactly where other parts of the drawing have play, and what no face keeps on it: it is pressed on.

Whoever draws play where parts move draws none where one is pressed, shrunk or glued onto another. A hinge would need
two faces that keep it on its pin; a press fit needs none.
"""

from __future__ import annotations

from collections.abc import Collection
from typing import TYPE_CHECKING

import numpy as np

from jaxkin.assembly.exact_fits import any_has_play, fits_its_hole
from jaxkin.assembly.hinge_bores import holes_of
from jaxkin.assembly.inference.bores import MAX_HOLE_ARC
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.measured import Measured
from jaxkin.joints.evidence import Certainty, Evidence, EvidenceKind
from jaxkin.joints.joint import Joint
from jaxkin.joints.kinds import JointKind
from jaxkin.mobility.mobility import joints_in_loops

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

_UNKEPT = (Certainty.ONE_FACE, Certainty.CENTRED, Certainty.SHORT)
"""Doubts of hinges of which no faces on both sides tell that they do not slide."""


def tight_fits(mechanism: Mechanism, measured: Measured, bearings: Collection[str]) -> list[Inference]:
    """Find the parts that fit a pin of one other body exactly and only turn on it by inference, since no faces on both
    sides keep them there, outside of loops, in a drawing where others have play.

    None is in or on `bearings`, nor in a half-shell: what is put around a shaft is not pressed on it.
    """
    if not any_has_play(mechanism):
        return []
    in_loops = joints_in_loops(mechanism.linkage)
    return [
        Inference(joint.parts, _evidence(joint))
        for number, joint in enumerate(mechanism.linkage.joints)
        if number not in in_loops
        and not {*joint.parts} & {*bearings}
        and _is_unkept_fit(joint)
        and all(hole.open_arc <= MAX_HOLE_ARC for hole in holes_of(joint, measured.bores))
    ]


def _is_unkept_fit(joint: Joint) -> bool:
    """Tell whether a joint is a hinge by inference, of a pin without play, which contacts would let slide."""
    evidence = joint.evidence
    if evidence is None or evidence.doubt is None:
        return False
    return joint.kind is JointKind.REVOLUTE and fits_its_hole(evidence) and evidence.doubt.seen in _UNKEPT


def _evidence(joint: Joint) -> Evidence:
    """Say what was measured, how often that was right, and the words that make the hinge again."""
    sizes = dict(joint.evidence.sizes) if joint.evidence else {}
    pose = np.asarray(joint.frames_1, float)[0]
    point, axis = (np.round(each, 6).tolist() for each in (pose[:3, 3], pose[:3, 2]))
    one, other = joint.parts
    seen = Certainty.UNKEPT_FIT
    text = f"{one!r} and {other!r} fit exactly on a radius of {sizes['radius']:.4g}, where others have play, and no "
    text += f"faces on both sides keep them there: one body in {seen.right} of {seen.of} such drawings; if they turn, "
    text += f"say joints=[jk.revolute({joint.name!r}, {one!r}, {other!r}, point={point}, axis={axis})]"
    return Evidence(EvidenceKind.TIGHT_FIT, (("radius", sizes["radius"]), ("clearance", sizes["clearance"])), text)
