"""Assemblies of FreeCAD's solver that are written: joints, limits and motors come back, in the unit they were in."""

from dataclasses import replace

import numpy as np
import pytest

import jaxkin as jk
from reference.catalogue import GROUND
from reference.mechanisms import planar_fourbar
from reference.round_trips import compare_moved
from reference.tied import coupled, press

Z = (0.0, 0.0, 1.0)


def written(mechanism, folder):
    return jk.load(jk.write_asmt(mechanism, folder / "model.asmt"))


def test_a_screw_and_a_universal_joint_come_back_as_they_are(tmp_path):
    back = written(press(), tmp_path).mechanism()
    compare_moved(press(), back, single=False, metres=False)
    kinds = {name: str(joint.kind) for name, joint in back.joints.items() if joint.freedoms}
    assert kinds == {"spindle": "screw", "low": "spherical", "top": "universal", "rail": "prismatic"}
    assert float(back.joints["spindle"].pitch) == 0.5


def test_limits_and_motors_come_back(tmp_path):
    slide = jk.prismatic("rail/slide", GROUND, "bar", axis=(1, 0, 0), limits=(-5.0, np.inf))
    pin = jk.cylindrical("pin", "bar", "end", point=(0, 0, 0), axis=Z, limits={"phi": (-0.5, 2.0)})
    cross = jk.universal("cross", "end", "fork", point=(1, 0, 0), axis1=Z, axis2=(0, 1, 0), limits={"phi": (-1, 1)})
    mechanism = jk.Mechanism.build(fixed=[GROUND], joints=[slide, pin, cross], unit="mm")
    mechanism = replace(mechanism, motors=("rail/slide", "pin.phi"))
    back = written(mechanism, tmp_path).mechanism()
    assert back.motors == ("rail/slide", "pin.phi")
    assert back.joints["rail/slide"].limits == ((-5.0, np.inf),)
    assert back.joints["pin"].limits == ((-np.inf, np.inf), (-0.5, 2.0))
    first, second = (name for name in back.joints if name.startswith("cross"))  # in turn, since it has limits
    assert back.joints[first].limits == ((-1.0, 1.0),) and back.joints[second].limits == ()


def test_the_ground_is_called_world_where_the_mechanism_has_one(tmp_path):
    arm = jk.Mechanism.build(fixed=["world"], joints=[jk.revolute("A", "world", "arm", point=(0, 0, 0), axis=Z)])
    back = written(arm, tmp_path).mechanism()
    assert back.fixed == ("world",) and back.parts == ("world", "arm")


def test_what_cannot_be_written_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"\.asmt file"):
        jk.write_asmt(planar_fourbar(), tmp_path / "model.xml")
    with pytest.raises(ValueError, match="ASMT cannot say the coupling"):
        jk.write_asmt(coupled(), tmp_path / "model.asmt")
    shaft = jk.constant_velocity("shaft", GROUND, "out", point=(0, 0, 0), axis=Z)
    with pytest.raises(ValueError, match=r"'shaft'.* moves twice"):
        jk.write_asmt(jk.Mechanism.build(fixed=[GROUND], joints=[shaft]), tmp_path / "model.asmt")
    ball = jk.Mechanism.build(fixed=[GROUND], joints=[jk.spherical("hip", GROUND, "leg", point=(0, 0, 0))])
    with pytest.raises(ValueError, match="angles of the ball 'hip'"):
        jk.write_asmt(replace(ball, motors=("hip.phi",)), tmp_path / "model.asmt")
    assert not list(tmp_path.iterdir())
