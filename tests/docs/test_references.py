"""What the pages name is there: files of the repository, modules, functions, and links from page to page."""

import importlib
import re

import pytest

from documents import PAGES, ROOT, name

FILE = re.compile(r"`((?:jaxkin|tests|benchmarks|notebooks|docs|\.ci)/[\w./*-]*)`")
DOTTED = re.compile(r"`(jaxkin(?:\.\w+)+)(?:\([^`]*\))?`")
SHORT = re.compile(r"\bjk((?:\.\w+)+)")
DIRECTIVE = re.compile(r"^::: ([\w.]+)", re.M)
LINK = re.compile(r"\]\((?!https?://)([^)#\s]+)(?:#[^)]*)?\)")
OF_A_FILE = re.compile(r"`(jaxkin/[\w/]+\.py)`[^\n]*?`(\w+)`(?=[^\n]*\|)")


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_what_a_page_names_exists(page):
    text = page.read_text(encoding="utf-8")
    files = [file for file in FILE.findall(text) if not list(ROOT.glob(file.rstrip("/")))]
    names = [*DOTTED.findall(text), *DIRECTIVE.findall(text), *("jaxkin" + found for found in SHORT.findall(text))]
    missing = [each for each in names if not found(each)]
    linked = [link for link in LINK.findall(text) if not (page.parent / link).exists() and not of_the_site(page, link)]
    assert (files, missing, linked) == ([], [], [])


def test_the_functions_in_the_table_of_equations_are_in_their_files():
    text = (ROOT / "docs" / "equations.md").read_text(encoding="utf-8")
    rows = OF_A_FILE.findall(text)
    assert len(rows) > 30
    missing = [row for row in rows if not defined(*row)]
    assert missing == []


def test_the_functions_on_the_route_of_the_solver_are_in_their_files():
    route = (ROOT / "jaxkin" / "solve" / "__init__.py").read_text(encoding="utf-8")
    steps = re.findall(r"`(\w+(?:/\w+)*\.py)`(?: `(\w+)`)?", route)
    assert len(steps) >= 19
    assert [step for step in steps if not (ROOT / "jaxkin" / "solve" / step[0]).exists()] == []
    assert [step for step in steps if step[1] and not defined(f"jaxkin/solve/{step[0]}", step[1])] == []


@pytest.mark.parametrize("folder", ["assembly", "contacts", "geometry", "io", "joints", "view"])
def test_the_index_of_a_large_folder_names_all_its_modules(folder):
    """Each by its name, or as one of those whose names begin alike, `step_...`."""
    inside = ROOT / "jaxkin" / folder
    modules = {path.stem for path in inside.iterdir() if path.suffix == ".py" or (path / "__init__.py").exists()}
    modules.remove("__init__")
    named = re.findall(r"`(\w+(?:\.\.\.)?)`", (inside / "__init__.py").read_text(encoding="utf-8"))
    begin = tuple(each.removesuffix("...") for each in named if each.endswith("..."))
    assert {module for module in modules if not module.startswith(begin or ("...",))} <= set(named)
    assert {each for each in named if not each.endswith("...")} <= modules
    assert [each for each in begin if not any(module.startswith(each) for module in modules)] == []


def defined(file: str, what: str) -> bool:
    """Whether a name is defined at the top of a file, or in a class of it."""
    return re.search(rf"^ *(?:def|class) {what}\b|^ *{what}\b *[:=]", (ROOT / file).read_text(), re.M) is not None


def found(dotted: str) -> bool:
    """Whether a dotted name can be imported, or is a member, or a field, of what can be."""
    words = dotted.split(".")
    for count in range(len(words), 0, -1):
        try:
            value = importlib.import_module(".".join(words[:count]))
        except ModuleNotFoundError:
            continue
        for word in words[count:]:
            if not hasattr(value, word) and word not in getattr(value, "__annotations__", {}):
                return False
            value = getattr(value, word, None)
        return True
    return False


def of_the_site(page, link: str) -> bool:
    """Whether a link leads to a page that is made of a notebook, or to a picture beside it."""
    place = (page.parent / link).resolve()
    if not place.is_relative_to(ROOT / "docs" / "notebooks"):
        return False
    source = ROOT / place.relative_to(ROOT / "docs")
    return source.exists() or source.with_suffix(".ipynb").exists()


def test_every_page_is_in_the_navigation():
    listed = (ROOT / "mkdocs.yml").read_text(encoding="utf-8")
    pages = [page.relative_to(ROOT / "docs").as_posix() for page in PAGES if page.is_relative_to(ROOT / "docs")]
    assert [page for page in pages if f": {page}\n" not in listed] == []
    notebooks = [f"notebooks/{path.stem}.md" for path in (ROOT / "notebooks").glob("*.ipynb")]
    assert [page for page in notebooks if f": {page}\n" not in listed] == []
