"""The smallest singular value of the closure Jacobian against numpy's, of a Jacobian by automatic differentiation."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.solve.closure.closure import closure, loop_geometry
from jaxkin.solve.closure.smallest_singular_value import smallest_singular_value
from jaxkin.solve.system.state import State
from reference.mechanisms import planar_fourbar
from reference.systems import loop_system


@pytest.mark.long
def test_the_smallest_singular_value_is_that_of_the_differentiated_residual():
    system, joints = loop_system(planar_fourbar(1.0), [("A", 0)])
    geometry, _ = loop_geometry(system, joints)
    x = jnp.zeros((system.columns, 1))  # closed there, so that the columns are derivatives of the residual
    found = jax.jit(smallest_singular_value, static_argnums=(0, 1))(system, 3, joints, x)
    residual = jax.jit(lambda x: closure(system, geometry, State(x, jnp.zeros((0, 4, 1)))).residual[:, 0])
    jacobian = jax.jit(jax.jacfwd(residual))(x)
    expected = np.linalg.svd(np.asarray(jacobian)[:, list(system.free), 0], compute_uv=False)[2]
    np.testing.assert_allclose(found, expected, rtol=1e-12)  # a condition number of some ten
