"""The yield that tolerances print, and how far it may be off."""

import re

import numpy as np
import pytest

import jaxkin as jk


@pytest.mark.parametrize(("wanted", "share"), [((-1.0, 1.0), 100), ((2.0, 3.0), 0)])
def test_a_yield_of_all_samples_or_none_is_not_exact(wanted, share):
    """The rule of three: of n alike, 3 / n of all may be otherwise, with 95 %; a standard error is about half of it."""
    found = jk.Tolerances(
        label="measure",
        unit="mm",
        keys=(("crank", "A", "B"),),
        stated=(jk.sigma(0.1),),
        dimensions=(1,),
        nominal_lengths=(40.0,),
        nominal=0.0,
        slopes=np.ones(1),
        wanted=wanted,
        samples=np.zeros(4000),
    )
    said = re.search(r"yield ([0-9.]+) ± ([0-9.]+) %", str(found))
    assert said and float(said[1]) == share
    # two digits are printed
    np.testing.assert_allclose(float(said[2]), 100 * 1.5 / 4000, atol=0.006)
