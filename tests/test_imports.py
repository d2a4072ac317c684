"""Modules: how long they are, and what a reader may rely on when going down from a call to what it computes with."""

import grimp
import networkx as nx

from documents import ROOT


def test_there_is_no_circle_of_imports():
    """Imports inside functions count. Those for annotations do not: they say what a function is given, not what it
    needs. So what a method of the facade calls takes a mechanism, and makes none but by `replace`."""
    graph = grimp.build_graph("jaxkin", cache_dir=None, exclude_type_checking_imports=True)
    imports = nx.DiGraph(
        (one, other) for one in graph.modules for other in graph.find_modules_directly_imported_by(one)
    )
    assert [circle for circle in nx.strongly_connected_components(imports) if len(circle) > 1] == []


def test_a_file_holds_one_concept_in_at_most_300_lines():
    files = [path for folder in ("jaxkin", "tests") for path in (ROOT / folder).rglob("*.py")]
    lines = {path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8").count("\n") for path in files}
    assert len(lines) > 400 and {path for path, count in lines.items() if count > 300} == set()
