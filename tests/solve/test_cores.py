"""A long range in shards, one a core, is the range in one: poses, full turns and order.

Tolerance 1e-12: what is left of the closure after the last step is rounding, and the samples of a shard are its own.
"""

from itertools import pairwise

import jax
import numpy as np
import pytest

from jaxkin.joints.pairs import revolute
from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.solve.execution.cores import shard_count
from jaxkin.solve.options import SolverOptions
from reference.catalogue import hexapod
from reference.mechanisms import planar_fourbar, rssr_linkage

POSES = 3000
RANGES = {
    "four turns": np.linspace(-5.0, 20.0, POSES),
    "falling": np.linspace(8.0, 1.0, POSES),
    "shuffled": np.random.default_rng(0).permutation(np.linspace(-5.0, 20.0, POSES)),
}


def five_bar():
    """Two cranks of 40 and 35, 100 apart, and rods of 65 between them, which do not reach far enough everywhere."""
    one, two = 40.0 * np.exp(1.2j), 100.0 + 35.0 * np.exp(1.9j)
    middle = 0.5 * (one + two)
    pin = middle + 1j * (two - one) / abs(two - one) * np.sqrt(65.0**2 - abs(two - middle) ** 2)
    bars = ("ground", "crank", "rod", "other rod", "other crank", "ground")
    return Mechanism.build(
        fixed=["ground"],
        joints=[
            revolute(name, *parts, point=(at.real, at.imag, 0), axis=(0, 0, 1))
            for name, parts, at in zip("ABCDE", pairwise(bars), (0j, one, pin, two, 100 + 0j), strict=True)
        ],
    )


def on_cores(cores):
    """Options by which the ranges here are cut into a shard a core, and put in order, as longer ones are."""
    return SolverOptions(cores=cores, min_shard_poses=POSES // 4, interpolate_from=POSES // cores)


@pytest.mark.long
@pytest.mark.parametrize("order", RANGES)
@pytest.mark.parametrize("linkage", [planar_fourbar, rssr_linkage])
def test_shards_are_the_range(linkage, order):
    """Three shards, of which the last overlaps the second; in balls full turns are counted across their ends."""
    mechanism = linkage()
    whole, split = (mechanism.sweep({"A": RANGES[order]}, options=on_cores(cores)) for cores in (1, 3))
    assert np.all(whole.closed) and np.all(split.closed)
    assert np.max(split.residual) < 1e-12
    for one, other in zip(whole.displacements, split.displacements, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-12)


@pytest.mark.long
@pytest.mark.study
def test_shards_of_several_inputs_are_their_range():
    """In and out of reach of a five-bar: behind a limit a straight line from the assembled pose is tried."""
    way = np.linspace(0.0, 12.0, POSES)
    drive = {"A": way + 0.3 * np.sin(3 * way), "E": 1.5 * np.sin(way)}
    whole, split = (five_bar().sweep(drive, options=on_cores(cores)) for cores in (1, 3))
    np.testing.assert_array_equal(whole.status, split.status)
    assert 0.3 < np.mean(split.closed) < 0.99
    assert np.max(split.residual[split.closed]) < 1e-12
    # beside a limit a pose is right to rounding over its smallest singular value, here 5e-3
    for one, other in zip(whole.displacements, split.displacements, strict=True):
        np.testing.assert_allclose(one[whole.closed], other[whole.closed], atol=1e-11)


@pytest.mark.long
@pytest.mark.filterwarnings("ignore:jaxkin computes in float32")
def test_settings_of_a_thread_hold_in_those_of_its_shards():
    with jax.enable_x64(False):
        motion = planar_fourbar().sweep({"A": RANGES["falling"]}, options=on_cores(2))
    assert {array.dtype for array in motion.displacements} == {np.dtype(np.float32)}
    assert np.all(motion.closed)


def shards(system, poses, **options):
    """Number of shards of a rising range of so many poses on eight cores."""
    return shard_count(system, np.linspace(0.0, 1.0, poses)[None], SolverOptions(cores=8, **options))


def test_how_many_shards():
    (element,) = plan_drive(planar_fourbar().linkage, ("A",)).loop_groups
    assert [shards(element.system, poses, min_shard_poses=1000) for poses in (999, 3000, 100_000)] == [1, 3, 8]
    assert [shards(element.system, poses) for poses in (8000, 2**15)] == [1, 2]


def test_ranges_of_many_joints_are_shared_by_cores():
    """The loops of a hexapod have thirty joints; a single input that neither rises nor falls stays in one shard."""
    legs = tuple(f"leg {number}" for number in range(6))
    several, single = (plan_drive(hexapod().linkage, driven).loop_groups[0].system for driven in (legs, legs[:1]))
    assert [shards(single, poses) for poses in (127, 360, 8191, 8192)] == [1, 2, 8, 1]  # the last is interpolated
    rows = np.linspace(0.0, 1.0, 8192) * np.ones((6, 1))  # of several inputs none is
    assert [shard_count(several, rows[:, :n], SolverOptions(cores=8)) for n in (127, 360, 8192)] == [1, 2, 8]
    there_and_back = np.concatenate([np.linspace(0.0, 1.0, 180), np.linspace(1.0, 0.0, 180)])[None]
    assert shard_count(single, there_and_back, SolverOptions(cores=8)) == 1
    assert shard_count(single, there_and_back[:, :180], SolverOptions(cores=8)) == 1
    assert shard_count(single, np.sort(there_and_back), SolverOptions(cores=8)) == 2


@pytest.mark.long
def test_shards_of_a_range_of_several_inputs_are_the_range():
    """Lengths of a few tens: 1e-11 is rounding over the smallest singular value, some 1e-2."""
    way = np.linspace(0.0, 2 * np.pi, 300)
    drive = {f"leg {number}": 8.0 * np.sin(way + number) for number in range(6)}
    whole, split = (hexapod().sweep(drive, options=SolverOptions(cores=cores)) for cores in (1, 2))
    assert np.all(whole.closed) and np.all(split.closed)
    for one, other in zip(whole.displacements, split.displacements, strict=True):
        np.testing.assert_allclose(one, other, atol=1e-11)
