"""Tables of results name the units of their columns: radians, and lengths where their unit is known."""

import csv

import numpy as np
import pytest

import jaxkin as jk
from reference.mechanisms import planar_fourbar


@pytest.mark.long
@pytest.mark.parametrize(("unit", "length"), [("mm", " [mm]"), ("", "")])
def test_tables_name_the_units_of_their_columns(unit, length, tmp_path):
    fourbar = planar_fourbar(1.0)
    mechanism = jk.Mechanism.build(fixed=fourbar.fixed, joints=list(fourbar.joints.values()), unit=unit)
    slider = jk.Mechanism.build(
        fixed=["ground"],
        joints=[
            jk.prismatic("X", "ground", "carriage", point=(0, 0, 0), axis=(1, 0, 0)),
            jk.revolute("A", "carriage", "arm", point=(0, 0, 0), axis=(0, 0, 1)),
        ],
        unit=unit,
    )
    inputs = {"X.z": np.linspace(-1, 1, 5), "A.phi": np.linspace(-1, 1, 5)}
    workspace = jk.workspace(slider, inputs, "arm", (2.0, 0.0, 0.0))
    places = [f"{axis}{length}" for axis in "xyz"]
    motion = mechanism.sweep({"A": np.linspace(0, 0.5, 5)})
    expected = {
        workspace: [f"X.z{length}", "A.phi [rad]", "status", *places, "sigma_min", "condition"],
        jk.coupler_curve(motion, "coupler", (50.0, 20.0, 0.0)): ["A.phi [rad]", *places],
        jk.limits(mechanism, "A"): [f"{name}.phi [rad]" for name in "ABCD"],
        jk.motion_law([("cycloidal", 1.0, 1.0)]): ["time [s]", "displacement", "velocity", "acceleration", "jerk"],
    }
    for found, names in expected.items():
        with found.save(tmp_path / "table.csv").open(newline="") as file:
            assert next(csv.reader(file)) == ["pose", *names], type(found).__name__
