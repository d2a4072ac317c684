"""Check what the header of a mesh file claims against the file, before anything else is read from it.

trimesh takes many broken files for empty scenes, and some claims for what to allocate.
"""

from __future__ import annotations

import re
import warnings
import zipfile
from pathlib import Path

MAX_TRIANGLES = 1_000_000
"""Triangles of a file; a large assembly has some hundred thousand."""

MAX_MESH_NODES = 5_000
"""Nodes, or bodies, of a file: each takes some hundredths of a second."""

MAX_MESH_BYTES = 500_000_000
"""Bytes of a file, or of what is packed in it: what `MAX_TRIANGLES` triangles take as text."""

OBJ_ELEMENTS = (b"f ", b"l ", b"p ", b"curv", b"surf")
"""How lines of OBJ begin that use corners."""
OBJ_TAIL = 1_000_000
"""Bytes at the end of OBJ in which its last lines are looked for."""

_OBJ_COUNTS = re.compile(rb"^#[^\r\n]*?(?:\bvert\w*\s*[:=]\s*(\d+)|\b(\d+)\s+vert)", re.I | re.M)
"""Comments of OBJ that say how many corners there are."""

_CALLER = 7
"""Calls from a warning to `load`."""

UNITS = {"micron": "um", "millimeter": "mm", "centimeter": "cm", "meter": "m", "inch": "in", "foot": "ft"}
"""Units of length of 3MF, and what they are called here."""


_STL_TEXT = re.compile(rb"(?:\xef\xbb\xbf)?\s*solid\b.*?(?:facet|endsolid)", re.I | re.S)
"""How STL begins that is text, after the mark of UTF-8, where there is one; in letters of either case."""


def check(path: Path) -> str | None:
    """Find the unit of the lengths of a mesh file that exists, if it says one.

    Raises ValueError for a file that cannot be a mesh of its kind.
    """
    kind = path.suffix.lower().removeprefix(".")
    size = path.stat().st_size
    if size == 0:
        raise ValueError(f"{path.name} is empty: expected a mesh in {kind.upper()} format")
    with path.open("rb") as file:
        head = file.read(20_000)
    if re.match(rb"\s*ISO-10303-21", head):
        raise ValueError(f"{path.name} is a STEP file: call it {path.stem}.step")
    if size > MAX_MESH_BYTES and kind != "stl":
        raise ValueError(f"{path.name} is {size / 1e6:.0f} MB, more than {MAX_MESH_BYTES / 1e6:.0f}: export it coarser")
    return {"stl": _stl, "obj": _obj, "ply": _ply, "3mf": _3mf, "glb": _glb, "dae": _dae}[kind](path, head, size)


def is_binary_stl(path: Path) -> bool:
    """Tell whether the size of a checked file is that of the records of binary STL that its header announces."""
    with path.open("rb") as file:
        head = file.read(84)
    return path.suffix.lower() == ".stl" and path.stat().st_size == 84 + 50 * int.from_bytes(head[80:84], "little")


def too_many(name: str, count: int) -> ValueError:
    """Make the error for a file of more than `MAX_TRIANGLES` triangles."""
    return ValueError(f"{name} holds {count} triangles, more than {MAX_TRIANGLES}: export it coarser, or part by part")


def _stl(path: Path, head: bytes, size: int) -> None:
    """Check STL: as text that it ends, else that it has as many bytes as the triangles take that its header counts."""
    count = int.from_bytes(head[80:84], "little")
    if size != 84 + 50 * count and _STL_TEXT.match(head):
        if size > MAX_MESH_BYTES:
            raise ValueError(
                f"{path.name} is {size / 1e6:.0f} MB, more than {MAX_MESH_BYTES / 1e6:.0f}: export it coarser"
            )
        with path.open("rb") as file:
            file.seek(max(0, size - 1000))
            tail = file.read()
        if b"endsolid" not in tail.lower():
            raise ValueError(f"{path.name} is cut off: it does not end with endsolid; copy or export it again")
        _check_points(path.name, rb"^\s*vertex\s", head)
        return
    if size < 84:
        raise ValueError(f"{path.name} is no STL file: it is shorter than the header of one")
    if size != 84 + 50 * count:
        raise ValueError(
            f"{path.name} is damaged or cut off, or no STL file: its header announces {count} triangles, which take "
            f"{84 + 50 * count} bytes, but it has {size}; copy or export it again"
        )
    if count == 0:
        raise ValueError(f"{path.name} holds no triangles: export the part as a solid")
    if count > MAX_TRIANGLES:
        raise too_many(path.name, count)


def _obj(path: Path, head: bytes, size: int) -> None:
    """Check that OBJ is text, and that faces follow the last corners: where it is cut off among corners, the objects
    before are whole. Corners behind the last face are told where the file says by itself that it is whole."""
    if b"\0" in head:
        raise ValueError(f"{path.name} is no OBJ file: it is not text")
    _check_points(path.name, rb"^\s*v\s", head)
    with path.open("rb") as file:
        file.seek(max(0, size - OBJ_TAIL))
        tail = b"\n" + file.read()
    last = {kind: max(tail.rfind(b"\n" + kind), tail.rfind(b"\r" + kind)) for kind in (b"v ", *OBJ_ELEMENTS)}
    if last.pop(b"v ") <= (used := max(last.values())):
        return
    text = path.read_bytes()
    if used < 0 and b"\nf " not in text:
        return
    corners = len(re.findall(rb"^v\s", text, re.M))
    counts = {int(number) for pair in _OBJ_COUNTS.findall(text) for number in pair if number}
    if tail.rstrip().rpartition(b"\n")[2].startswith(b"#") or corners in counts:
        warnings.warn(
            f"{path.name}: behind its last face come corners that no face has, which are left out; where parts are "
            "missing it is cut off: copy or export it again",
            stacklevel=_CALLER,
        )
        return
    raise ValueError(
        f"{path.name} is cut off: behind its last face come corners that no face has; copy or export it again, or, if "
        "it is whole, add the line '# end' at its end"
    )


def _check_points(name: str, begin: bytes, head: bytes) -> None:
    """Refuse numbers with decimal commas in lines of a text that begin in a way."""
    if comma := re.search(begin + rb"[^\r\n]*?([+-]?\d+,\d+)", head, re.I | re.M):
        raise ValueError(
            f"{name} has numbers with commas, such as {comma[1].decode()!r}, and readers expect decimal points: export "
            "it with the settings of a language that has them, or replace the commas"
        )


def _ply(path: Path, head: bytes, size: int) -> None:
    """Check that the elements that the header of PLY announces, of a byte each at least, fit into the file."""
    if not re.match(rb"ply\s*[\r\n]", head):
        raise ValueError(f"{path.name} is no PLY file: it does not begin with ply")
    end = re.search(rb"end_header[^\n]*\n", head)
    if not end:
        raise ValueError(f"{path.name} is no PLY file, or cut off: its header has no end")
    for element, count in re.findall(rb"^element\s+(\w+)\s+(\d+)", head[: end.start()], re.M):
        if int(count) > size - end.end():
            raise ValueError(
                f"{path.name} is damaged or cut off: its header announces {int(count)} of {element.decode()}, but "
                f"{size - end.end()} bytes follow; copy or export it again"
            )
        if element == b"face" and int(count) > MAX_TRIANGLES:
            raise too_many(path.name, int(count))
    if re.search(rb"^format\s+ascii", head, re.M):
        _check_points(path.name, rb"^(?=\s*[+-]?\d)", head[end.end() :])


def _3mf(path: Path, head: bytes, size: int) -> str:
    """Check that the archive of 3MF holds a model and unpacks to no more than `MAX_MESH_BYTES`; return its unit."""
    try:
        unpacked, start = _unpacked(path)
    except Exception as error:  # the unpackers raise whatever a damaged archive makes them stumble over
        why = " ".join(str(error).split())[:200] or type(error).__name__
        raise ValueError(f"{path.name} is damaged or no 3MF file: {why}; copy or export it again") from None
    if unpacked > MAX_MESH_BYTES:
        raise ValueError(
            f"{path.name} unpacks to {unpacked / 1e6:.0f} MB, more than {MAX_MESH_BYTES / 1e6:.0f}: export it coarser"
        )
    if start is None:
        raise ValueError(f"{path.name} is no 3MF file: there is no 3D/3dmodel.model in it")
    root = re.search(rb"<(?:\w+:)?model\b[^>]*>", start)
    said = re.search(rb"\bunit\s*=\s*[\"'](\w+)[\"']", root[0]) if root else None
    unit = said[1].decode() if said else "millimeter"  # the default of the format
    if unit not in UNITS:
        raise ValueError(f"{path.name} is in the length unit {unit!r}: export it in {', '.join(UNITS)}")
    return UNITS[unit]


def _unpacked(path: Path) -> tuple[int, bytes | None]:
    """Find the stated bytes of all members of an archive, where reading them ends, and how its model begins, if any."""
    with zipfile.ZipFile(path) as archive:
        size = sum(member.file_size for member in archive.infolist())
        models = [name for name in archive.namelist() if "3d/3dmodel.model" in name.lower()]
        if not models:
            return size, None
        with archive.open(models[0]) as model:
            return size, model.read(20_000)


def _glb(path: Path, head: bytes, size: int) -> str:
    """Check that GLB has the length that its header states; return its unit."""
    if head[:4] != b"glTF":
        raise ValueError(f"{path.name} is no GLB file: it does not begin with glTF")
    stated = int.from_bytes(head[8:12], "little")
    if stated != size:
        raise ValueError(
            f"{path.name} is damaged or cut off: its header announces {stated} bytes, but it has {size}; "
            "copy or export it again"
        )
    return "m"  # of the format


def _dae(path: Path, head: bytes, size: int) -> str:
    """Check the first element of COLLADA; return the unit in which it is read."""
    if b"<COLLADA" not in head or b"<!DOCTYPE" in head:
        raise ValueError(f"{path.name} is no COLLADA file: expected <COLLADA> as its first element, and no DOCTYPE")
    return "m"  # corners are read in metres, whatever unit the file has
