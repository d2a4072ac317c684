"""What pages hold that is not written by hand: the notebooks as they are stored, and the constants of the code.

Each notebook becomes a page in Markdown, and each picture among its outputs a file that the page shows; nothing is run.
A comment "constants of FOLDER..." in a page is replaced by the constants of the modules there, with their docstrings,
"joints by hand" by the references of the functions that make them, "objectives, constraints and measures" by those of
`jaxkin.design`, and "exports that no other page has" by those of
what else can be imported from jaxkin.
"""

from __future__ import annotations

import ast
import base64
import json
import re
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from mkdocs.config.defaults import MkDocsConfig
    from mkdocs.structure.files import Files

ROOT = Path(__file__).parent.parent
NOTEBOOKS = ROOT / "notebooks"
FENCE = "`````"
"""Longer than any fence inside a cell or an output."""
PICTURES = {"image/png": "png", "image/gif": "gif"}


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages of the notebooks, and the pictures beside them."""
    from mkdocs.structure.files import File  # here: tests that read constants need no mkdocs

    for path in sorted(NOTEBOOKS.glob("*.ipynb")):
        page, pictures = notebook_page(path)
        files.append(File.generated(config, f"notebooks/{path.stem}.md", content=page))
        for name, content in pictures.items():
            files.append(File.generated(config, f"notebooks/{name}", content=content))
    for path in sorted(NOTEBOOKS.glob("pictures/*.png")):
        files.append(File.generated(config, f"notebooks/pictures/{path.name}", abs_src_path=str(path)))
    return files


def on_page_markdown(markdown: str, **_) -> str:
    """Put constants and references in the place of the comments that ask for them."""
    joints = [f"::: jaxkin.{name}" for name in joints_by_hand()]
    markdown = markdown.replace("<!-- joints by hand -->", "\n\n".join(joints))
    markdown = markdown.replace("<!-- exports that no other page has -->", "\n\n".join(other_exports()))
    designs = [f"::: jaxkin.design.{name}" for name in of_designs()]
    markdown = markdown.replace("<!-- objectives, constraints and measures -->", "\n\n".join(designs))
    return re.sub(r"<!-- constants of (.*?) -->", lambda match: constants_of(match[1].split()), markdown)


def other_exports() -> list[str]:
    """References of the names that `jaxkin` exports and no page of the API has."""
    pages = "\n".join(path.read_text(encoding="utf-8") for path in (ROOT / "docs" / "api").glob("*.md"))
    listed = {*re.findall(r"^::: jaxkin\.(\w+)", pages, re.M), *joints_by_hand()}
    return [f"::: jaxkin.{name}" for name in exports("jaxkin/_api.py") if name != "*" and name not in listed]


def of_designs() -> list[str]:
    """Names that `jaxkin.design` exports, `jaxkin` does not, and the page of designs does not have by itself: what a
    package imports from its modules is no member of it for the pages of references."""
    page = (ROOT / "docs" / "api" / "design.md").read_text(encoding="utf-8")
    listed = {*re.findall(r"^::: jaxkin\.design\.(\w+)", page, re.M), *exports("jaxkin/_api.py", "jaxkin.design")}
    return [name for name in exports("jaxkin/design/__init__.py") if name not in listed]


def exports(path: str, package: str = "jaxkin") -> list[str]:
    """Names that a module of the repository imports from those of a package, for its users."""
    imports = [node for node in module_body(path) if isinstance(node, ast.ImportFrom)]
    imports = [node for node in imports if f"{node.module}.".startswith(f"{package}.")]
    return [alias.asname or alias.name for node in imports for alias in node.names]


def joints_by_hand() -> list[str]:
    """Names of the functions that make joints by hand."""
    assigned = [node for node in module_body("jaxkin/joints/pairs.py") if isinstance(node, ast.Assign)]
    return next(ast.literal_eval(node.value) for node in assigned if ast.unparse(node.targets[0]) == "__all__")


def module_body(path: str) -> list[ast.stmt]:
    """The statements of a module of the repository."""
    return ast.parse((ROOT / path).read_text(encoding="utf-8")).body


def constants_of(folders: list[str]) -> str:
    """Tables of the constants in some folders, one a module."""
    tables = []
    for path in (path for folder in folders for path in sorted((ROOT / folder).rglob("*.py"))):
        if rows := constants(path):
            cells = "\n".join(f"| `{name}` | `{value}` | {text} |" for name, value, text in rows)
            heading = f"**`{path.relative_to(ROOT).as_posix()}`**"
            tables.append(f"{heading}\n\n| constant | value | why |\n|---|---|---|\n{cells}")
    return "\n\n".join(tables)


def constants(path: Path) -> list[tuple[str, str, str]]:
    """Name, value and docstring of the constants of a module that are numbers; without a docstring it is empty."""
    found = []
    body = ast.parse(path.read_text(encoding="utf-8")).body
    for statement, following in zip(body, [*body[1:], None], strict=True):
        if not isinstance(statement, ast.Assign) or not isinstance(statement.targets[0], ast.Name | ast.Tuple):
            continue
        name, value = ast.unparse(statement.targets[0]), ast.unparse(statement.value)
        if re.fullmatch(r"\(?_?[A-Z][A-Z0-9_, ]*\)?", name) and not re.search(r"[\[{'\"]", value):
            documented = isinstance(following, ast.Expr) and isinstance(following.value, ast.Constant)
            text = " ".join(str(following.value.value).split()) if documented else ""
            found.append((name, value, text.replace("|", "\\|")))
    return found


def notebook_page(path: Path) -> tuple[str, dict[str, bytes]]:
    """The notebook in Markdown, and its pictures by file name."""
    parts: list[str] = []
    pictures: dict[str, bytes] = {}
    for cell in json.loads(path.read_text(encoding="utf-8"))["cells"]:
        source = "".join(cell["source"]).strip()
        if cell["cell_type"] == "markdown":
            parts.append(source)
            continue
        if source:
            parts.append(fenced("python", source))
        for output in cell["outputs"]:
            data = output.get("data", {"text/plain": output.get("text", "")})
            kind = next((kind for kind in PICTURES if kind in data), None)
            if kind is not None:
                name = f"{path.stem}-{len(pictures) + 1}.{PICTURES[kind]}"
                pictures[name] = base64.b64decode("".join(data[kind]))
                parts.append(f"![Picture {len(pictures)} of this notebook]({name})")
            elif text := "".join(data["text/plain"]).rstrip():
                parts.append(fenced("text", text))
    return "\n\n".join(parts) + "\n", pictures


def fenced(language: str, text: str) -> str:
    """A block of code or of output."""
    return f"{FENCE}{language}\n{text}\n{FENCE}"
