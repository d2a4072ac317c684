"""What the pages with the viewer of `viewer.js` share: the files that they are made of, and solids as it reads them."""

from __future__ import annotations

import json
from base64 import b64encode
from collections.abc import Mapping, Sequence
from importlib import resources
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from jaxkin.geometry.part import Part
from jaxkin.view.mesh import lightened, shaded_mesh

if TYPE_CHECKING:
    from jaxkin.view.sheet import Color


def write_page(path: Path | str, name: str, scene: Mapping[str, object]) -> None:
    """Write the page `name.html` with its controls `name.js`, the viewer, and the scene that they read.

    The page needs nothing else, neither a network nor a server.
    """
    data = json.dumps(scene, ensure_ascii=False, separators=(",", ":"))
    text = _read(f"{name}.html").replace("{{style}}", _read("viewer.css"))
    text = text.replace("{{viewer}}", _read("viewer.js") + _read("mouse.js"))
    text = text.replace("{{controls}}", _read(f"{name}.js"))
    Path(path).write_text(text.replace("{{scene}}", data.replace("<", "\\u003c")), "utf-8")  # no name ends the script


def part_entries(
    parts: Sequence[Part],
    bodies: Sequence[Sequence[str]],
    colors: Mapping[str, Color],
    centre: Float[np.ndarray, "3"],
    scale: float,
) -> list[dict]:
    """List the meshes of all parts, lightened together, each with its colour and the index of its body.

    Lengths are over `scale` about `centre`, so that float32 is enough in any unit.
    """
    owner = {part: index for index, names in enumerate(bodies) for part in names}
    solids = lightened([(part.triangles - centre) / scale for part in parts])
    return [
        {"name": part.name, "body": owner[part.name], "color": rounded(colors[part.name]), **_mesh(triangles)}
        for part, triangles in zip(parts, solids, strict=True)
    ]


def rounded(color: Color) -> list[float]:
    """Round a colour to as many digits as can be seen."""
    return [round(value, 4) for value in color]


def encoded(array: np.ndarray, kind: str = "<f4") -> str:
    """Encode numbers as base64, little-endian."""
    return b64encode(np.ascontiguousarray(array, dtype=kind).tobytes()).decode("ascii")


def _mesh(triangles: np.ndarray) -> dict[str, str]:
    mesh = shaded_mesh(triangles)
    normals = np.zeros((len(mesh.normals), 4))  # four bytes a corner, as graphics cards want them
    normals[:, :3] = 127 * mesh.normals
    return {
        "points": encoded(mesh.points),
        "normals": encoded(np.rint(normals), "i1"),
        "triangles": encoded(mesh.triangles, "<u4"),
        "edges": encoded(mesh.edges),
    }


def _read(name: str) -> str:
    return resources.files("jaxkin.view").joinpath(name).read_text("utf-8")
