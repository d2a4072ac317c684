"""Files of every format that is read, damaged at random and by seed: `mutated(kind, seed)` is always the same file."""

from __future__ import annotations

import io
import re
import struct
import zipfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import trimesh

from jaxkin.examples import EXAMPLES, path

DATA = Path(__file__).parent / "io" / "data"
FIXTURES = ("ball", "fasteners", "fillet", "halves", "nested", "painted", "sheet", "solids", "splines")
"""Named one by one: another file there would change what every seed stands for."""

KINDS = ("step", "stl", "obj", "ply", "3mf", "glb", "toml")

NUMBER = re.compile(rb"(?<![\w#.+-])[+-]?\d+\.?\d*(?:[eE][+-]?\d+)?")
REFERENCE = re.compile(rb"#\d+")

SPECIAL = (b"0", b"0.", b"-1", b"1", b"nan", b"inf", b"-1e308", b"1e-300", b"1e15", b"4294967295", b"-", b"1..2", b"$")
"""What is written in place of a number."""

STUDY = """
geometry = "{file}"
unit = "mm"
fixed = ["ground"]
rigid = [["coupler", "rocker"]]
ignore = [["crank", "coupler"]]
combine = false
tolerance = {{ length = 0.01, angle = 1e-3, fit = 0.05 }}

[rename]
rocker = "Schwinge"

[joints.slide]
kind = "prismatic"
parts = ["crank", "coupler"]
axis = [0, 0, 1]

[joints.hinge]
kind = "revolute"
parts = ["ground", "crank"]
point = [1.5, 0, 0]
axis = [0, 0.6, 0.8]

[drive]
ground-crank = "0:90:4"
"ground-crank:e.phi" = {{ from = 0, to = 0.25, poses = 3, unit = "turn" }}
"ground-crank:e.z" = [0, 1, 2]
"""

Random = np.random.Generator
Mutation = Callable[[bytes, Random], bytes]


def mutated(kind: str, seed: int) -> tuple[bytes, str]:
    """The content of a damaged file of a kind, and what it was and what was done to it."""
    rng = np.random.default_rng((KINDS.index(kind), seed))
    names = sorted(_shipped(kind))
    name = names[rng.integers(len(names))]
    content = _shipped(kind)[name]
    known = _MUTATIONS[kind]
    done = []
    for _ in range(int(rng.choice((1, 1, 1, 2, 4)))):
        mutation = known[rng.integers(len(known))]
        content = mutation(content, rng)
        done.append(mutation.__name__)
    return content, f"{name}: {', '.join(done)}"


@cache
def _shipped(kind: str) -> dict[str, bytes]:
    """Sound files of a kind by name."""
    if kind == "step":
        files = [*(DATA / f"{name}.step" for name in FIXTURES), *(path(name) for name in EXAMPLES)]
        return {file.stem: file.read_bytes() for file in files if file.stat().st_size < 160_000}
    if kind == "toml":
        return {"study": STUDY.format(file=path("fourbar").as_posix()).encode()}
    scene = _scene()
    solid = scene.to_mesh()
    if kind == "stl":
        text, binary = solid.export(file_type="stl_ascii"), solid.export(file_type="stl")
        return {"text": text.encode(), "binary": binary}
    if kind == "ply":
        return {name: solid.export(file_type="ply", encoding=name) for name in ("ascii", "binary")}
    packed = scene.export(file_type=kind)
    if kind == "3mf":  # without the names by which trimesh tells one export from another
        packed = _archive({name: re.sub(rb' p:UUID="[^"]*"', b"", text) for name, text in _members(packed).items()})
    return {"scene": packed.encode() if isinstance(packed, str) else packed}


def _members(content: bytes) -> dict[str, bytes]:
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def _archive(members: dict[str, bytes]) -> bytes:
    """An archive in which no time stands."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w") as archive:
        for name, member in members.items():
            archive.writestr(zipfile.ZipInfo(name), member, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()


def _scene() -> trimesh.Scene:
    """A box, a pin and a tube, each a node, small enough to be read in a moment."""
    scene = trimesh.Scene()
    for place, (name, mesh) in enumerate(
        {
            "box": trimesh.creation.box((10.0, 20.0, 30.0)),
            "pin": trimesh.creation.cylinder(4.0, 12.0, sections=24),
            "tube": trimesh.creation.annulus(4.0, 8.0, 12.0, sections=24),
        }.items()
    ):
        pose = np.eye(4)
        pose[0, 3] = 40.0 * place
        scene.add_geometry(mesh, node_name=name, geom_name=name, transform=pose)
    return scene


def flipped_bytes(content: bytes, rng: Random) -> bytes:
    changed = bytearray(content)
    for place in rng.integers(len(content), size=int(rng.choice((1, 3, 30)))):
        changed[place] = rng.integers(256)
    return bytes(changed)


def flipped_letters(content: bytes, rng: Random) -> bytes:
    changed = bytearray(content)
    for place in rng.integers(len(content), size=int(rng.choice((1, 3, 30)))):
        changed[place] = rng.integers(32, 127)
    return bytes(changed)


def _span(content: bytes, rng: Random) -> tuple[int, int]:
    start = int(rng.integers(len(content)))
    return start, start + int(rng.choice((1, 10, 300, 3000)))


def deleted(content: bytes, rng: Random) -> bytes:
    start, end = _span(content, rng)
    return content[:start] + content[end:]


def repeated(content: bytes, rng: Random) -> bytes:
    start, end = _span(content, rng)
    return content[:end] + content[start:end] * int(rng.choice((1, 50))) + content[end:]


def moved(content: bytes, rng: Random) -> bytes:
    start, end = _span(content, rng)
    rest = content[:start] + content[end:]
    place = int(rng.integers(len(rest) + 1))
    return rest[:place] + content[start:end] + rest[place:]


def cut_off(content: bytes, rng: Random) -> bytes:
    return content[: int(rng.integers(len(content)))]


def without_middle(content: bytes, rng: Random) -> bytes:
    start, end = sorted(rng.integers(len(content), size=2))
    return content[:start] + content[end:]


def _replaced(content: bytes, rng: Random, pattern: re.Pattern[bytes], new: Callable[[bytes], bytes]) -> bytes:
    """One, or several, of the places where the pattern matches, with something else there."""
    found = list(pattern.finditer(content))
    if not found:
        return content
    for k in sorted(set(rng.integers(len(found), size=int(rng.choice((1, 1, 5))))), reverse=True):
        start, end = found[k].span()
        content = content[:start] + new(content[start:end]) + content[end:]
    return content


def special_numbers(content: bytes, rng: Random) -> bytes:
    return _replaced(content, rng, NUMBER, lambda _: SPECIAL[rng.integers(len(SPECIAL))])


def scaled_numbers(content: bytes, rng: Random) -> bytes:
    factor = float(rng.choice((-1.0, 0.5, 1e-6, 1e6, 1.001)))
    return _replaced(content, rng, NUMBER, lambda number: repr(float(number) * factor).encode())


def swapped_numbers(content: bytes, rng: Random) -> bytes:
    others = NUMBER.findall(content)
    return _replaced(content, rng, NUMBER, lambda _: others[rng.integers(len(others))])


def other_references(content: bytes, rng: Random) -> bytes:
    others = [*REFERENCE.findall(content), b"#99999999"]
    return _replaced(content, rng, REFERENCE, lambda _: others[rng.integers(len(others))])


def _lines(content: bytes, rng: Random) -> tuple[list[bytes], np.ndarray]:
    lines = content.splitlines(keepends=True)
    return lines, rng.integers(len(lines), size=int(rng.choice((1, 1, 10))))


def deleted_lines(content: bytes, rng: Random) -> bytes:
    lines, chosen = _lines(content, rng)
    return b"".join(line for k, line in enumerate(lines) if k not in chosen)


def repeated_lines(content: bytes, rng: Random) -> bytes:
    lines, chosen = _lines(content, rng)
    return b"".join(line * (2 if k in chosen else 1) for k, line in enumerate(lines))


def exchanged_lines(content: bytes, rng: Random) -> bytes:
    lines, chosen = _lines(content, rng)
    for k in chosen:
        other = int(rng.integers(len(lines)))
        lines[k], lines[other] = lines[other], lines[k]
    return b"".join(lines)


def repeated_knots(content: bytes, rng: Random) -> bytes:
    """The numbers of a list made equal, or turned round: what a knot vector must not be."""

    def new(listed: bytes) -> bytes:
        numbers = listed.strip(b"()").split(b",")
        numbers = numbers[::-1] if rng.integers(2) else [numbers[0]] * len(numbers)
        return b"(" + b",".join(numbers) + b")"

    return _replaced(content, rng, re.compile(rb"\([\d.eE+-]+(?:,[\d.eE+-]+)+\)"), new)


def other_keywords(content: bytes, rng: Random) -> bytes:
    others = re.findall(rb"\b[A-Z]\w{4,}\b", content)
    return _replaced(content, rng, re.compile(rb"\b[A-Z]\w{4,}\b"), lambda _: others[rng.integers(len(others))])


def other_words(content: bytes, rng: Random) -> bytes:
    words = [b"true", b"[]", b"[[1]]", b"{}", b'"x"', b"[1, 'a']", b"1979-05-27", "Ü\u202e".encode(), b"[" * 2000]
    return _replaced(content, rng, re.compile(rb"(?<== ).+|\b\w+\b"), lambda _: words[rng.integers(len(words))])


def other_counts(content: bytes, rng: Random) -> bytes:
    """A count of the header of binary STL, or of what is announced in words."""
    count = int(rng.choice((0, 1, 7, 2**16, 2**31 - 1, 2**32 - 1)))
    if not re.match(rb"ply|solid", content):
        return content[:80] + struct.pack("<I", count) + content[84:]
    return _replaced(content, rng, re.compile(rb"(?<=vertex )\d+|(?<=face )\d+"), lambda _: b"%d" % count)


def _packed_again(change: Mutation) -> Mutation:
    """A mutation of the largest file in an archive, which is whole again with right sums."""

    def within(content: bytes, rng: Random) -> bytes:
        try:
            members = _members(content)
            largest = max(members, key=lambda name: len(members[name]))
        except Exception:  # damaged by a mutation before
            return content
        members[largest] = change(members[largest], rng)
        return _archive(members)

    within.__name__ = f"{change.__name__} in the archive"
    return within


def _in_chunk(change: Mutation, chunk: int) -> Mutation:
    """A mutation of the tree (0) or the numbers (1) of a GLB file, whose lengths are right again."""

    def within(content: bytes, rng: Random) -> bytes:
        length = int.from_bytes(content[12:16], "little")
        chunks = [content[20 : 20 + length], content[28 + length :]]
        if not chunks[chunk]:
            return content
        chunks[chunk] = change(chunks[chunk], rng)
        text, binary = chunks[0] + b" " * (-len(chunks[0]) % 4), chunks[1] + bytes(-len(chunks[1]) % 4)
        body = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", len(binary), b"BIN\0") + binary
        return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body

    within.__name__ = f"{change.__name__} in its {'tree' if chunk == 0 else 'numbers'}"
    return within


_ANY = (flipped_bytes, deleted, repeated, moved, cut_off, without_middle)
_LINES = (deleted_lines, repeated_lines, exchanged_lines)
_TEXT = (*_ANY, flipped_letters, special_numbers, scaled_numbers, swapped_numbers, *_LINES)
_MUTATIONS: dict[str, tuple[Mutation, ...]] = {
    "step": (*_TEXT, other_references, other_references, repeated_knots, other_keywords),
    "stl": (*_TEXT, other_counts),
    "obj": _TEXT,
    "ply": (*_TEXT, other_counts),
    "3mf": (*_ANY, *map(_packed_again, _TEXT)),
    "glb": (*_ANY, *(_in_chunk(change, 0) for change in _TEXT), *(_in_chunk(change, 1) for change in _ANY)),
    "toml": (*_TEXT, other_words, other_words),
}
