"""Four-bar loops that lie flat by design: rounded numbers pass their change points as exact ones do."""

from dataclasses import replace

import networkx as nx
import numpy as np
import pytest

from jaxkin.joints.pairs import cylindrical, prismatic, revolute, spherical
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mobility.change_points import EXACT, circuits, flat_loops, laid_flat
from reference import catalogue, mechanisms
from reference.catalogue import GROUND, pinned
from reference.mechanisms import Z
from reference.rounding import placed, rounded, written_down

TURN = np.linspace(0.0, 2 * np.pi, 73)
"""Passes the flat poses of the mechanisms below between samples."""
EQUAL = 1e-10
"""Radians: cranks of parallelograms whose links are equal to 1e-13 turn alike, whatever their lengths were rounded to;
five degrees beside a flat pose the error of a link is ten times larger."""
SHORT, LONG, AT = 50.0, 120.0, 0.7
TOP = SHORT * np.array([np.cos(AT), np.sin(AT)])


def kite() -> Mechanism:
    """Crank and ground of one length, coupler and rocker of another."""
    return mechanisms.planar_fourbar(AT, ground=SHORT, crank=SHORT, coupler=LONG, rocker=LONG)


def crank_slider(slide=prismatic) -> Mechanism:
    """Crank and rod of one length, the pin of the slider on a line through the hinge of the crank."""
    joints = [
        revolute("O", GROUND, "crank", point=(0, 0, 0), axis=Z),
        revolute("A", "crank", "rod", point=(*TOP, 0), axis=Z),
        revolute("B", "rod", "slider", point=(2 * TOP[0], 0, 0), axis=Z),
        slide("S", GROUND, "slider", point=(2 * TOP[0], 0, 0), axis=(1, 0, 0)),
    ]
    return Mechanism.build(fixed=[GROUND], joints=joints)


def wheels() -> Mechanism:
    """Wheels in a row that are coupled by rods, two of which are on each inner pin."""
    axles = {f"{number}": np.array([LONG * number, 3.0 * number**2]) for number in range(4)}
    pins = {name.translate(str.maketrans("0123", "abcd")): place + TOP for name, place in axles.items()}
    bars = {GROUND: "0123", "w0": "0a", "w1": "1b", "w2": "2c", "w3": "3d", "r0": "ab", "r1": "bc", "r2": "cd"}
    return pinned(axles | pins, bars)


def turn(mechanism: Mechanism, joint: str, of: str) -> np.ndarray:
    """How far a joint turns while another one makes a full turn, all poses closed."""
    motion = mechanism.sweep({of: TURN})
    assert motion.closed.all()
    return np.asarray(motion.coordinates[joint])[:, 0]


@pytest.mark.parametrize("digits", [12, 9, 7])
@pytest.mark.parametrize("seed", range(2))
def test_a_rounded_parallelogram_stays_one(digits, seed):
    """Most of these folded over, or stopped, in the flat pose; exact cranks stay parallel."""
    found = turn(written_down(catalogue.parallelogram(), digits, seed), "B", "A")
    assert np.abs(found - TURN).max() < EQUAL


@pytest.mark.parametrize("balls", ["b", "ab"], ids=["a ball for a pin", "a rod between balls"])
def test_balls_in_place_of_pins_pass_flat_poses_too(balls):
    """As robot files close loops, and as tie rods are."""
    exact = catalogue.parallelogram().all_joints
    joints = [
        spherical(joint.name, *joint.parts, point=joint.frames_1[0, :3, 3]) if joint.name in balls else joint
        for joint in exact
    ]
    mechanism = written_down(Mechanism.build(fixed=[GROUND], joints=joints), 8, 0)
    assert np.abs(turn(mechanism, "B", "A") - TURN).max() < EQUAL


@pytest.mark.parametrize("slide", [prismatic, cylindrical])
def test_a_rounded_crank_and_rod_of_one_length_pass_the_hinge(slide):
    exact, written = crank_slider(slide), written_down(crank_slider(slide), 9, 3)
    motion = written.sweep({"O": TURN})
    assert motion.closed.all()
    hinge, pin = (np.asarray(written.joints[name].frames_1)[0, :3, 3] for name in "OA")
    scale = np.linalg.norm(pin - hinge) / SHORT
    along = 2 * SHORT * (np.cos(AT + TURN) - np.cos(AT))
    for mechanism, size in ((exact, 1.0), (written, scale)):
        found = np.asarray(mechanism.sweep({"O": TURN}).coordinates["S"])[:, 0]
        assert np.abs(found / size - along).max() < 1e-5


@pytest.mark.long
def test_a_rounded_kite_keeps_its_branch():
    exact = kite()
    name, driven = exact.all_joints[-1].name, exact.all_joints[0].name
    one, other = (turn(each, name, driven) for each in (exact, written_down(exact, 9, 1)))
    # where all pins are in line the error is the root of that of the links, elsewhere near to it
    assert np.abs(one - other).max() < 1e-4 and np.median(np.abs(one - other)) < 1e-7


def test_what_is_moved_is_said_and_is_rounding():
    digits, exact = 7, catalogue.parallelogram()
    given = rounded(placed(exact.all_joints, np.random.default_rng(0)), digits)
    mechanism = Mechanism.build(fixed=[GROUND], joints=given)
    size = max(np.abs(joint.frames_1[:, :3, 3]).max() for joint in given)
    moves = [np.abs(mechanism.joints[joint.name].frames_1 - joint.frames_1)[:, :3, 3].max() for joint in given]
    assert 0 < max(moves) < 2 * 10.0**-digits * size
    assert len(mechanism.notes) == 1
    assert "for the rounding of the numbers" in mechanism.notes[0] and "axes" in mechanism.notes[0]
    still = Mechanism.build(fixed=[GROUND], joints=given, align=0)
    assert all(np.array_equal(still.joints[joint.name].frames_1, joint.frames_1) for joint in given)


@pytest.mark.parametrize(
    "build", [catalogue.parallelogram, kite, crank_slider, wheels, mechanisms.planar_fourbar, mechanisms.slider_crank]
)
def test_exact_links_and_other_links_are_left_as_they_are(build):
    mechanism = build()
    given = Mechanism.build(fixed=list(mechanism.fixed), joints=mechanism.all_joints, align=0)
    for one, other in zip(mechanism.all_joints, given.all_joints, strict=True):
        assert np.array_equal(one.frames_1, other.frames_1)


def uneven(by: float, **options) -> Mechanism:
    """A parallelogram whose coupler is longer than its ground."""
    joints = []
    for joint in catalogue.parallelogram().all_joints:
        frames = joint.frames_1.copy()
        frames[:, 0, 3] += by * (joint.name == "b")
        joints.append(replace(joint, frames_1=frames, frames_2=frames))
    return Mechanism.build(fixed=[GROUND], joints=joints, unit="mm", **options)


def test_links_that_miss_by_more_are_told_with_a_remedy_that_works():
    said = uneven(5e-3).notes
    assert len(said) == 1
    assert all(part in said[0] for part in ("'A', 'a', 'b', 'B'", "by 0.008 mm", "align=0.0001"))
    assert np.abs(turn(uneven(5e-3), "B", "A") - TURN).max() > 0.1, "folds over, as the note says"
    mended = uneven(5e-3, align=1e-4)
    assert np.abs(turn(mended, "B", "A") - TURN).max() < 1e-3
    assert "flat" not in str(mended.notes)
    assert not uneven(0.5).notes, "a length by design"


@pytest.mark.long
def test_a_row_of_parallelograms_stays_one_and_pins_in_line_stay_so():
    mechanism = written_down(wheels(), 8, 4)
    motion = mechanism.sweep({"0": TURN})
    assert motion.closed.all()
    for number in "123":
        assert np.abs(np.asarray(motion.coordinates[number])[:, 0] - TURN).max() < EQUAL
    for pin in "bc":
        one, other = (mechanism.joints[f"{pin}{k}"].frames_1 for k in (0, 1))
        assert np.array_equal(one[:, :3, 3], other[:, :3, 3])


def test_sums_of_links_vanish_after_the_move():
    random, size = np.random.default_rng(5), 4 * LONG
    joints, at = {}, {}
    for number, joint in enumerate(wheels().all_joints):
        place = tuple(joint.frames_1[0, :3, 3])
        at.setdefault(place, place + 1e-6 * size * random.uniform(-1, 1, 3))
        joints[number] = revolute(joint.name, *joint.parts, point=at[place], axis=Z)
    ends = {number: joint.parts for number, joint in joints.items()}
    noise = 5e-6 * size
    loops = flat_loops(joints, ends, noise)
    assert len(loops) == 3 and max(loop.off_by() for loop in loops) > 1e-8 * size
    moved = laid_flat(loops, joints, noise, size)
    assert moved
    again = flat_loops(joints | moved, ends, noise)
    assert len(again) == 3 and max(loop.off_by() for loop in again) <= EXACT * size
    assert laid_flat(loops, joints, 1e-9 * size, size) is None, "farther than a pin may go"


@pytest.mark.parametrize("seed", range(5))
def test_circuits_are_the_cycles_of_the_graph(seed):
    random = np.random.default_rng(seed)
    pairs = [random.choice(7, 2, replace=False) for _ in range(14)]
    ends = {10 + number: (str(one), str(other)) for number, (one, other) in enumerate(pairs)}
    found = [frozenset(joint for joint, _ in circuit) for circuit in circuits(ends)]
    # with joints as nodes between bodies, cycles through joints side by side are told apart
    graph = nx.Graph([(joint, body) for joint, both in ends.items() for body in both])
    cycles = nx.simple_cycles(graph, length_bound=8)
    expected = [frozenset(node for node in cycle if node in ends) for cycle in cycles]
    assert sorted(map(sorted, found)) == sorted(map(sorted, expected))
