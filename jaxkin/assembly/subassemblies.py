"""Parts that an export joins to nothing, and the sub-assemblies that they move with.

CAD systems keep the parts of a sub-assembly together by groups and by fasteners that exports leave out.
"""

from __future__ import annotations

from collections.abc import Sequence

from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.joints.evidence import Evidence, EvidenceKind


def rigid_subassemblies(known: Known, joined: Sequence[tuple[str, str]]) -> list[Inference]:
    """Find the parts that move with the sub-assembly that they are in, the innermost sub-assemblies first.

    Only sub-assemblies inside which nothing moves are looked at: without a joint between two of their bodies. `joined`
    are the parts of all joints. A body is anchored if it is fixed or has two joints or more: these determine how it
    moves. All other bodies of the sub-assembly, those without a joint or with one, go with the one that is anchored; or
    together, where none is. Where several are anchored, nothing is said here.
    """
    body, result = known.body, []
    paths = {part.path[:depth] for part in known.parts for depth in range(1, len(part.path) + 1)}
    for path in sorted(paths, key=lambda path: (-len(path), path)):
        inside = [part.name for part in known.parts if part.path[: len(path)] == path]
        owners = {body[part] for part in inside}
        pairs = [{body[part] for part in parts} for parts in joined]
        if len(owners) == 1 or any(len(pair) == 2 and pair <= owners for pair in pairs):
            continue
        ties = {owner: sum(len(pair) == 2 and owner in pair for pair in pairs) for owner in owners}
        anchored = [owner for owner in owners if ties[owner] > 1 or owner == body[known.fixed[0]]]
        if len(anchored) > 1:
            continue
        first = next(part for part in inside if not anchored or body[part] == anchored[0])
        others = tuple(part for part in inside if body[part] != body[first])
        text = f"nothing is joined inside of the sub-assembly {'/'.join(path)!r}: its parts move as one"
        result.append(Inference((first, *others), Evidence(EvidenceKind.SUBASSEMBLY, (), text)))
        body = {part: body[first] if owner in owners else owner for part, owner in body.items()}
    return result
