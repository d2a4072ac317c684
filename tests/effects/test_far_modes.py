"""Assembly modes far from the assembled pose: against the roots of one equation."""

import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk

Z = (0.0, 0.0, 1.0)


@pytest.mark.long
@pytest.mark.parametrize(
    ("home", "radius", "height", "pitch"), [(6.0, 1.0, 2.5, 0.8), (6.0, 2.0, 3.0, 0.8), (3.0, 1.0, 2.0, 1.5)]
)
def test_a_nut_on_a_rod_has_modes_on_the_far_side_of_its_screw(home, radius, height, pitch):
    """A rod holds a ball on the nut at its length from a foot: a helix crosses a sphere on both sides.

    That of the far side is more than two characteristic lengths from the assembled pose, of 4 to 12 modes in all.
    """
    foot, pivot, turn = np.array([0.0, height, 0.0]), np.array([0.0, height + 1.5, 0.0]), 0.1
    ball = np.array([home, radius, 0.0])
    press = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.screw("screw", "ground", "nut", point=(home, 0.0, 0.0), axis=(1.0, 0.0, 0.0), pitch=pitch),
            jk.spherical("ball", "nut", "rod", point=tuple(ball)),
            jk.spherical("foot", "rod", "arm", point=tuple(foot)),
            jk.revolute("arm", "ground", "arm", point=tuple(pivot), axis=Z),
        ],
    )
    modes = jk.assembly_modes(press, {"arm": turn})
    found = np.sort([float(mode.coordinates["screw"][0]) for mode in modes])

    q = np.linspace(-200.0, 100.0, 300_001)
    helix = np.stack([home + pitch * q / (2 * np.pi), radius * np.cos(q), radius * np.sin(q)], axis=1)
    moved = pivot + 1.5 * np.array([np.sin(turn), -np.cos(turn), 0.0])
    beyond = np.linalg.norm(helix - moved, axis=1) - np.linalg.norm(ball - foot)
    (signs,) = np.nonzero(beyond[:-1] * beyond[1:] < 0)
    assert len(found) == len(signs), (found, q[signs])
    np.testing.assert_allclose(found, q[signs], rtol=0, atol=1.1e-3)  # the roots are within one interval
    size = np.sqrt(
        np.var(np.asarray(jnp.stack([joint.frames_1[0, :3, 3] for joint in press.all_joints])), axis=0).sum()
    )
    assert np.abs(found).max() * pitch / (2 * np.pi) > 2.0 * size
