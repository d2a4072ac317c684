"""Freedoms that are idle but for a misfit: what holds them is small, and so is what they add to the reactions."""

import numpy as np
import pytest

import jaxkin as jk
from reference.higher_pairs import disc_profile
from reference.mechanisms import Z


@pytest.mark.long
def test_a_roller_whose_hinge_misses_its_centre_by_rounding():
    """A profile through points of a circle is off it: the roller was moved by 5e-6 mm, and its hinge was not."""
    centre = (8 + 31 * 0.6, 31 * 0.8, 0.0)
    mechanism = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.revolute("A", "ground", "cam", point=(0, 0, 0), axis=Z),
            jk.cam("C", "cam", "wheel", profile=disc_profile(40), follower="roller", point2=centre, radius=6.0),
            jk.revolute("W", "wheel", "arm", point=centre, axis=Z),
            jk.revolute("P", "ground", "arm", point=(60, 20, 0), axis=Z),
        ],
        unit="mm",
    )
    motion = mechanism.sweep({"A": np.linspace(0.0, 1.0, 5)})
    weight = jk.force("arm", (40, 20, 0), (0, -10, 0))
    found, drive = jk.reactions(motion, applied=weight), jk.drive_forces(motion, applied=weight)
    # the eccentricity over the size is 1e-7
    np.testing.assert_allclose(found.drives["A.phi"], drive.forces["A.phi"], rtol=1e-5)
    np.testing.assert_allclose(found.forces["P"] + found.forces["W"], [[0.0, 10.0, 0.0]] * 5, atol=1e-9)
    assert np.abs(np.asarray(found.torques["W"])).max() < 1e-8  # newton metres: the weight times the eccentricity
