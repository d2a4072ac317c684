"""Where exact contacts determine every joint, inference changes none."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples import EXAMPLES, path

PLACES = [(name, EXAMPLES[name].fixed) for name in EXAMPLES]
PLACES += [("air_cylinder", (part,)) for part in ("p3", "p5", "p8")]  # what is fixed is no fastener


@pytest.mark.parametrize(
    ("name", "fixed"), [pytest.param(*each, marks=[pytest.mark.long] * (each[0] != "fourbar")) for each in PLACES]
)
def test_inference_leaves_the_joints_of_examples(name, fixed):
    assembly = jk.load(path(name))
    found, exact = (assembly.mechanism(fixed=fixed, infer=infer).all_joints for infer in (True, False))
    assert [(each.name, each.parts, each.kind) for each in found] == [(e.name, e.parts, e.kind) for e in exact]
    for one, other in zip(found, exact, strict=True):
        np.testing.assert_array_equal(one.frames_1, other.frames_1)
