"""Forces and rates of poses that are dealt out to processor cores against those of all poses at once; to rounding."""

import jax
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.effects import pose_shards, rates
from jaxkin.effects.forces import pose_groups
from reference.energies import FOURBAR_MASSES, fourbar

POSES = 41
"""No multiple of the number of cores: the last shard overlaps the one before it."""
GRAVITY = (0, -9.81, 0)


@pytest.fixture(scope="module")
def motion() -> jk.Motion:
    return fourbar().sweep({"A": np.linspace(0.1, 3.0, POSES)})


def _forces(motion: jk.Motion, masses: jk.Masses) -> tuple:
    loads = [jk.torque(next(iter(FOURBAR_MASSES)), np.outer(np.linspace(1, 2, POSES), (0, 0, 1)))]
    rates = {"A": np.linspace(1, 2, POSES)}
    given = {"masses": masses, "gravity": GRAVITY, "applied": loads}
    at_rest = jk.reactions(motion, **given)
    reactions, drive = jk.reactions(motion, **given, rates=rates), jk.drive_forces(motion, **given, rates=rates)
    each = [(found.points, found.forces, found.torques, found.drives, found.held) for found in (at_rest, reactions)]
    return tuple(jax.tree.leaves((each, drive.forces, drive.powers)))


def _rates(motion: jk.Motion, masses: jk.Masses) -> tuple:
    return tuple(jax.tree.leaves(jk.jerks(motion, {"A": np.linspace(1, 2, POSES)}).orders))


@pytest.mark.long
@pytest.mark.parametrize(("of_motion", "calls"), [(_forces, 3), (_rates, 1)])
def test_what_shards_give_is_that_of_all_poses(motion, masses, monkeypatch, of_motion, calls):
    whole = of_motion(motion, masses)
    shards = []

    def in_threads(function, each, threads):
        shards.append(len(each))
        return plain_in_threads(function, each, threads)

    plain_in_threads = pose_shards.in_threads
    monkeypatch.setattr(pose_shards, "in_threads", in_threads)
    monkeypatch.setattr(pose_shards, "available_cores", lambda: 3)
    monkeypatch.setattr(pose_groups, "MIN_SHARD_ENTRIES", 1)
    monkeypatch.setattr(rates, "MIN_SHARD_ENTRIES", 3)
    found = of_motion(motion, masses)
    assert shards == [3] * calls
    for one, other in zip(found, whole, strict=True):
        assert one.shape == other.shape
        np.testing.assert_allclose(one, other, rtol=0, atol=1e-12 * (1 + np.abs(other).max(initial=0.0)))


def test_rates_by_groups_are_those_of_all_poses(motion, masses, monkeypatch):
    whole = _rates(motion, masses)
    # more poses have a program of their own; the first of them are those of `motion`
    turn = np.append(np.linspace(0.1, 3.0, POSES), [3.1, 3.2])
    speeds = np.append(np.linspace(1, 2, POSES), [2.1, 2.2])
    monkeypatch.setattr(rates, "LONG_RANGE", 1)
    monkeypatch.setattr(rates, "GROUP", 10)
    sizes = []

    def in_groups(function, poses, size, axis):
        sizes.append(size)
        return plain_in_groups(function, poses, size, axis)

    plain_in_groups = rates.in_groups
    monkeypatch.setattr(rates, "in_groups", in_groups)
    found = jax.tree.leaves(jk.jerks(motion.mechanism.sweep({"A": turn}), {"A": speeds}).orders)
    assert sizes == [10]
    for one, each in zip(found, whole, strict=True):
        np.testing.assert_allclose(one[:POSES], each, rtol=0, atol=1e-12 * (1 + np.abs(each).max(initial=0.0)))


def test_traced_numbers_are_not_dealt_out(motion, monkeypatch):
    monkeypatch.setattr(pose_shards, "available_cores", lambda: 3)
    monkeypatch.setattr(pose_groups, "MIN_SHARD_ENTRIES", 1)

    def force_in_total(mass):
        masses = jk.masses(motion.mechanism, given={part: jk.Mass(mass, centre=(0, 0, 0)) for part in FOURBAR_MASSES})
        return jk.reactions(motion, masses, gravity=GRAVITY).forces["A"].sum()

    value, slope = jax.value_and_grad(force_in_total)(2.0)
    # at rest all forces grow with the masses
    np.testing.assert_allclose(value, 2.0 * slope, rtol=1e-12)
