"""Modules: how long they are, and what a reader may rely on when going down from a call to what it computes with."""

import grimp
import networkx as nx

from documents import ROOT

FACADE = {
    "jaxkin.mechanism.mechanism",
    "jaxkin.assembly.blocking_contacts",  # leaves contacts out and makes the mechanism anew
    "jaxkin.assembly.to_mechanism",
    "jaxkin.io.mechanism_file",
}
"""A method of the facade gets its code from a higher floor when it is called; that code may make mechanisms."""


def test_there_is_no_circle_of_imports_but_the_facades():
    """Imports for annotations do not count: they say what a function is given, not what it needs."""
    graph = grimp.build_graph("jaxkin", cache_dir=None, exclude_type_checking_imports=True)
    imports = nx.DiGraph(
        (one, other) for one in graph.modules for other in graph.find_modules_directly_imported_by(one)
    )
    circles = [set(circle) for circle in nx.strongly_connected_components(imports) if len(circle) > 1]
    assert all(circle <= FACADE for circle in circles), circles


def test_a_file_holds_one_concept_in_at_most_300_lines():
    files = [path for folder in ("jaxkin", "tests") for path in (ROOT / folder).rglob("*.py")]
    lines = {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8").count("\n") for path in files}
    assert len(lines) > 400 and {path for path, count in lines.items() if count > 300} == set()
