"""What a plan prints is what a sweep solves: its steps are the solver's blocks, one by one."""

from itertools import accumulate

import jax
import numpy as np
import pytest

from jaxkin.joints.pairs import cylindrical, fixed, planar, prismatic, revolute
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.mechanism.plan import plan
from jaxkin.solve.system.equation_blocks import equation_blocks
from reference import catalogue
from reference.mechanisms import bennett_linkage, cam, cardan_shafts, planar_fourbar, rssr_linkage, slider_crank
from reference.random_linkages import LINKAGES
from reference.rounding import spherical_wrist

LEGS = [f"leg {number}" for number in range(6)]


def random_linkage(name):
    """One of the linkages of `random_linkages`, whose closed forms are solved stage by stage."""
    linkage = next(linkage for linkage in LINKAGES if linkage.name == name)
    points, axes = linkage.draw(np.random.default_rng(0), 1, linkage.stages)
    return linkage.build(points[0], axes[0])


def plate() -> Mechanism:
    """A plate that turns about a pin on the table that it lies on: a planar pair has two unknowns beside a drive."""
    joints = [
        planar("E", "table", "plate", point=(30, 10, 0), normal=(0, 0, 1)),
        revolute("pin", "table", "plate", point=(0, 0, 0), axis=(0, 0, 1)),
    ]
    return Mechanism.build(fixed=["table"], joints=joints)


CASES = {
    "four-bar": (planar_fourbar, ["A"], ["planar dyad RRR"]),
    "with cylindrical pins": (lambda: planar_fourbar(pin=cylindrical), ["A.phi"], ["planar dyad RRR"]),
    "slider-crank": (slider_crank, ["A"], ["planar dyad RRP"]),
    "quick return": (catalogue.quick_return, ["A"], ["planar dyad RPR"]),
    "scotch yoke": (catalogue.scotch_yoke, ["A"], ["planar dyad RPP"]),
    "driven slide": (slider_crank, ["S"], ["planar dyad RRR"]),
    "plate driven by its angle": (plate, ["E.phi"], ["planar dyad R(PP)"]),
    "plate driven along x": (plate, ["E.x"], ["planar dyad R(PR)"]),
    "Watt": (catalogue.watt, ["A"], ["planar dyad RRR"] * 2),
    "Stephenson": (catalogue.stephenson, ["G"], ["2 planar loops"]),
    "Jansen": (catalogue.jansen, ["O"], ["planar dyad RRR"] * 3),
    "Andrews": (catalogue.andrews, ["O"], ["planar dyad RRR"] * 3),
    "parallelogram": (lambda: catalogue.parallelogram(3), ["A"], ["planar dyad RRR", "planar loop RRRR"]),
    "Cardan shafts": (cardan_shafts, ["in"], ["spherical dyad UR"]),
    "spherical wrist": (spherical_wrist, ["a0", "a1", "a2"], ["2 spherical loops"]),
    "Bennett": (bennett_linkage, ["A"], ["spatial loop RRRR"]),
    "Sarrus": (catalogue.sarrus, ["x0"], ["spatial loop RRRRRR"]),
    "RSSR": (rssr_linkage, ["A"], ["spatial loop RSSR"]),
    "two RSSR": (lambda: random_linkage("two RSSR"), ["A"], ["spatial loop RSSR"] * 2),
    "four spherical": (
        lambda: random_linkage("four spherical four-bars"),
        ["A"],
        ["spherical dyad RRR"] * 4,
    ),
    "cam": (cam, ["shaft"], ["planar dyad P(PR)"]),
    "hexapod": (catalogue.hexapod, LEGS, ["5 spatial loops"]),
    "hexapod of one leg": (catalogue.hexapod, LEGS[:1], ["5 spatial loops"]),
}


class Solved(Exception):
    """Raised where the solver begins: what it is given is all that is asked for."""


@pytest.fixture
def systems(monkeypatch):
    """The loop system that the solver is given by a sweep, of which there is one."""

    def solve(system, *_):
        raise Solved(system)

    def by_formulas(sweep, *_):
        (system,) = sweep.systems
        raise Solved(system)

    monkeypatch.setattr("jaxkin.mechanism.sweep.solve", solve)
    monkeypatch.setattr("jaxkin.mechanism.formula_sweep.FormulaSweep.solve", by_formulas)

    def of(mechanism, drive):
        with pytest.raises(Solved) as stopped:
            mechanism.sweep({name: np.zeros(3) for name in drive})
        return stopped.value.args[0]

    return of


@pytest.mark.parametrize("name", CASES)
def test_steps_are_the_blocks_of_the_solver(name, systems):
    make, drive, classes = CASES[name]
    mechanism = make()
    found = plan(mechanism, drive)
    assert [step.loop_class for step in found.steps] == classes
    system, (block,) = systems(mechanism, drive), mechanism.structure.loop_groups
    blocks = equation_blocks(system)
    assert len(blocks) == len(found.steps)
    at_rest = next((text for text in found.skipped if "at rest" in text), "")
    names = [
        f"{joint.name}.{coordinate}"
        for joint in (mechanism.all_joints[index] for index in block.joints)
        for coordinate in joint.coordinates
        if f"{joint.name}.{coordinate}" not in at_rest
    ]
    assert len(names) == system.columns
    for step, equations in zip(found.steps, blocks, strict=True):
        assert step.unknowns == tuple(names[column] for column in equations.columns)
        assert step.equations == len(equations.rows)
        assert {unknown.rpartition(".")[0] for unknown in step.unknowns} | set(step.follow) == set(step.joints)
    # every loop is in one step, and no step needs a later one
    assert sum(step.loops for step in found.steps) == len(mechanism.structure.loops) == len(system.loops)
    assert all(other < number for number, step in enumerate(found.steps) for other in step.after)
    # a loop holds no joint of a later step
    solved = list(accumulate((set(step.joints) for step in found.steps), set.union))
    driven = {name.rpartition(".")[0] for name in found.drive}
    for known, loops in zip(solved, system.order, strict=True):
        joints = {mechanism.all_joints[block.joints[joint]].name for loop in loops for joint, _ in system.loops[loop]}
        assert joints <= known | driven


def test_groups_that_share_what_is_left_free_are_one_step():
    """A five-bar of which one crank is driven, and a dyad on its coupler, which would follow; solved together both move
    the least."""
    points = {"A": (0, 0), "B": (10, 40), "C": (50, 70), "D": (90, 40), "E": (100, 0), "F": (60, 120), "G": (140, 90)}
    bars = {"ground": "AEG", "a": "AB", "b": "BC", "c": "CDF", "d": "DE", "e": "FH", "f": "HG"}
    points["H"] = (120, 130)
    five = catalogue.pinned(points, bars)
    (step,) = five.plan(["A"]).steps
    assert (step.merged, step.loops, step.free) == (2, 2, 1)
    assert "2 groups in one step: they share what is undetermined" in str(step)
    assert [step.merged for step in five.plan(["A", "E"]).steps] == [1, 1]


def test_loops_of_given_joints_are_checked_only():
    """Two slides of one block, and both driven: one loop of them, and a four-bar of which they carry the ground."""
    joints = [
        prismatic("left", "ground", "block", axis=(1, 0, 0)),
        prismatic("right", "ground", "block", axis=(1, 0, 0), point=(0, 10, 0)),
        *planar_fourbar().all_joints,
    ]
    mechanism = Mechanism.build(fixed=["ground"], joints=[*joints, fixed("weld", "block", "crank")])
    found = mechanism.plan(["left", "right"])
    assert any(
        "in which all coordinates are given: the status says whether it closes" in text for text in found.skipped
    )


def test_the_plan_of_traced_frames_is_found_by_counting():
    """Inside `jit` there are no numbers for ranks: planar and spherical loops are counted, and the plan says so."""
    plans = []

    def of(mechanism):
        plans.append(mechanism.plan(["O"]))
        return 0.0

    mechanism = catalogue.jansen()
    jax.eval_shape(of, mechanism)
    (found,) = plans
    assert any("put in order by counting unknowns, since its joint frames are traced" in note for note in found.notes)
    expected = mechanism.plan(["O"])
    assert {frozenset(step.unknowns) for step in found.steps} == {frozenset(step.unknowns) for step in expected.steps}


def test_a_gradient_solves_what_the_sweep_solves(systems):
    """By `grad` alone the numbers are there: the same system, so that nothing is compiled twice."""
    mechanism = random_linkage("two RSSR")
    found = []

    def loss(scale):
        frame = mechanism.joints["C0"].frames_1[0]
        found.append(systems(mechanism.with_frames({"C0": scale * frame}), ["A"]))
        return scale

    jax.grad(loss)(1.0)
    assert found == [systems(mechanism, ["A"])]
    assert len(equation_blocks(found[0])) == 2
