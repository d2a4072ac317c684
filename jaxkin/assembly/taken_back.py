"""Inferences that lock a mechanism: each is taken back in turn, to see what can move without it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import combinations
from typing import TYPE_CHECKING

from jaxkin.assembly.dropped_inference import KEPT
from jaxkin.joints.evidence import Bond, EvidenceKind
from jaxkin.joints.from_contacts import PartPair

if TYPE_CHECKING:
    from jaxkin.mechanism.mechanism import Mechanism

TRIALS = 1000
"""Parts times pairs that are tried: a mechanism of 50 parts takes half a second, and so 20 pairs ten."""
FEWEST = 6
"""Pairs that are tried however many parts there are."""
_SAID = (*KEPT, EvidenceKind.USER, EvidenceKind.EXPORT)


def taken_back(mechanism: Mechanism, without: Callable[[PartPair], Mechanism]) -> Iterator[tuple[PartPair, Mechanism]]:
    """Yield pairs of parts of which something is inferred, each with the mechanism in which it is not.

    `without` makes the mechanism that ignores what is between two parts. The weakest inferences, which were made last,
    come first; pairs without which a part hangs on nothing are left out.
    """
    inferred = [bond for bond in reversed(mechanism.bonds) if bond.evidence.kind not in _SAID]
    pairs = dict.fromkeys(pair for bond in inferred for pair in _pairs(bond))
    for pair in [*pairs][: max(FEWEST, TRIALS // len(mechanism.parts))]:
        try:
            yield pair, without(pair)
        except ValueError:  # a part hangs on nothing then
            continue


def _pairs(bond: Bond) -> list[PartPair]:
    """List pairs of parts that an inference holds together: all of three parts, of more each with the first one."""
    if len(bond.parts) > 3:
        return [(bond.parts[0], other) for other in bond.parts[1:]]
    return list(combinations(bond.parts, 2))
