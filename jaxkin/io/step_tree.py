"""What the text of a STEP file says of its assemblies: how many parts they place, and what sub-assemblies are called.

The parts are counted before they are made: a few lines of nested assemblies ask for billions.
"""

from __future__ import annotations

import re

from jaxkin.io.step_strings import string_value

MAX_STEP_PARTS = 20_000
"""Parts of a file; each takes some thousandths of a second."""


def placed_parts(text: str, name: str) -> dict[str, int]:
    """Count how often the assemblies of a file place each part, by the number of its definition; empty where it has
    none.

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
    parts = {each: times[each] for each in tree if tree.out_degree(each) == 0}
    if sum(parts.values()) > MAX_STEP_PARTS:
        raise ValueError(f"{name} holds more than {MAX_STEP_PARTS} parts: export it part by part")
    return parts


_COMPLEX_OCCURRENCE = re.compile(r"NEXT_ASSEMBLY_USAGE_OCCURRENCE\s*\(\s*\)")
_COMPLEX = re.compile(r"(\s*#\d+\s*=\s*)\(.*\bPRODUCT_DEFINITION_RELATIONSHIP\s*\(((?:[^'()]|'[^']*')*)\).*\)\s*", re.S)


def simple_occurrences(text: str) -> str:
    """Rewrite occurrences that are complex instances, as of assemblies with quantities, to the form that readers know:
    they leave the parts of others where these were drawn, without a word."""
    if not _COMPLEX_OCCURRENCE.search(text):
        return text
    return ";".join(
        _COMPLEX.sub(r"\1NEXT_ASSEMBLY_USAGE_OCCURRENCE(\2,$)", each) if _COMPLEX_OCCURRENCE.search(each) else each
        for each in text.split(";")
    )


_STRING = r"\s*'((?:[^']|'')*)'\s*"
_REFERENCE = r"\s*#(\d+)\s*"
_OCCURRENCE = re.compile(rf"NEXT_ASSEMBLY_USAGE_OCCURRENCE\s*\({_STRING},{_STRING},[^#]*#\d+\s*,{_REFERENCE},")
_STATEMENT = re.compile(
    rf"#(\d+)\s*=\s*(PRODUCT_DEFINITION_FORMATION\w*|PRODUCT_DEFINITION|PRODUCT)\s*\({_STRING},(?:{_STRING}|\s*\$\s*),"
    rf"(?:{_REFERENCE})?"
)


def nameless_occurrences(text: str) -> dict[str, str]:
    """Find the names of the products of those occurrences that have an identifier only, such as "NAUO3", by this.

    Readers call an occurrence without a name by its identifier, which tells a user nothing. Identifiers
    that mean different products are left out.
    """
    above: dict[str, str] = {}  # what a product definition, or its formation, is of
    names: dict[str, str] = {}  # of products, by their numbers
    occurrences: dict[str, set[str]] = {}
    for statement in text.split(";"):
        if "PRODUCT" in statement and (found := _STATEMENT.search(statement)):
            number, kind, identifier, name, of = found.groups()
            if kind == "PRODUCT":
                names[number] = string_value(name or identifier)
            elif of:
                above[number] = of
        elif "NEXT_ASSEMBLY_USAGE_OCCURRENCE" in statement and (found := _OCCURRENCE.search(statement)):
            identifier, name, of = found.groups()
            if name.strip() in ("", identifier):
                occurrences.setdefault(string_value(identifier), set()).add(of)
    products = {
        each: {names.get(above.get(above.get(of, ""), ""), "") for of in ofs} for each, ofs in occurrences.items()
    }
    single = {identifier: next(iter(found)) for identifier, found in products.items() if len(found) == 1}
    return {identifier: name for identifier, name in single.items() if name.strip()}
