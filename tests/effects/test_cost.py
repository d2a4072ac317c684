"""Effects that are not asked for cost nothing: a sweep is the same program whatever is computed of its motion."""

import subprocess
import sys

import jax
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples import path

STUDY = """
geometry = "{file}"
fixed = ["ground"]
[drive]
ground-crank = "0:40:3"
"""


def operations(study) -> list[str]:
    """The operations that a sweep of a study computes, in order, with their shapes."""
    name, values = next(iter(study.drive.items()))
    traced = jax.make_jaxpr(lambda u: study.mechanism.sweep({name: u}).displacements)(np.asarray(values))
    return [f"{each.primitive} {[str(out.aval) for out in each.outvars]}" for each in traced.jaxpr.eqns]


@pytest.mark.long
def test_the_sweep_of_a_study_with_effects_is_the_sweep_without(tmp_path):
    plain, more = tmp_path / "plain.toml", tmp_path / "more.toml"
    plain.write_text(STUDY.format(file=path("fourbar")))
    more.write_text(plain.read_text() + "[effects]\nclashes = true\nrates = true\nforces = { density = 'steel' }\n")
    without, with_effects = (jk.load_study(file) for file in (plain, more))
    before = operations(with_effects)
    assert before == operations(without)
    motion = with_effects.sweep()
    jk.velocities(motion, {"ground-crank": 1.0})
    assert operations(with_effects) == before
    assert without.computed(motion) == {}


@pytest.mark.long
def test_what_effects_need_is_loaded_by_them():
    """Importing jaxkin loads neither matplotlib, which draws, nor trimesh, which measures solids."""
    code = "import sys, jaxkin; print([name for name in ('matplotlib', 'trimesh') if name in sys.modules])"
    said = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert said.stdout.strip() == "[]"
