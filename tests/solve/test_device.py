"""Devices that are no CPU take poses all at once: the poses are the same, however they are grouped."""

import sys

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from reference import hard_fourbars, mechanisms
from reference.planar_robots import five_bar

TURN = 2 * np.pi
LONG = jk.SolverOptions().interpolate_from + 7
"""So many poses that a CPU interpolates them, or takes long chunks; no other test has a program of this length."""


def on_another_device(monkeypatch) -> None:
    """Let all modules of the solver take the device for one that is no CPU."""
    for name, module in tuple(sys.modules.items()):
        if name.startswith("jaxkin.") and hasattr(module, "on_cpu"):
            monkeypatch.setattr(module, "on_cpu", lambda: False)


@pytest.mark.long
@pytest.mark.parametrize(
    ("make", "drive", "formulas", "rounding"),
    [
        (mechanisms.planar_fourbar, {"A": np.linspace(0.0, TURN, LONG)}, True, 1e-13),
        (mechanisms.rssr_linkage, {"A": np.linspace(TURN, 0.0, LONG)}, False, 1e-13),
        (
            lambda: hard_fourbars.FOURBAR(**hard_fourbars.NON_GRASHOF),
            {"A": np.linspace(-np.pi, np.pi, LONG)},
            True,
            1e-7,
        ),
        (lambda: five_bar(72.0), {"A": np.linspace(0.0, 2.0, 301), "E": np.linspace(0.0, -2.0, 301)}, True, 1e-7),
    ],
    ids=["formula", "continuation", "beyond limits", "several inputs"],
)
def test_poses_do_not_depend_on_their_groups(make, drive, formulas, rounding, monkeypatch):
    mechanism, options = make(), jk.SolverOptions(formulas=formulas)
    grouped = mechanism.sweep(drive, options=options)
    on_another_device(monkeypatch)
    other = mechanism.sweep({name: values[:-1] for name, values in drive.items()}, options=options)
    assert np.array_equal(np.asarray(grouped.status)[:-1], other.status)
    closed = np.asarray(other.closed)
    for name, values in other.coordinates.items():
        # radians: poses are closed to rounding, of which they differ by the root beside a limit
        wanted = np.asarray(grouped.coordinates[name])[:-1]
        np.testing.assert_allclose(np.asarray(values)[closed], wanted[closed], atol=rounding, err_msg=name)


def test_no_loop_runs_over_the_poses_inside_jit():
    """A GPU would take one step of it after another: `jnp.maximum.accumulate` is such a loop."""
    mechanism, poses = mechanisms.planar_fourbar(), 1009

    def loss(inputs):
        motion = mechanism.sweep({"A": inputs})
        return jnp.sum(motion.coordinates["D"] ** 2) + jnp.sum(motion.points("coupler", (1.0, 2.0, 0.0)))

    for function in (loss, jax.grad(loss)):
        assert f"length={poses}" not in str(jax.make_jaxpr(function)(jnp.linspace(0.0, 6.0, poses)))
