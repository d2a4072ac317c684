"""Loads as users hand them over."""

import numpy as np

import jaxkin as jk


def test_an_iterator_of_loads_acts_as_a_list_of_them():
    """It has nothing left for whoever asks a second time: one newton on a slide takes one newton of its drive."""
    slide = jk.prismatic("P", "base", "block", axis=(1, 0, 0))
    motion = jk.Mechanism.build(fixed=["base"], joints=[slide]).sweep({"P": np.linspace(0, 1, 3)})
    own = jk.masses(motion.mechanism, given={"block": jk.Mass(3.0, (0, 0, 0))})

    def loads():
        yield jk.force("block", (0, 0, 0), (1.0, 0, 0))

    np.testing.assert_allclose(jk.drive_forces(motion, own, applied=loads()).forces["P.z"], -1.0, rtol=1e-12)
    np.testing.assert_allclose(jk.reactions(motion, own, applied=loads()).drives["P.z"], -1.0, rtol=1e-12)
