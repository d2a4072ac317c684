"""A drive that turns many times before it locks: a turn less is another pose."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.solve.status import Status

Z, X = (0.0, 0.0, 1.0), (1.0, 0.0, 0.0)
PITCH = 0.1


@pytest.mark.long
def test_a_nut_does_not_jump_its_thread_where_the_linkage_locks():
    """Its nut pulls a dyad of bars sqrt(0.72) and sqrt(0.73) long, from (0.3 + advance, 0.2) to (1.2, 0).

    Beyond the lock, 26 turns from the assembled pose, loops would close with the nut a thread farther back.
    """
    joints = [
        jk.revolute("A", "ground", "spindle", point=(0, 0, 0), axis=X),
        jk.screw("S", "nut", "spindle", point=(0, 0, 0), axis=X, pitch=PITCH),
        jk.prismatic("N", "ground", "nut", axis=X),
        jk.revolute("E", "nut", "rod", point=(0.3, 0.2, 0), axis=Z),
        jk.revolute("F", "rod", "rocker", point=(0.9, 0.8, 0), axis=Z),
        jk.revolute("G", "ground", "rocker", point=(1.2, 0, 0), axis=Z),
    ]
    mechanism = jk.Mechanism.build(fixed=["ground"], joints=joints)
    reach = np.sqrt((np.sqrt(0.72) + np.sqrt(0.73)) ** 2 - 0.2**2)
    locks = np.sort(2 * np.pi / PITCH * (0.9 + reach * np.array([1.0, -1.0])) * -1.0)  # of A, against the thread
    np.testing.assert_allclose(jk.limits(mechanism, "A").range, locks, rtol=1e-9)
    inside, beside = locks * (1 - 1e-3), locks * (1 + 1e-3)
    motion = mechanism.sweep({"A": np.concatenate([inside, beside, locks - [3.0, -3.0]])})
    np.testing.assert_array_equal(motion.status, [Status.CLOSED.value] * 2 + [Status.UNREACHABLE.value] * 4)
    np.testing.assert_allclose(motion.coordinates["N"][:2, 0], -PITCH * inside / (2 * np.pi), rtol=1e-9)
