"""What is inferred does not depend on the seed of hashes, in whose order Python goes through sets of names.

The seed is chosen when an interpreter starts: this file also runs as a program that prints what it infers.
"""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import jaxkin as jk
from reference.round_parts import assembly, block, part, pin, ring

HERE = Path(__file__).parent


def jaw_on_its_ways() -> jk.Assembly:
    """Walls of two bodies face each other: either is between those of the other."""
    floor = block((-100, -40, -10), (100, 40, 0))
    base = part("base", floor, block((-100, 30, 0), (100, 40, 8)), block((-100, -40, 0), (100, -30, 8)))
    jaw = part("jaw", block((0, -29.95, 0), (25, 29.95, 40)), pin(5.0, 40, 70, (12, 0)))
    return assembly(base, jaw, part("lever", ring(5.0, 9.0, 45, 52, (12, 0)), block((20, -3, 45), (70, 3, 52))))


def plates_with_empty_holes() -> jk.Assembly:
    """Two plates flat on each other, each with holes that end on the other one."""
    walls = [[ring(3.0, 3.1, low, low + 6, (x, y))[2:3] for x in (-20, 20)] for low, y in ((-6, 5), (0, 0))]
    below = part("base", block((-40, -10, -6), (40, 10, 0)), *walls[0])
    return assembly(below, part("lid", block((-40, -10, 0), (40, 10, 6)), *walls[1]))


def rod_with_caps() -> jk.Assembly:
    """A plain rod on the floors of two blind caps, in a bush."""
    base = part("base", ring(4.2, 9.0, -10, 10), block((-30, -30, -10), (30, -8, 10)))
    caps = (
        part("left", ring(4.0, 8.0, -30, -20), pin(8.0, -34, -30)),
        part("right", ring(4.0, 8.0, 20, 30), pin(8.0, 30, 34)),
    )
    return assembly(base, part("rod", pin(4.0, -30, 30)), *caps)


def printed() -> None:
    """Print bodies, axes, points and evidence of a dozen drawings, those of other tests among them."""
    import test_evidence
    import test_feathers
    import test_floating
    import test_springs
    import test_wheels_and_sockets

    drawings = [
        *(jaw_on_its_ways(), plates_with_empty_holes(), rod_with_caps()),
        *(test_evidence.hinge_with(radius) for radius in (4.5, 5.0, 5.3)),
        *(test_feathers.drawn(20.0, 0.1), test_floating.coupling(0.05, 0.2)),
        *(test_springs.plunger(clearance) for clearance in (0.2, 0.6)),
        *(test_wheels_and_sockets.carriage(0.1, both) for both in (True, False)),
    ]
    for drawn in drawings:
        mechanism = drawn.mechanism(fixed=[drawn.names[0]])
        print(mechanism.bodies, *mechanism.history, sep="\n")
        for joint in mechanism.all_joints:
            print(joint.name, joint.kind, joint.parts, np.asarray(joint.frames_1).tolist(), joint.evidence)


@pytest.mark.long
def test_the_seed_of_hashes_changes_no_joint():
    found = []
    for seed in "01":
        more = {"PYTHONHASHSEED": seed, "PYTHONPATH": os.pathsep.join([str(HERE.parents[1]), *sys.path])}
        done = subprocess.run(
            [sys.executable, __file__], env=os.environ | more, capture_output=True, text=True, check=True
        )
        found.append(done.stdout.splitlines())
    assert len(found[0]) > 50
    assert found[0] == found[1]


if __name__ == "__main__":
    printed()
