"""Write what joints and bodies are known from as plain data for files, and read it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from jaxkin._arguments import text
from jaxkin.joints.evidence import Bond, Doubt, Evidence, EvidenceKind, Seen
from jaxkin.joints.kinds import JointKind


def of_evidence(evidence: Evidence) -> dict[str, Any]:
    """Write evidence; what it has none of is left out: sizes, a text, a doubt."""
    record: dict[str, Any] = {"kind": str(evidence.kind)}
    if evidence.sizes:
        record["sizes"] = [[name, float(size)] for name, size in evidence.sizes]
    if evidence.text:
        record["text"] = evidence.text
    if doubt := evidence.doubt:
        record["doubt"] = {"kind": str(doubt.kind), "why": doubt.why, "seen": list(doubt.seen)}
    return record


def evidence_of(record: Mapping[str, Any] | None) -> Evidence | None:
    """Read evidence that `of_evidence` wrote, None for none; KeyError, TypeError or ValueError for others."""
    if record is None:
        return None
    sizes = tuple((text(name, "a size of evidence"), float(size)) for name, size in record.get("sizes", ()))
    return Evidence(
        EvidenceKind(record["kind"]),
        sizes,
        text(record.get("text", ""), "the text of evidence"),
        _doubt(record["doubt"]) if "doubt" in record else None,
    )


def of_bond(bond: Bond) -> dict[str, Any]:
    """Write parts that move as one, with what that is known from."""
    return {"parts": list(bond.parts), "evidence": of_evidence(bond.evidence)}


def bond_of(record: Mapping[str, Any]) -> Bond:
    """Read what `of_bond` wrote; KeyError, TypeError or ValueError for others."""
    found = evidence_of(record["evidence"])
    if found is None:
        raise ValueError("a bond has no evidence")
    return Bond(tuple(text(part, "a part of a bond") for part in record["parts"]), found)


def _doubt(record: Mapping[str, Any]) -> Doubt:
    right, of = record["seen"]
    if not (isinstance(right, int) and isinstance(of, int) and 0 <= right <= of and of > 0):
        raise ValueError(f"a doubt was right in a number of joints of all those seen, got {record['seen']!r}")
    return Doubt(JointKind(record["kind"]), text(record["why"], "the reason of a doubt"), Seen(right, of))
