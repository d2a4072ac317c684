"""Advice is followed: what a message says to write is written, and does what was promised."""

import re
from ast import literal_eval
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import jaxkin as jk
from jaxkin.examples import path
from jaxkin.linkage.coordinates import coordinate, coordinates
from jaxkin.mechanism.describe import why_infeasible
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mobility.infeasible_drive import infeasible_drive, undriven_freedoms
from reference import catalogue
from reference.mechanisms import Z, cardan_shafts, planar_fourbar, rssr_linkage, slider_crank, spherical_linkage

LINKAGES = {
    "four-bar": planar_fourbar(),
    "four-bar of cylinders": planar_fourbar(pin=jk.cylindrical),
    "dead centre": slider_crank(0.0, offset=0.0),
    "parallelogram lying flat": planar_fourbar(0.0, ground=120.0, crank=50.0, coupler=120.0, rocker=50.0),
    "Watt": catalogue.watt(),
    "Cardan": cardan_shafts(),
    "spherical": spherical_linkage(),
    "RSSR": rssr_linkage(),
    "Delta": catalogue.delta(),
    "hexapod": catalogue.hexapod(),
}


def all_drives(mechanism):
    """What can be named: each coordinate, the angles of a ball together."""
    return [
        tuple(f"{joint.name}.{joint.coordinates[k]}" for k in group)
        for joint in mechanism.all_joints
        for group in joint.driven_together
    ]


def refusal(mechanism, keys):
    """Why a drive is refused, by its names or by its loops."""
    found = infeasible_drive(mechanism.linkage, list(coordinates(mechanism.linkage, keys).values()))
    return None if found is None else why_infeasible(mechanism, found)


def alternatives(text):
    """Names to choose from in a message, those that go together in one tuple; lists that are cut short are not read to
    their end."""
    return [tuple(each.split(" with ")) for each in re.sub(r" and \d+ more$", "", text).split(", ")]


@settings(max_examples=60, deadline=None)
@given(st.sampled_from(sorted(LINKAGES)), st.randoms(use_true_random=False))
def test_drives_that_are_advised_can_be_followed(name, random):
    """Too many, or stuck, coordinates: what the message names instead is accepted."""
    mechanism = LINKAGES[name]
    drives = all_drives(mechanism)
    keys = [key for group in random.sample(drives, min(len(drives), random.randint(1, 8))) for key in group]
    said = refusal(mechanism, keys)
    if said is None:
        return
    if only := re.search(r"drive only (.*?)(?:, or one of (.*))?$", said):
        assert refusal(mechanism, only[1].split(", ")) is None if " more" not in only[1] else True
        others = alternatives(only[2]) if only[2] else []
    else:
        others = alternatives(said.rpartition("what can be driven is ")[2])
        assert "what can be driven" in said
    for group in others:
        assert refusal(mechanism, list(group)) is None, (said, group)


@pytest.mark.parametrize("name", [pytest.param("dead centre", marks=pytest.mark.long), "four-bar"])
def test_a_drive_that_is_advised_closes(name):
    """Nearby, from the assembled pose on; a slide at its dead centre is not advised, though it may move."""
    mechanism = LINKAGES[name]
    keys = [key for group in all_drives(mechanism)[::3] for key in group]
    said = refusal(mechanism, keys)
    only, others = re.search(r"drive only (\S+), or one of (.*)$", said).groups()
    assert "S.z" not in (only, *others.split(", "))
    assert mechanism.sweep({only: np.linspace(0.0, 0.1, 3)}).closed.all()


@pytest.mark.parametrize("name", LINKAGES)
def test_what_can_be_driven_as_well_can(name):
    """All of it together, after none and after a first one."""
    mechanism = LINKAGES[name]
    drivable = mechanism.mobility().drivable
    assert refusal(mechanism, list(drivable)) is None
    free = undriven_freedoms(mechanism.linkage, [coordinate(mechanism.linkage, drivable[0])])
    assert refusal(mechanism, [drivable[0], *free]) is None


def test_a_ball_is_said_to_be_driven_by_its_angles():
    mechanism = catalogue.hexapod()
    ball = next(joint for joint in mechanism.all_joints if joint.kind == "spherical")
    with pytest.raises(ValueError) as error:
        coordinate(mechanism.linkage, ball.name)
    written = str(error.value).partition("write ")[2].split(" or ")
    assert len(coordinates(mechanism.linkage, [literal_eval(name) for name in written])) == 3


def bars(*extra):
    """A triangle of bars on the ground with a round rod between two balls on it: the rod spins, nothing else moves."""
    points = {"A": (0, 0), "B": (30, 0), "C": (10, 20)}
    joints = list(catalogue.pinned(points, {"ground": "AB", "left": "AC", "right": "BC"}).all_joints)
    rod = [jk.spherical("P", "ground", "rod", point=(0, 0, 9)), jk.spherical("Q", "rod", "left", point=(5, 10, 9))]
    return Mechanism.build(fixed=["ground"], joints=[*joints, *rod, *extra])


@pytest.mark.long
def test_what_cannot_move_is_told_from_what_moves_about_itself():
    spinning = bars()
    assert (spinning.mobility().freedoms, spinning.mobility().useful) == (1, 0)
    assert "cannot move" not in str(spinning)
    assert "Nothing can move but parts by themselves: its freedom is idle" in str(spinning)
    stuck = Mechanism.build(fixed=["ground"], joints=[joint for joint in spinning.all_joints if joint.name in "ABC"])
    assert stuck.mobility().freedoms == 0 and "It cannot move. It could without one of these" in str(stuck)


@pytest.mark.parametrize("mechanism", [bars(), LINKAGES["four-bar"]], ids=["stuck", "moving"])
def test_joints_that_are_said_to_hold_a_mechanism_do(mechanism):
    """The rod is left alone: without it nothing would move but the rod."""
    lines = str(mechanism).splitlines()
    ways = [re.match(r"  (joint '.*'): then (\d+) freedoms?, moving (.*)", line) for line in lines]
    ways = [way for way in ways if way]
    assert bool(ways) == (not mechanism.mobility().useful)
    for way in ways:
        removed = re.findall(r"joint '(\w+)'", way[1])
        left = [joint for joint in mechanism.all_joints if joint.name not in removed]
        found = Mechanism.build(fixed=mechanism.fixed, joints=left)
        assert found.mobility().useful == int(way[2]) > 0
    assert not ways or ways[0][3] != "rod"  # that the rod falls off comes last


def test_loops_without_a_freedom_name_what_holds_them():
    """Driven or not: each of the joints named is one without which the drive is accepted."""
    mechanism = bars()
    said = refusal(mechanism, ["A"])
    assert "A.phi cannot be driven" in said or "A.phi has no freedom left" in said
    triangle = Mechanism.build(fixed=["ground"], joints=[j for j in mechanism.all_joints if j.name in "ABC"])
    said = refusal(triangle, ["A"])
    named = re.findall(r"joint '(\w+)': then", said)
    assert set(named) == {"A", "B", "C"}
    for name in set(named) - {"A"}:
        left = [joint for joint in triangle.all_joints if joint.name != name]
        assert refusal(Mechanism.build(fixed=["ground"], joints=left), ["A"]) is None


@pytest.fixture(scope="module")
def fourbar():
    return jk.load(path("fourbar"))


@pytest.mark.long
def test_parts_that_hang_on_nothing_are_connected_as_advised(fourbar):
    """A flag that touches nothing, and a pair of flags that touch each other."""
    flag = replace(fourbar.parts[1], name="flag", triangles=fourbar.parts[1].triangles + 500.0, faces=())
    other = replace(flag, name="other flag", triangles=flag.triangles + 100.0)
    for parts, rigid in (((flag,), []), ((flag, other), []), ((flag, other), [["flag", "other flag"]])):
        loose = replace(fourbar, parts=(*fourbar.parts, *parts))
        with pytest.raises(ValueError) as error:
            loose.mechanism(fixed=["ground"], rigid=rigid, contacts=fourbar.contacts(), infer=False)
        advised = literal_eval(re.search(r"with rigid=(\[\[.*?\]\])", str(error.value))[1])
        found = loose.mechanism(fixed=["ground"], rigid=[*rigid, *advised], contacts=fourbar.contacts(), infer=False)
        assert found.mobility().useful == 1


@pytest.mark.long
def test_near_misses_that_are_told_are_those_of_the_tolerances_given(fourbar):
    """Not those of the default: the advice would be to give what is given."""
    rocker = next(part for part in fourbar.parts if part.name == "rocker")
    away = replace(rocker, faces=tuple(replace(face) for face in rocker.faces))
    assembly = replace(fourbar, parts=tuple(away if part is rocker else part for part in fourbar.parts))
    contacts = assembly.contacts(length=1e-2)
    loose = [contact for contact in contacts if "rocker" not in contact.parts]
    with pytest.raises(ValueError, match="'rocker' touches no other part"):
        assembly.mechanism(fixed=["ground"], contacts=loose, infer=False)
    assert len(assembly.found) == 1  # nothing was detected anew


def test_the_axis_of_a_screw_is_no_ball():
    """Coordinates of all other movements are driven one by one."""
    assert jk.revolute("A", "a", "b", point=(0, 0, 0), axis=Z).driven_together == ((0,),)
    assert jk.planar("A", "a", "b", normal=Z).driven_together == ((0,), (1,), (2,))
    assert jk.spherical("A", "a", "b", point=(0, 0, 0)).driven_together == ((0, 1, 2),)
