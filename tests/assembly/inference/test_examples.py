"""Where exact contacts determine every joint, inference changes none."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples import EXAMPLES, path

OTHERS = [pytest.param(name, marks=pytest.mark.long) for name in EXAMPLES if name != "fourbar"]


@pytest.mark.parametrize("name", ["fourbar", *OTHERS])
def test_inference_leaves_the_joints_of_examples(name):
    assembly = jk.load(path(name))
    fixed = EXAMPLES[name].fixed
    found, exact = (assembly.mechanism(fixed=fixed, infer=infer).all_joints for infer in (True, False))
    assert [(each.name, each.parts, each.kind) for each in found] == [(e.name, e.parts, e.kind) for e in exact]
    for one, other in zip(found, exact, strict=True):
        np.testing.assert_array_equal(one.frames_1, other.frames_1)
