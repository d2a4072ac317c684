"""How many parts a STEP file asks for, before they are made: a few lines of nested assemblies ask for billions."""

from __future__ import annotations

import re

MAX_STEP_PARTS = 20_000
"""Parts of a file; each takes some thousandths of a second."""


def placed_parts(text: str, name: str) -> int:
    """Count how many parts the assemblies of a file place; 0 where it has none.

    `name` is what messages call the file. Each occurrence (NEXT_ASSEMBLY_USAGE_OCCURRENCE) names the assembly and what
    is placed in it. Raises ValueError for more than `MAX_STEP_PARTS`, and where an assembly holds itself.
    """
    import networkx as nx

    tree = nx.MultiDiGraph()
    for statement in text.split(";"):  # a pattern over all of the text may take a time that grows with its square
        at = statement.find("NEXT_ASSEMBLY_USAGE_OCCURRENCE")
        if at >= 0 and (placed := re.findall(r"#(\d+)\s*,\s*#(\d+)", statement[at:])):
            tree.add_edge(*placed[-1])
    if not nx.is_directed_acyclic_graph(tree):
        raise ValueError(f"{name} is damaged: an assembly in it is a part of itself; export it again")
    times: dict[str, int] = {}
    for each in nx.topological_sort(tree):
        above = sum(times[assembly] for assembly, _ in tree.in_edges(each))
        times[each] = min(above or 1, MAX_STEP_PARTS + 1)  # enough to know
    if (parts := sum(times[each] for each in tree if tree.out_degree(each) == 0)) > MAX_STEP_PARTS:
        raise ValueError(f"{name} holds more than {MAX_STEP_PARTS} parts: export it part by part")
    return parts
