"""Screws, pins and washers are told from parts that have work to do, and rest; `tests/io/data/fasteners.step`."""

from ast import literal_eval
from dataclasses import replace
from pathlib import Path
from random import Random

import jax
import numpy as np
import pytest
import trimesh

import jaxkin as jk
from jaxkin.assembly.at_rest import left_at_rest
from jaxkin.assembly.needless import with_spinning
from jaxkin.examples import path
from jaxkin.geometry.part import Part
from reference.mechanisms import rssr_linkage

FASTENERS = ("washer", "screw", "long screw", "loose washer")


@pytest.fixture(scope="module")
def assembly():
    return jk.load(Path(__file__).parents[1] / "io" / "data" / "fasteners.step")


@pytest.fixture(scope="module")
def mechanism(assembly):
    return assembly.mechanism(fixed=["base"], infer=False)


@pytest.mark.long
def test_fasteners_are_named_and_the_arm_is_not(mechanism):
    """One turn each of the washer and the screws; the loose washer slides on its face as well."""
    mobility = mechanism.mobility()
    assert mobility.spinning == FASTENERS
    assert (mobility.freedoms, mobility.spins, mobility.useful) == (7, 6, 1)
    assert mobility.idle == ()
    assert "only turn or slide by themselves: washer, screw, long screw, loose washer" in str(mobility)


def test_they_close_no_loops_and_rest(mechanism):
    """The washer lies between the arm, which turns, and the base: it stays on the base."""
    assert len(mechanism.structure.loops) == 0
    motion = mechanism.sweep({"base-arm": [0.0, 1.0, 2.0]})
    for part in FASTENERS:
        still = np.broadcast_to(np.eye(4), (3, 4, 4))
        np.testing.assert_allclose(motion.transforms[part], still, atol=1e-13)  # mm, rounding of the frames
    assert any("'washer' only spins" in note and "'arm'" in note for note in mechanism.notes)


def test_they_can_still_be_driven(mechanism):
    turn = np.linspace(0.0, 1.0, 3)
    motion = mechanism.sweep({"base-washer": turn})
    np.testing.assert_allclose(np.trace(motion.transforms["washer"][:, :3, :3].T), 1 + 2 * np.cos(turn), atol=1e-15)


def test_rigid_fixes_them_for_good(assembly):
    fixed = assembly.mechanism(fixed=["base"], rigid=[["base", *FASTENERS]], infer=False)
    assert fixed.fixed == ("base", *FASTENERS)
    assert [joint.name for joint in fixed.all_joints] == ["base-arm"]
    assert (fixed.mobility().freedoms, fixed.mobility().spinning) == (1, ())


def test_one_joint_a_contact_keeps_every_contact(assembly):
    """The paper's way: nothing is left out, and the same parts are named."""
    apart = assembly.mechanism(fixed=["base"], combine=False)
    assert len(apart.all_joints) == len(assembly.contacts())
    mobility = apart.mobility()
    assert (mobility.spinning, mobility.useful) == (FASTENERS, 1)


@pytest.mark.long
@pytest.mark.parametrize("name, fixed", [("fourbar", "ground"), ("slider_crank", "ground"), ("cam", "frame")])
def test_parts_with_work_to_do_are_not_taken_for_fasteners(name, fixed):
    """The disc of the cam is round, but not about its shaft; cranks and rods hold each other."""
    assert jk.load(path(name)).mechanism(fixed=[fixed]).mobility().spinning == ()


def solid(name, radius, length, square=False):
    """A round or square bar along z."""
    sections = 4 if square else 24
    return Part(name, (), trimesh.creation.cylinder(radius, length, sections=sections).triangles)


def hinge(*, second: bool):
    """A link on a pin of its own, held by it alone, or by a second pin through both as well."""

    def pin(name, one, other):
        return jk.cylindrical(name, one, other, point=(0, 0, 0), axis=(0, 0, 1))

    joints = [pin("A", "base", "pin"), pin("B", "pin", "link"), jk.planar("C", "base", "link", normal=(0, 0, 1))]
    made = jk.Mechanism.build(fixed=["base"], joints=[*joints, *([pin("D", "base", "link")] if second else [])])
    solids = solid("base", 9, 1, True), solid("pin", 1, 6), solid("link", 5, 2, True)
    return with_spinning(replace(made, solids=solids))


def test_the_only_pin_of_a_hinge_is_needed_and_a_second_one_is_not():
    needed, idle = (hinge(second=second).mobility() for second in (False, True))
    assert needed.spinning == () and needed.freedoms == 3  # the hinge; the pin turns and slides
    assert idle.spinning == ("pin",) and (idle.spins, idle.useful) == (2, 1)


def test_nothing_is_guessed_without_solids():
    assert rssr_linkage().mobility().spinning == ()
    assert with_spinning(replace(hinge(second=True), solids=())).mobility().spinning == ()


def test_what_was_found_from_solids_outlives_them():
    """JAX leaves the solids behind; the mobility is the same."""
    mechanism = hinge(second=True)
    taken_apart = jax.tree.map(lambda leaf: leaf, mechanism)
    assert taken_apart.solids == () and taken_apart.mobility() == mechanism.mobility()


@pytest.fixture(scope="module")
def flanges():
    """Two flanges and six bolts of 20 mm with nuts in holes of 22 mm: the assembly and its contacts."""
    assembly = jk.load(Path(__file__).parents[1] / "io" / "data" / "flanges.step")
    return assembly, assembly.contacts(fit=0.11)


@pytest.fixture(scope="module")
def bolted(flanges):
    assembly, contacts = flanges
    return assembly.mechanism(fixed=["lower"], contacts=contacts, infer=False)


@pytest.mark.long
def test_bolts_of_which_each_is_unneeded_still_hold_together(bolted):
    """Twelve spins of bolts and nuts and nothing else: two bolts stay in both flanges and hold them."""
    mobility = bolted.mobility()
    assert (mobility.freedoms, mobility.useful) == (12, 0)
    assert "upper" not in mobility.spinning and all("phi" in name for name in mobility.idle)
    kept = {joint.parts[1] for joint in bolted.all_joints if joint.parts[0] == "upper"}
    assert len(kept) == 2 and all(part.startswith("bolt") for part in kept)
    (note,) = [note for note in bolted.notes if "kept with all contacts" in note]
    assert all(repr(part) in note for part in kept)
    with pytest.raises(ValueError, match=r"lower-upper\.x has no freedom left to it"):
        bolted.sweep({"lower-upper.x": [0.0, 40.0]})


@pytest.mark.long
def test_what_is_left_at_rest_frees_nothing(flanges, bolted):
    """As many freedoms as with every contact a joint, as in the paper."""
    assembly, contacts = flanges
    every = assembly.mechanism(fixed=["lower"], contacts=contacts, combine=False)
    assert len(every.all_joints) == len(contacts)
    assert every.mobility().freedoms == bolted.mobility().freedoms


@pytest.mark.long
@pytest.mark.parametrize("seed", range(3))
def test_which_parts_are_left_at_rest_depends_on_neither_order_nor_names(flanges, bolted, seed):
    assembly, contacts = flanges
    random = Random(seed)
    new = dict(zip(assembly.names, random.sample([f"part {k}" for k in range(99)], len(assembly.names)), strict=True))
    parts = [replace(part, name=new[part.name]) for part in assembly.parts]
    others = [replace(contact, parts=tuple(new[part] for part in contact.parts)) for contact in contacts]
    random.shuffle(parts)
    random.shuffle(others)
    again = replace(assembly, parts=tuple(parts)).mechanism(fixed=[new["lower"]], contacts=others, infer=False)
    assert joined(again) == {(kind, frozenset(new[part] for part in pair)) for kind, pair in joined(bolted)}
    assert again.mobility().freedoms == 12


def joined(mechanism):
    return {(joint.kind, frozenset(joint.parts)) for joint in mechanism.all_joints}


@pytest.mark.parametrize("name", ["fasteners", "flanges"])
def test_parts_at_rest_can_be_connected_as_the_notes_say(name, request, mechanism, assembly):
    """All at once: the same freedoms of use, and nothing is left to be said of these parts."""
    options = {}
    if name == "flanges":
        assembly, contacts = request.getfixturevalue("flanges")
        mechanism, options = request.getfixturevalue("bolted"), {"contacts": contacts}
    said = [note for note in mechanism.notes if "for good with rigid=" in note]
    rigid = [pair for note in said for pair in literal_eval(note[note.index("[[") :])]
    assert rigid and all(len(pair) == 2 for pair in rigid)
    found = assembly.mechanism(fixed=mechanism.fixed, rigid=rigid, infer=False, **options)
    assert found.mobility().useful == mechanism.mobility().useful
    assert not {part for _, part in rigid} & set(found.mobility().spinning)


def ringed(order):
    """A hinge of two pins, one of them in a ring between the two parts, and a ring on that ring."""
    z = (0, 0, 1)
    joints = [
        jk.cylindrical("A", "base", "pin", point=(0, 0, 0), axis=z),
        jk.cylindrical("B", "pin", "link", point=(0, 0, 0), axis=z),
        jk.cylindrical("C", "pin", "ring", point=(0, 0, 0), axis=z),
        jk.planar("D", "base", "ring", normal=z),
        jk.planar("E", "ring", "link", normal=z),
        jk.cylindrical("F", "ring", "outer", point=(0, 0, 0), axis=z),
        jk.planar("G", "base", "outer", normal=z),
        jk.planar("H", "outer", "link", normal=z),
        jk.planar("I", "base", "link", normal=z),
        jk.cylindrical("J", "base", "link", point=(0, 0, 0), axis=z),
    ]
    solids = {"base": solid("base", 9, 1, True), "link": solid("link", 5, 2, True)}
    solids |= {name: solid(name, k + 1, 6 - k) for k, name in enumerate(("pin", "ring", "outer"))}
    joints = [joints[k] for k in order]
    made = jk.Mechanism.build(fixed=["base"], joints=joints)
    return replace(made, solids=tuple(solids.values()), contacts={joint.name: () for joint in joints})


@pytest.mark.parametrize("seed", range(6))
def test_a_part_may_rest_on_one_that_rests_itself(seed):
    """Whichever is met first."""
    order = list(range(10))
    Random(seed).shuffle(order)
    made = ringed(order if seed else range(10))
    rested, made = with_spinning(left_at_rest(made)), with_spinning(made)
    assert rested.mobility().spinning and rested.mobility().useful == made.mobility().useful == 1
    assert rested.mobility().freedoms == made.mobility().freedoms
    for part in ("pin", "ring", "outer"):
        (mine,) = [joint for joint in rested.all_joints if part in joint.parts]
        assert "base" in mine.parts


def test_joints_by_hand_are_not_taken_away():
    """A ring that is welded on: only parts all of whose joints are contacts rest."""
    made = ringed(range(10))
    given = replace(made, contacts={name: () for name in made.contacts if name != "C"})
    assert "C" in [joint.name for joint in left_at_rest(given).all_joints]


WHEELS = """<mujoco><worldbody>
  <body name="arm"><joint name="a" axis="0 1 0"/><geom type="box" size=".4 .05 .02"/>
    <body name="wheel" pos=".3 0 0"><joint name="w" axis="0 0 1"/><geom type="sphere" size=".1"/></body></body>
</worldbody>{}</mujoco>"""


def test_a_round_part_that_a_coupling_ties_does_not_spin_by_itself(tmp_path):
    """A wheel on an arm: two freedoms, of which a coupling leaves one, and that one moves both."""
    (tmp_path / "free.xml").write_text(WHEELS.format(""))
    free = jk.load(tmp_path / "free.xml").mechanism().mobility()
    assert (free.freedoms, free.spinning, free.useful, free.drivable) == (2, ("wheel",), 1, ("a.phi",))
    tie = '<equality><joint joint1="w" joint2="a" polycoef="0 2 0 0 0"/></equality>'
    (tmp_path / "tied.xml").write_text(WHEELS.format(tie))
    tied = jk.load(tmp_path / "tied.xml").mechanism().mobility()
    assert (tied.freedoms, tied.spinning, tied.useful) == (1, (), 1) and len(tied.drivable) == 1
    assert "spin" not in str(tied)
    again = jk.load(tmp_path / "free.xml").mechanism().with_couplings([jk.gear("a", "w", 2.0)]).mobility()
    assert (again.freedoms, again.spinning, again.useful) == (1, (), 1)
