"""The smallest singular value of the closure Jacobian against numpy's, of a Jacobian by automatic differentiation."""

import jax
import jax.numpy as jnp
import numpy as np

from jaxkin.solve.closure.closure import closure, loop_geometry
from jaxkin.solve.closure.smallest_singular_value import smallest_singular_value
from jaxkin.solve.system.from_linkage import block_joints, block_system
from jaxkin.solve.system.state import State
from reference.mechanisms import planar_fourbar


def test_the_smallest_singular_value_is_that_of_the_differentiated_residual():
    mechanism = planar_fourbar(1.0)
    (group,), (loop_class,) = mechanism.structure.loop_groups, mechanism.linkage.classes
    system, _ = block_system(mechanism.linkage, group, ((0, 0),), loop_class)
    joints = block_joints(mechanism.all_joints, group)
    geometry, _ = loop_geometry(system, *jax.tree.map(jnp.asarray, joints))
    x = jnp.zeros((system.columns, 1))  # closed there, so that the columns are derivatives of the residual
    found = smallest_singular_value(system, 3, joints, x)
    jacobian = jax.jacfwd(lambda x: closure(system, geometry, State(x, jnp.zeros((0, 4, 1)))).residual[:, 0])(x)
    expected = np.linalg.svd(np.asarray(jacobian)[:, list(system.free), 0], compute_uv=False)[2]
    np.testing.assert_allclose(found, expected, rtol=1e-12)  # a condition number of some ten
