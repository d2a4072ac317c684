"""Equilibria in which a joint is beyond its limits: a pendulum between stops, to the tolerances of test_equilibrium."""

import numpy as np

import jaxkin as jk
from reference.mechanisms import Z


def test_equilibria_beyond_the_limits_of_joints_are_told():
    """A pendulum between stops at -2 and 0.5 from the horizontal hangs within them, and does not stand on its head."""
    stops = jk.revolute("A", "base", "arm", point=(0, 0, 0), axis=Z, limits=(-2.0, 0.5))
    mechanism = jk.Mechanism.build(fixed=["base"], joints=[stops], unit="m")
    own = jk.masses(mechanism, given={"arm": jk.Mass(2.0, (0.5, 0.0, 0.0))})
    found = jk.equilibrium(mechanism, {"A": np.linspace(-3.0, 3.0, 25)}, own, gravity=(0, -9.81, 0))
    np.testing.assert_allclose(found.values, [-np.pi / 2, np.pi / 2], atol=1e-9)
    np.testing.assert_allclose(found.beyond_limits["A.phi"], [0.0, np.pi / 2 - 0.5], atol=1e-9)
    hangs, stands = str(found).splitlines()[1:]
    assert hangs.endswith("stable") and stands.endswith("unstable, but beyond the limits of A.phi")
    # without gravity it stays everywhere; of the poses a quarter apart, -2 to 0.5 are eleven
    floats = jk.equilibrium(mechanism, {"A": np.linspace(-3.0, 3.0, 25)}, own, gravity=(0, 0, 0))
    assert not floats.beyond_limits
    assert str(floats).endswith("indifferent, but a joint is beyond its limits at 14 of its 25 poses")
