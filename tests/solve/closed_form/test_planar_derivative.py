"""Derivatives of planar dyads by screws: those that JAX makes of the formulas, which know nothing of screws."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from jaxkin.mechanism.drive_plan import plan_drive
from jaxkin.solve.closed_form.planar_derivative import planar_slopes
from jaxkin.solve.closed_form.solve_groups import solve_groups
from reference import catalogue
from reference.mechanisms import planar_fourbar, slider_crank


@pytest.mark.long
@pytest.mark.parametrize(
    ("make", "drive"),
    [
        (planar_fourbar, "A"),
        (slider_crank, "A"),
        (catalogue.scotch_yoke, "A"),
        pytest.param(catalogue.quick_return, "A", marks=pytest.mark.study),
        pytest.param(catalogue.watt, "A", marks=pytest.mark.study),
    ],
)
def test_slopes_are_those_of_the_formulas(make, drive):
    """Along any change of centres and directions, of what is left open, and of the input; once, and once more."""
    (group,) = plan_drive(make().linkage, (drive,)).loop_groups
    system, axes = group.system, jax.tree.map(jnp.asarray, group.axes)
    signs, random = list(group.line.signs), np.random.default_rng(0)
    still = jnp.linspace(-0.4, 0.9, 7)[None]

    def any_of(array):
        return jnp.asarray(random.normal(size=array.shape))

    centre, shift, turn, input_ = (
        any_of(each) for each in (axes.centre, axes.open_shift, axes.open_shift[:, 0], still)
    )
    direction = any_of(axes.direction[..., 0])

    def turned(vectors, angle):
        """Vectors of the plane, turned: they keep their lengths, as those of rigid frames do."""
        x, y = vectors[..., 0], vectors[..., 1]
        cos, sin = jnp.cos(angle), jnp.sin(angle)
        return jnp.stack([cos * x - sin * y, sin * x + cos * y], axis=-1)

    def at(t):
        changed = axes._replace(
            centre=axes.centre + t * centre,
            direction=turned(axes.direction, t * direction),
            open_turn=turned(axes.open_turn.swapaxes(1, 2), t * turn[:, None]).swapaxes(1, 2),
            open_shift=axes.open_shift + t * shift,
        )
        return changed, still + t * input_

    def formulas(t):
        axes, inputs = at(t)
        return jnp.stack([jnp.asarray(each.value) for each in solve_groups(system, axes, signs, inputs).coordinates])

    def by_formulas(t):
        return jax.jvp(formulas, (t,), (1.0,))[1]

    def by_screws(t):
        (here, _), (d_axes, d_inputs) = jax.jvp(at, (t,), (1.0,))
        return jnp.stack(planar_slopes(system, here, list(formulas(t)), d_axes, d_inputs))

    one, other = (jax.jit(lambda t, f=f: jax.jvp(f, (t,), (1.0,)))(0.0) for f in (by_screws, by_formulas))
    for found, expected in zip(one, other, strict=True):
        # some thousand roundings of the largest: both divide by the sine of the elbow, once and thrice
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-12 * np.abs(np.asarray(expected)).max())
