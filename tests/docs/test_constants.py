"""The constants that `docs/solver.md` lists: each says why it has its value."""

import importlib.util

import pytest

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
