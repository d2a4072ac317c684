"""Reports of large assemblies: counts first, one of a kind, and nothing lost where all is asked for."""

import numpy as np
import pytest
import trimesh

import jaxkin as jk
from jaxkin._grouped import MAX_LINES, SCREEN, grouped, kind_of, products, shortened
from jaxkin.assembly.assembly import Assembly
from jaxkin.geometry.part import Part

BOX = trimesh.creation.box((1.0, 1.0, 1.0)).triangles


@pytest.mark.parametrize(
    ("one", "other"),
    [
        *[("Screw <2>", "Screw <3>"), ("Screw", "Screw#2"), ("Screw(12)", "Screw(1)"), ("Screw:1#2", "Screw:1")],
        *[("Screw_1", "Screw_2"), ("Screw-0", "Screw-1"), ("Screw", "Screw 2"), ("Screw.001", "Screw.002")],
    ],
)
def test_instances_are_of_one_product(one, other):
    assert products([one, other]) == {one: "Screw", other: "Screw"}


@pytest.mark.parametrize("name", ["12", "M5", "p1", "Plate 1"])
def test_what_is_only_a_number_or_belongs_to_the_name_stays(name):
    assert products([name, f"{name}:2", f"{name}:2#3"]) == dict.fromkeys([name, f"{name}:2", f"{name}:2#3"], name)


@pytest.mark.parametrize(
    "names",
    [
        ["Nut 5/16", "Nut 1/2", "Socket Screw 1/2"],
        ["Hex Bolt 3/8-16 x 1", "Hex Bolt 3/8-16 x 2", "Hex Bolt 3/8-16 x 4"],
        ["Clevis Pin 12", "Clevis Pin 16"],
        ["Dowel 5x27.0", "Dowel 5x27.1"],
        ["Washer ISO 7089 - 10", "Washer ISO 7089 - 12"],
        ["ISO 4017 M10 x 35", "ISO 4017 M10 x 40"],
    ],
)
def test_sizes_and_fractions_of_an_inch_are_the_names_of_products(names):
    """With and without others of the same product, which readers number."""
    for some in ([names[0]], names):
        numbered = [each for name in some for each in (name, f"{name}#2")]
        assert products(numbered) == {each: each.partition("#")[0] for each in numbered}


def test_texts_of_one_kind():
    one, other = "face 3: a gap of 0.5 to 'pin 1'", "face 41: a gap of 1.2e-05 to 'pin 22'"
    assert kind_of(one) == kind_of(other) != kind_of("face 3: tilted by 0.5 to 'pin 1'")


def test_of_many_entries_there_is_one_a_kind_and_the_counts_add_up():
    entries = [(k % 3, f"entry {k}") for k in range(100)]
    lines = grouped(entries)
    assert lines == ["34 such as  entry 0", "33 such as  entry 1", "33 such as  entry 2"]
    assert grouped(entries, verbose=True) == [text for _, text in entries]
    assert grouped(entries[:SCREEN]) == [text for _, text in entries[:SCREEN]]


def test_lists_end():
    names = [f"part {k}" for k in range(100)]
    assert shortened(names)[-1] == f"and {100 - MAX_LINES} more" and shortened(names[:SCREEN]) == names[:SCREEN]


@pytest.fixture(scope="module")
def many():
    """A base, an arm, and 200 boxes of two products, each with a note, half on the base and half on the arm."""
    names = ["base", "arm", *(f"{name} <{k}>" for k in range(100) for name in ("bolt", "nut"))]
    parts = tuple(
        Part(name, (), BOX + 3.0 * place, None, (f"face {place}: torus, not one of the four surfaces",))
        for place, name in enumerate(names)
    )
    return Assembly(parts, "mm", "many.step")


def test_an_assembly_of_200_parts_fits_on_a_screen_and_all_of_it_can_be_had(many):
    text = str(many)
    assert len(text.splitlines()) <= SCREEN and "bolt (100 times)" in text and "202 such as" in text
    every = many.describe(verbose=True)
    assert all(name in every for name in many.names) and len(every.splitlines()) == 1 + 2 * 202


def test_long_names_make_no_long_lines_unless_all_is_asked_for():
    """A four-bar of plates with bushes: its frame has twenty screws, each crank pin a bush of its own, each link a
    screw before it, and each hinge a slide along itself; the axes are parallel, so that the slides are idle."""
    name = "welded plate of the intermediate lever, number {}".format
    links, pins = [name(k) for k in range(4)], np.array([(0, 0, 0), (0, 40, 0), (120, 80, 0), (100, 0, 0)], float)
    bushes, screws = [f"bush {each}" for each in links], [f"screw {k}" for k in range(20)]
    parts = tuple(Part(each, (), BOX + 300.0 * place) for place, each in enumerate([*links, *bushes, *screws]))
    rigid = [*zip(links, bushes, strict=True), [links[0], *screws]]
    joints = [
        jk.cylindrical(f"{bushes[k]} in the hole of {links[k - 1]}", links[k - 1], bushes[k], point=p, axis=(0, 0, 1))
        for k, p in enumerate(pins)
    ]
    mechanism = Assembly(parts, "mm", "plates.step").of_joints(fixed=[links[0]], rigid=rigid, joints=joints)
    text, every = str(mechanism), mechanism.describe(verbose=True)
    (row,) = [line for line in text.splitlines() if line.startswith(f"  {joints[1].name} ")]
    assert f"{links[0]} - {links[1]}  cylindrical" in row  # by bodies, not by bushes
    (loop,) = [line for line in text.splitlines() if line.startswith("  over the bodies")]
    assert loop.count("welded plate") == 5 and "bush" not in loop
    (mobility,) = [line for line in text.splitlines() if line.startswith("Mobility")]
    assert len(mobility) < 500
    assert "screw 19" not in text.splitlines()[0] and " more" in text.splitlines()[0]
    assert "screw 19" in every.splitlines()[0]
    assert all(f"  idle: {each}" in every.splitlines() for each in mechanism.mobility().idle_motions)
    assert f"  {mechanism.structure.loops[0]}" in every.splitlines()


def test_its_mechanism_tells_bodies_in_place_of_what_holds_them_together(many):
    bolts, nuts = ([name for name in many.names if name.startswith(kind)] for kind in ("bolt", "nut"))
    hinge = jk.revolute("A", "base", "arm", point=(0, 0, 0), axis=(0, 0, 1))
    mechanism = many.mechanism(fixed=["base"], rigid=[["base", *bolts], ["arm", *nuts]], joints=[hinge], contacts=[])
    lines = str(mechanism).splitlines()
    assert (
        len(lines) <= SCREEN and "Bodies: 2" in lines and any(line.startswith("Mobility: 1 freedom") for line in lines)
    )
    (table,) = [line for line in lines if line.startswith("  A ")]
    assert table.split() == ["A", "base", "-", "arm", "revolute", "phi"]
    assert any(line.startswith("  arm: 101 parts, with nut <0>") and line.endswith("more") for line in lines)
    assert len(mechanism.describe(verbose=True).splitlines()) > 100
    assert np.all(mechanism.sweep({"A": np.linspace(0.0, 1.0, 3)}).closed)
