"""Several mechanisms of one assembly are tried: what they have in common is found once."""

from pathlib import Path

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.assembly import assembly as assembly_module
from jaxkin.assembly.inference import measured
from jaxkin.examples import path
from jaxkin.mobility.twists import twists

FLANGES = Path(__file__).parents[2] / "io" / "data" / "flanges.step"


@pytest.fixture(scope="module")
def flanges():
    return jk.load(FLANGES)


def counted(monkeypatch, module, name):
    calls, function = [], getattr(module, name)
    monkeypatch.setattr(module, name, lambda *given: (calls.append(given), function(*given))[1])
    return calls


@pytest.mark.long
def test_proposals_measure_each_part_once(monkeypatch):
    detected = counted(monkeypatch, assembly_module, "find_contacts")
    fitted = counted(monkeypatch, measured, "bores")
    rolling = counted(monkeypatch, measured, "bearings")
    made = counted(monkeypatch, assembly_module, "with_inferences")
    assembly = jk.load(path("fourbar"))  # flanges that are bolted together are one body, with one proposal
    found = assembly.without([]).proposals()
    assert len(found) > 1
    assert len(detected) == len(rolling) == 1
    assert len(fitted) == len(assembly.parts)
    assert len(made) == len(found)
    assembly.mechanism(fixed=found[0].fixed)  # one of those that were tried
    assert len(made) == len(found)
    assembly.mechanism(fixed=found[0].fixed, clearance=0.0)  # another one
    assert len(made) == len(found) + 1


@pytest.mark.long
def test_a_mechanism_is_the_same_before_and_after_others_were_tried():
    before, after = jk.load(FLANGES), jk.load(FLANGES)
    fixed = after.proposals()[0].fixed
    one, other = before.mechanism(fixed=fixed), after.mechanism(fixed=fixed)
    assert str(one) == str(other)
    for first, second in zip(one.all_joints, other.all_joints, strict=True):
        assert first.name == second.name
        assert np.array_equal(first.frames_1, second.frames_1)


@pytest.mark.long
def test_progress_is_told_to_the_end():
    assembly = jk.load(path("fourbar"))
    told = {"contacts": [], "proposals": []}
    assembly.contacts(progress=lambda *done: told["contacts"].append(done))
    assembly.proposals(progress=lambda *done: told["proposals"].append(done))
    for steps in told.values():
        assert steps == [(number, len(steps)) for number in range(1, len(steps) + 1)]


@pytest.mark.long
@pytest.mark.parametrize("seed", range(3))
def test_freedoms_counted_in_blocks_are_those_of_the_whole_matrix(seed, flanges):
    """Against the rank of the whole matrix by NumPy, for random sets of parts."""
    mechanism = flanges.mechanism(fixed=[flanges.names[0]], infer=False)
    row_of = mechanism.structure.row_of
    system = twists(mechanism.all_joints, row_of, row_of[mechanism.fixed[0]])
    generator = np.random.default_rng(seed)
    for size in range(1, len(system.bodies)):
        bodies = list(generator.choice(system.bodies, size, replace=False))
        joints = [k for k, each in enumerate(mechanism.all_joints) if {*bodies} & {row_of[p] for p in each.parts}]
        rows = system.rows(joints)
        own = np.concatenate([6 * system.bodies.index(body) + np.arange(6) for body in bodies])
        # a millionth of the largest singular value: far from 1, the size of entries, and from rounding
        rank = np.linalg.matrix_rank(system.matrix[np.ix_(rows, own)], rtol=1e-6)
        assert system.alone(bodies, rows) == len(own) - rank
        assert system.count_freed(rows) == len(system.freed(rows))


def test_the_outermost_corners_reach_as_far_as_all(flanges):
    for part in flanges.parts:
        directions = np.random.default_rng(0).normal(size=(3, 50))
        every = (part.triangles.reshape(-1, 3) @ directions).max(axis=0)
        np.testing.assert_allclose((part.outermost @ directions).max(axis=0), every, rtol=1e-12)
        assert len(part.outermost) < part.triangles.size / 3
