"""The order in which loops can be solved: known decompositions, and rates found in that order close all loops."""

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

import jaxkin as jk
from jaxkin.examples import path
from jaxkin.joints.pairs import cylindrical, fixed, revolute
from jaxkin.linkage.first_order import DOUBLE, loop_jacobian
from jaxkin.linkage.solve_order import solve_order
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.plan import plan
from jaxkin.mobility.loop_freedoms import loop_freedoms
from reference import catalogue
from reference.mechanisms import Z, bennett_linkage, cam, cardan_shafts, planar_fourbar, rssr_linkage, slider_crank


def test_jansens_leg_is_three_dyads():
    """One after another, or the upper and the lower one at once; two loops each would be one 6x6 problem."""
    found = catalogue.jansen().plan(["O"])
    shape = [(set(step.parts), step.loops, step.subgroup.name, len(step.unknowns), step.after) for step in found.steps]
    upper, lower = {"ground", "crank", "upper rod", "thigh"}, {"ground", "crank", "lower rod", "rocker"}
    assert sorted(map(sorted, (parts for parts, *_ in shape[:2]))) == sorted(map(sorted, (upper, lower)))
    assert shape[2][0] == {"thigh", "lower rod", "link", "shin"} or shape[2][0] == {"thigh", "rocker", "link", "shin"}
    assert [rest for _, *rest in shape] == [[1, "planar", 3, ()], [1, "planar", 3, ()], [1, "planar", 3, (0, 1)]]
    assert all((step.equations, step.redundant, step.free) == (3, 0, 0) for step in found.steps)


def test_the_group_depends_on_the_drive():
    """Stephenson's six-bar: two dyads from the crank, one group of the third class (a triad) from the other end."""
    linkage = catalogue.stephenson()
    assert [(step.loops, len(step.unknowns)) for step in linkage.plan(["A"]).steps] == [(1, 3), (1, 3)]
    assert [(step.loops, len(step.unknowns)) for step in linkage.plan(["G"]).steps] == [(2, 6)]


def test_a_series_is_solved_from_the_driven_end():
    forward, back = (catalogue.watt().plan([drive]).steps for drive in "AG")
    assert [step.parts for step in forward] == [
        ("ground", "crank", "coupler", "rocker"),
        ("ground", "rocker", "second coupler", "output"),
    ]
    assert [set(step.parts) for step in back] == [set(step.parts) for step in forward[::-1]]
    assert back[1].after == forward[1].after == (0,)


def test_redundant_bars_are_groups_of_their_own():
    steps = catalogue.parallelogram(4).plan(["A"]).steps
    assert [(step.loops, len(step.unknowns), step.equations, step.redundant) for step in steps] == [
        (1, 3, 3, 0),
        (1, 2, 3, 1),
        (1, 2, 3, 1),
    ]


@pytest.mark.parametrize(
    ("mechanism", "drive", "subgroup", "equations", "redundant", "free"),
    [
        (slider_crank(), "A", "planar", 3, 0, 0),
        (cardan_shafts(), "in", "spherical", 3, 0, 0),
        (planar_fourbar(pin=cylindrical), "A.phi", "planar", 3, 0, 0),
        (bennett_linkage(), "A", "spatial", 6, 3, 0),
        (rssr_linkage(), "A", "spatial", 1, 0, 0),
        (cam(), "shaft", "planar", 3, 0, 0),
        (catalogue.sarrus(), "x0", "spatial", 6, 1, 0),
        (catalogue.cam_roller(), "shaft", "planar", 3, 0, 0),
    ],
)
def test_subgroups(mechanism, drive, subgroup, equations, redundant, free):
    (step,) = mechanism.plan([drive]).steps
    assert (step.subgroup.name, step.equations, step.redundant, step.free) == (subgroup, equations, redundant, free)


@pytest.mark.long
def test_the_paper_in_words():
    """Fig. 5: driven as in Section 6, with both choices of fixed parts."""
    assembly = jk.load(path("eighteen_bars"))
    drive = {f"{joint}.phi": [0.0] for joint in ("p1-p2", "p3-p11", "p10-p13", "p15-p16")}
    both = assembly.mechanism(fixed=["p1", "p9"]).plan(drive)
    assert [step.parts for step in both.steps] == [
        ("p1&p9", "p2", "p3", "p4"),
        ("p1&p9", "p4", "p5", "p6"),
        ("p1&p9", "p6", "p7", "p8"),
        ("p15", "p16", "p17", "p18"),
    ]
    assert [step.after for step in both.steps] == [(), (0,), (1,), ()]
    text = str(both)
    second = "2. after 1: 1 planar dyad RRR over p1&p9, p4, p5, p6: 3 unknowns of p4-p5, p5-p6, p6-p9, 3 equations"
    assert second in text
    assert "p15-p16.z, p15-p18.z, p16-p17.z, p17-p18.z: out of the plane of the loops, at rest" in text
    assert "not solved: p3-p11 is in no loop: its displacement is given, and moves p11" in text

    alone = assembly.mechanism(fixed=["p1"]).plan(drive)
    assert [step.parts for step in alone.steps] == [
        both.steps[0].parts[:0] + ("p1", "p2", "p3", "p4"),
        both.steps[3].parts,
    ]
    carried = "the loop of p6, p7, p8, p9: none of its joints is driven, it keeps its shape and is carried along by p6"
    assert carried in alone.skipped


def test_what_rests_and_what_is_left_free_is_told():
    resting = [
        revolute(joint.name + "'", *(f"{p}'" if p != "ground" else p for p in joint.parts), point=place, axis=Z)
        for joint, place in zip(catalogue.watt().all_joints, ((i, i * i % 7, 0) for i in range(7)), strict=True)
    ]
    both = Mechanism.build(fixed=["ground"], joints=[*planar_fourbar().all_joints, *resting])
    found = both.plan(["A"])
    assert len(found.steps) == 1
    assert any("none of its joints is driven, it keeps its shape and rests" in text for text in found.skipped)

    five = catalogue.pinned(
        {"A": (0, 0), "B": (10, 40), "C": (50, 70), "D": (90, 40), "E": (100, 0)},
        {"ground": "AE", "a": "AB", "b": "BC", "c": "CD", "d": "DE"},
    )
    assert five.plan(["A"]).notes == (
        "undetermined: E.phi could be driven as well; without, all move as little as they can",
    )
    assert five.plan(["A", "E"]).notes == ()
    assert five.plan(["A", "B", "C"]).notes[0].startswith("infeasible drive: driven A.phi, B.phi, C.phi, but")


@pytest.mark.parametrize(
    ("drive", "message"),
    [
        ("A", r"got the text 'A'; write \['A'\]"),
        ([], "the drive is empty"),
        (["a"], "there is no joint 'a'"),
    ],
)
def test_a_drive_that_makes_no_sense_is_refused(drive, message):
    with pytest.raises(ValueError, match=message):
        plan(planar_fourbar(), drive)


def test_a_drive_outside_of_loops_solves_nothing():
    arm = Mechanism.build(fixed=["ground"], joints=[revolute("A", "ground", "arm", point=(0, 0, 0), axis=Z)])
    assert "nothing is to be solved" in str(arm.plan(["A"]))


def linkage(random: np.random.Generator, dyads: int, welded: bool) -> Mechanism:
    """Dyads in the plane hung on bars there are, some pins cylindrical, the last joint welded or not."""
    bars, joints = ["ground", "crank"], [revolute("J0", "ground", "crank", point=(0, 0, 0), axis=Z)]
    for i in range(dyads):
        first, second = random.choice(len(bars), 2, replace=False)
        new = (f"a{i}", f"b{i}")
        for one, other in ((bars[first], new[0]), (new[0], new[1]), (bars[second], new[1])):
            pin = cylindrical if random.random() < 0.2 else revolute
            joints.append(pin(f"J{len(joints)}", one, other, point=(*random.uniform(-100, 100, 2), 0), axis=Z))
        bars += new
    if welded:
        joints[-1] = fixed(joints[-1].name, *joints[-1].parts)
    return Mechanism.build(fixed=["ground"], joints=joints)


@pytest.mark.long
@settings(max_examples=10, deadline=None)
@given(st.integers(0, 2**32), st.integers(1, 6), st.booleans())
@example(5517, 5, True)  # circuits that share parts, but no joints, and need each other
def test_rates_found_group_by_group_close_all_loops(seed, dyads, welded):
    """Each group is solved alone, with what it leaves free drawn at random: no group behind it fails for that."""
    random = np.random.default_rng(seed)
    mechanism = linkage(random, dyads, welded)
    for loops in loop_freedoms(mechanism.linkage):
        given = [column for column, (joint, _) in enumerate(loops.columns) if mechanism.all_joints[joint].name == "J0"]
        if np.linalg.norm(loops.motions[:, given]) < 1e-3:
            given = []  # a rigid piece, or a crank at a dead centre
        groups = solve_order(loops.ends, loops.loop_group.loops, loops.columns, loops.screws, given, DOUBLE)
        unknowns = [column for group in groups for column in group.unknowns]
        assert sorted(unknowns + given) == list(range(len(loops.columns)))
        assert all(number < index for index, group in enumerate(groups) for number in group.after)
        circuits = [loop for group in groups for loop in group.loops]
        assert len(circuits) == len(loops.loop_group.loops)
        cycles = loop_jacobian(circuits, loops.columns, np.ones((6, len(loops.columns))))
        assert np.linalg.matrix_rank(cycles) == len(circuits)  # independent circuits
        rates = np.zeros(len(loops.columns))
        rates[given] = 1.0
        jacobian = loops.jacobian
        known = list(given)
        for group in groups:
            known += group.unknowns
            own = loop_jacobian(group.loops, loops.columns, loops.screws)
            np.testing.assert_array_equal(own[:, [c for c in range(len(loops.columns)) if c not in known]], 0.0)
            # the loops of all that is known by now: combinations of rows in which nothing else takes part
            rest = [c for c in range(len(loops.columns)) if c not in known]
            left, values, _ = np.linalg.svd(jacobian[:, rest]) if rest else (np.eye(len(jacobian)), np.zeros(0), 0)
            rows = left[:, int((values > 1e-9).sum()) :].T @ jacobian
            now = list(group.unknowns)
            missing = -rows @ rates
            solution = np.linalg.lstsq(rows[:, now], missing, rcond=1e-9)[0]
            kernel = np.linalg.svd(rows[:, now])
            free = kernel[2][int((kernel[1] > 1e-9).sum()) :]
            assert len(free) == group.free
            rates[now] = solution + random.normal(size=len(free)) @ free
            np.testing.assert_allclose(rows @ rates, 0.0, atol=1e-5 * max(1.0, np.abs(rates).max()))
        np.testing.assert_allclose(jacobian @ rates, 0.0, atol=1e-5 * max(1.0, np.abs(rates).max()))


@pytest.mark.parametrize(
    ("make", "drive", "methods"),
    [
        (planar_fourbar, "A", [("formula", "planar dyad RRR")]),
        (slider_crank, "A", [("formula", "planar dyad PRR")]),
        (cardan_shafts, "in", [("formula", "spherical triangle RRR")]),
        (rssr_linkage, "A", [("formula", "rod R")]),
        (catalogue.jansen, "O", [("formula", "planar dyad RRR")] * 3),
        (bennett_linkage, "A", [("Newton", "a loop in space without a rod between two balls")]),
        (catalogue.stephenson, "G", [("Newton", "its 2 loops are solved together")]),
    ],
    ids=lambda value: getattr(value, "__name__", None),
)
def test_every_step_says_whether_it_has_a_formula(make, drive, methods):
    plan = make().plan([drive])
    assert [(step.method, step.why) for step in plan.steps] == methods
    assert all(f"; {method} ({why})" in str(plan) for method, why in methods)


def test_a_step_with_a_formula_beside_one_without_says_so():
    steps = catalogue.parallelogram(3).plan(["A"]).steps
    assert [step.method for step in steps] == ["Newton", "Newton"]
    assert steps[0].why == "the planar dyad RRR has a formula, but not all loops that are solved with it have one"
    assert steps[1].why == "2 unknowns, where the formula of the planar dyad is for 3"
