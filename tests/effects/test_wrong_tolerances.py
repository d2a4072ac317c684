"""What `jk.tolerances` refuses: each in a line that says what arrived, and what to write instead."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples.paths import fourbar

CRANK, COUPLER = ("crank", "A", "B"), ("coupler", "B", "C")


def rocker(pose):
    return pose.coordinates["D"][0]


@pytest.mark.long
@pytest.mark.parametrize(
    ("stated", "more", "said"),
    [
        ({("couplr", "B", "C"): 0.1}, {}, "no part 'couplr'; did you mean 'coupler'"),
        (
            {COUPLER: -0.1},
            {},
            r"must be a positive number, as 0.05 for plus and minus 0.05, or jk.sigma\(0.02\), got -0.1",
        ),
        ({COUPLER: "0.1"}, {}, "must be a positive number"),
        ({CRANK: 61.0}, {}, "reaches below what it can be"),
        ({("coupler", "B", "C", "angle"): 0.01}, {}, "is 0, and ± 0.01 reaches below"),
        ({}, {}, "at least one length or clearance"),
        ([COUPLER], {}, "are given by name"),
        ({COUPLER: 0.1}, {"clearances": {"E": 0.1}}, "clearances: there is no joint 'E'"),
        ({COUPLER: 0.1}, {"wanted": (1, 0)}, "two numbers in rising order"),
        ({COUPLER: 0.1}, {"drive": {"A": 3.0}}, "does not close for this drive"),
        ({COUPLER: 0.1}, {"drive": {"A": []}}, r"drive 'A' has no poses: .* got \[\]"),
        ({COUPLER: 0.1}, {"measure": lambda pose: pose.coordinates["D"]}, r"one number, .* an array of shape \(1,\)"),
        ({COUPLER: 0.1}, {"measure": "D"}, "must be a function of the pose"),
        ({COUPLER: 0.1}, {"measure": lambda pose: np.max(np.asarray(pose.coordinates["D"]))}, "jax.numpy in place of"),
        ({COUPLER: 0.1}, {"measure": lambda pose: float(rocker(pose))}, "jax.numpy in place of"),
        ({COUPLER: 0.1}, {"drive": None}, "the measure is given the mechanism, since there is no drive"),
        ({COUPLER: 0.1}, {"samples": -1}, "samples must be a whole number"),
    ],
)
def test_what_makes_no_sense_is_refused(stated, more, said):
    arguments = {"measure": rocker, "drive": {"A": 0.3}, **more}
    with pytest.raises(ValueError, match=said):
        jk.tolerances(fourbar(100.0, 60.0, 80.0, 60.0), stated, **arguments)
