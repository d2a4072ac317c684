"""What users import: everything that a public call returns can be imported from `jaxkin`."""

import inspect
import re
import subprocess
import sys

import pytest

import jaxkin as jk
from documents import ROOT
from jaxkin import _api

PUBLIC = {name: getattr(jk, name) for name in dir(jk) if not name.startswith("_")}
CLASSES = {name: found for name, found in PUBLIC.items() if inspect.isclass(found)}


def returned(function) -> set[str]:
    """The class names in the annotation of what a function returns."""
    annotation = inspect.get_annotations(function).get("return", "")
    text = annotation if isinstance(annotation, str) else getattr(annotation, "__name__", "")
    return set(re.findall(r"(?<![\w.\"' ])([A-Z]\w+)(?![\w\"'])", re.sub(r"(Float|Int|Bool)\[[^\]]*\]", "", text)))


def functions():
    for name, found in PUBLIC.items():
        if inspect.isfunction(found):
            yield name, found
    for name, owner in CLASSES.items():
        for member, found in vars(owner).items():
            found = getattr(found, "fget", None) or getattr(found, "func", None) or getattr(found, "__func__", found)
            if inspect.isfunction(found) and not member.startswith("_"):
                yield f"{name}.{member}", found


@pytest.mark.parametrize(
    ("name", "function"), list(functions()), ids=lambda value: value if isinstance(value, str) else ""
)
def test_what_a_public_call_returns_is_public(name, function):
    known = {*PUBLIC, "Mapping", "Sequence", "Iterator", "Array", "Path", "Any", "Figure", "Callable", "None", "Self"}
    assert returned(function) <= known


def test_what_dir_lists_can_be_asked_for_first():
    """Modules are names of the package only once something in them was imported."""
    assert set(dir(jk)) == {*(name for name in vars(_api) if not name.startswith("_")), "__version__"}


def test_a_name_imports_what_it_needs_and_no_more():
    """All that a sweep never asks for takes nearly as long to import as JAX."""
    code = "import sys, jaxkin as jk; jk.Mechanism, jk.revolute, jk.optimize; print(*sys.modules)"
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    floors = {name.split(".")[1] for name in found if name.startswith("jaxkin.")}
    assert {"mechanism", "design"} <= floors and floors.isdisjoint({"io", "view", "effects", "assembly", "cli"})


def test_a_public_class_shares_its_name_with_no_other_class():
    """Who looks a name up in the code finds what `jk.` means by it."""
    made = {name: found.__module__ for name, found in CLASSES.items()}
    others = [
        f"{path.relative_to(ROOT)}: {name}"
        for path in (ROOT / "jaxkin").rglob("*.py")
        for name in re.findall(r"^class (\w+)", path.read_text(encoding="utf-8"), re.MULTILINE)
        if name in made and path != ROOT / f"{made[name].replace('.', '/')}.py"
    ]
    assert len(made) > 50 and others == []
