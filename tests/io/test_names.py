"""Names of parts: cleaned, numbered, found by globs and by the sub-assemblies that they are in."""

import json
from typing import NamedTuple

import pytest

import jaxkin as jk
from jaxkin._names import match_parts
from jaxkin.io.names import MAX_NAME_LETTERS, cleaned, is_damaged, unique
from jaxkin.io.step_glb import instances


@pytest.mark.parametrize("name", ["crank", "Laserteil 2:1", "Kurbel groß", "bolt#2", "曲柄", "a/b"])
def test_a_clean_name_stays_as_it_is(name: str) -> None:
    assert cleaned(name) == name
    assert not is_damaged(name)


def test_what_nobody_typed_is_replaced_and_white_space_becomes_one_blank() -> None:
    assert cleaned(" base\tplate\r\n 2 ") == "base plate 2"
    assert cleaned("Pe\x87a:1") == "Pe_a:1"
    assert cleaned("\x10L") == "_L"
    assert cleaned("zero\u200bwidth\ufeff") == "zerowidth"
    assert is_damaged("a\x00b") and is_damaged("a\ufffd") and not is_damaged("a\tb")


def test_long_names_are_shortened_and_stay_apart() -> None:
    names = unique(cleaned("A" * 100 + end) for end in ("left", "right", "left"))
    assert all(len(name) <= MAX_NAME_LETTERS + len("#2") for name in names)
    assert len(set(names)) == 3
    assert names[0].endswith("left") and names[1].endswith("right") and names[2] == names[0] + "#2"
    assert cleaned("A" * MAX_NAME_LETTERS) == "A" * MAX_NAME_LETTERS


class Named(NamedTuple):
    """Of a part only what names it."""

    name: str
    path: tuple[str, ...]


PARTS = [
    Named(name, path)
    for name, path in (
        ("Base", ()),
        ("Base 2", ("Robot", "Arm")),
        ("Link", ("Robot", "Arm")),
        ("Pin", ("Robot", "Arm", "Joint")),
        ("Link#2", ("Robot", "Leg")),
        ("[odd]*", ()),
    )
]


@pytest.mark.parametrize(
    ("patterns", "names"),
    [
        ("Base", ("Base",)),
        ("Base*", ("Base", "Base 2")),
        ("Arm/Base*", ("Base 2",)),
        ("Arm/*", ("Base 2", "Link", "Pin")),
        ("Robot/Arm/Link", ("Link",)),
        ("Robot/*/Link*", ("Link", "Link#2")),
        ("[odd]*", ("[odd]*",)),
        (["Link#?", "Link*", "Base"], ("Link#2", "Link", "Base")),
    ],
)
def test_patterns(patterns: str | list[str], names: tuple[str, ...]) -> None:
    assert match_parts(patterns, PARTS) == names


@pytest.mark.parametrize("pattern", ["Bose", "rm/Base*", "Arm/Lonk", "Nothing*", 3])
def test_a_pattern_without_a_match_is_an_error_that_names_it(pattern: object) -> None:
    with pytest.raises(ValueError, match="fixed names"):
        match_parts([pattern], PARTS, "fixed")  # pyright: ignore[reportArgumentType]


def test_the_message_tells_the_nearest_name_or_path() -> None:
    with pytest.raises(ValueError, match="did you mean 'Base'"):
        match_parts("Bose", PARTS)
    with pytest.raises(ValueError, match="did you mean 'Robot/Arm/Link'"):
        match_parts("Robot/Arm/Lonk", PARTS)


def _glb(nodes: list[dict[str, object]], roots: list[int]) -> bytes:
    """A binary glTF of nodes around one mesh without faces."""
    tree = {
        "scenes": [{"nodes": roots}],
        "nodes": nodes,
        "meshes": [{"name": "Bolt", "primitives": [{"indices": 0}]}],
        "accessors": [{"count": 3}],
    }
    text = json.dumps(tree).encode()
    return bytes(12) + len(text).to_bytes(4, "little") + b"JSON" + text + bytes(8)


def test_the_path_of_a_part_is_of_the_assemblies_below_that_of_the_file() -> None:
    nodes = [
        {"name": "File", "children": [1, 2, 4, 5]},
        {"name": "Top", "mesh": 0},
        {"name": "Arm", "children": [3]},
        {"name": "Pin", "mesh": 0},
        {"name": "Arm", "children": [3]},
        {"name": " Le\x02g\n 1", "children": [6]},
        {"name": "", "children": [7]},
        {"name": "Joint", "children": [3]},
    ]
    paths = [instance.path for instance in instances(_glb(nodes, [0]))]
    assert paths == [(), ("Arm",), ("Arm#2",), ("Le_g 1", "assembly", "Joint")]
    assert [instance.path for instance in instances(_glb(nodes, [1, 2]))] == [(), ("Arm",)]


@pytest.mark.parametrize("name", ["c\t", "c ", " c", "a  b", "a\nb", "a\u200bb", "a\x00"])
@pytest.mark.parametrize("suffix", [".urdf", ".xml", ".asmt"])
def test_names_that_files_of_robots_would_change_are_refused(tmp_path, suffix, name):
    write = {".urdf": jk.write_urdf, ".xml": jk.write_mjcf, ".asmt": jk.write_asmt}[suffix]
    for part, joint in ((name, "A"), ("c", name)):
        hinge = jk.revolute(joint, "g", part, point=(0, 0, 0), axis=(0, 0, 1))
        mechanism = jk.Mechanism.build(fixed=["g"], joints=[hinge])
        with pytest.raises(ValueError, match="would be read back as") as refused:
            write(mechanism, tmp_path / f"model{suffix}")
        assert repr(name) in str(refused.value)
    assert not list(tmp_path.iterdir())
    assert jk.load(mechanism.save(tmp_path / "m.json")).mechanism().joints.keys() == {name}
