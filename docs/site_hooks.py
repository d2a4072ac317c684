"""Make pages of the notebooks, which lie beside this folder, as they are stored: nothing is run.

Each notebook becomes a page in Markdown, and each picture among its outputs a file that the page shows.
"""

import base64
import json
from pathlib import Path

from mkdocs.config.defaults import MkDocsConfig
from mkdocs.structure.files import File, Files

NOTEBOOKS = Path(__file__).parent.parent / "notebooks"
FENCE = "`````"
"""Longer than any fence inside a cell or an output."""
PICTURES = {"image/png": "png", "image/gif": "gif"}


def on_files(files: Files, config: MkDocsConfig) -> Files:
    """Add the pages of the notebooks, and the pictures beside them."""
    for path in sorted(NOTEBOOKS.glob("*.ipynb")):
        page, pictures = notebook_page(path)
        files.append(File.generated(config, f"notebooks/{path.stem}.md", content=page))
        for name, content in pictures.items():
            files.append(File.generated(config, f"notebooks/{name}", content=content))
    for path in sorted(NOTEBOOKS.glob("pictures/*.png")):
        files.append(File.generated(config, f"notebooks/pictures/{path.name}", abs_src_path=str(path)))
    return files


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
