"""Parts that joints by hand and rigid groups tie to nothing: they stay where they are."""

from __future__ import annotations

from collections.abc import Sequence

from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.to_mechanism import MechanismOptions
from jaxkin.joints.evidence import Evidence, EvidenceKind
from jaxkin.topology.components import connected


def left_loose(names: Sequence[str], options: MechanismOptions) -> list[Inference]:
    """Hold the first part of each group of parts that nothing ties to the fixed ones to these, in the order of `names`.

    Its evidence is of the kind "nearest" and says that the part is tied to nothing.
    """
    ties = [options.fixed, *options.rigid, *(joint.parts for joint in options.joints)]
    groups = connected(names, [(tie[0], part) for tie in ties for part in tie[1:]])
    firsts = [min(group, key=names.index) for group in groups if options.fixed[0] not in group]
    return [
        Inference(
            (options.fixed[0], part), Evidence(EvidenceKind.NEAREST, (), f"{part!r} is tied to nothing: left at rest")
        )
        for part in sorted(firsts, key=names.index)
    ]
