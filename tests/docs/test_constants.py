"""What `docs/site_hooks.py` puts into pages: constants with their reasons, and the references of what users import."""

import importlib.util
import inspect
import re

import pytest

import jaxkin as jk
from documents import ROOT

FOLDERS = ("linkage", "mechanism", "mobility", "solve")
MODULES = sorted(path for folder in FOLDERS for path in (ROOT / "jaxkin" / folder).rglob("*.py"))


@pytest.fixture(scope="module")
def hooks():
    spec = importlib.util.spec_from_file_location("site_hooks", ROOT / "docs" / "site_hooks.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_every_constant_stands_alone_and_says_why(hooks):
    found = [(path.relative_to(ROOT).as_posix(), *row) for path in MODULES for row in hooks.constants(path)]
    assert len(found) > 60
    assert [row[:2] for row in found if "," in row[1] or not row[3]] == []


def test_all_that_users_import_has_one_entry_in_the_documents(hooks):
    pages = (ROOT / "docs" / "api").glob("*.md")
    text = "\n".join(hooks.on_page_markdown(page.read_text(encoding="utf-8")) for page in pages)
    entries = re.findall(r"^::: jaxkin\.(\w+)$", text, re.M)
    assert len(entries) == len({*entries})
    public = {name for name in dir(jk) if not name.startswith("_") and not inspect.ismodule(getattr(jk, name))}
    assert public - {*entries} == set()


def test_the_page_of_designs_has_all_objectives_constraints_and_measures(hooks):
    """A package has no members of its own for the pages of references: that page said nothing of them."""
    page = hooks.on_page_markdown((ROOT / "docs" / "api" / "design.md").read_text(encoding="utf-8"))
    referred = re.findall(r"^::: jaxkin\.(?:design\.)?(\w+)", page, re.M)
    exported = {
        name for name in vars(jk.design) if not name.startswith("_") and not inspect.ismodule(vars(jk.design)[name])
    }
    assert {"path", "in_box", "stroke", "Free"} <= exported
    assert exported - {"Optimum"} <= set(referred) and len(referred) == len(set(referred))


@pytest.mark.parametrize("notebook", sorted((ROOT / "notebooks").glob("*.ipynb")), ids=lambda path: path.stem)
def test_notebooks_have_no_formulas_that_the_site_does_not_set(notebook, hooks):
    text, _ = hooks.notebook_page(notebook)
    outside = re.sub(r"^`{5}.*?^`{5}", "", text, flags=re.M | re.S)
    assert re.findall(r"\$[^$\n]+\$", outside) == []
