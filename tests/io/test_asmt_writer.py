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


def test_a_joint_keeps_its_limits_and_motor_beside_a_coupling_and_a_thread_of_its_name(tmp_path):
    joints = [
        jk.revolute("A", GROUND, "a", point=(0, 0, 0), axis=Z, limits=(-1.0, 2.0)),
        jk.screw("B", GROUND, "b", point=(3, 0, 0), axis=Z, pitch=2.0),
        jk.revolute("B thread", GROUND, "c", point=(6, 0, 0), axis=Z, limits=(-0.5, 0.5)),
    ]
    gears = [jk.gear("A", "B thread", -0.5, name="A")]
    mechanism = replace(jk.Mechanism.build(fixed=[GROUND], joints=joints, couplings=gears), motors=("A",))
    back = written(mechanism, tmp_path).mechanism()
    assert back.motors == ("A",) and str(back.joints["B"].kind) == "screw"
    assert back.joints["A"].limits == ((-1.0, 2.0),) and back.joints["B thread"].limits == ((-0.5, 0.5),)
    assert [set(each.coordinates) for each in back.linkage.couplings] == [{"A.phi", "B thread.phi"}]


@pytest.mark.parametrize("limits", [None, {"phi": (-0.5, 2.0), "z": (0.0, 3.0)}, {"x": (-1.0, 1.0)}])
def test_joints_that_keep_directions_come_back_as_they_are(tmp_path, limits):
    """But with limits along x, which the format has none of: those are chains."""
    joints = [
        jk.cartesian("gantry", GROUND, "a", axis=(1, 1, 0), direction=(1, -1, 3), point=(1, 2, 3)),
        jk.schoenflies("hand", "a", "b", axis=(0, 3, 4), direction=(5, 4, -3), point=(3, 2, 1), limits=limits),
        jk.constant_angle("slope", "b", "c", axis1=(0, 3, 4), axis2=(1, 1, 1), point=(3, 2, 1)),
        jk.constant_angle("square", "c", "d", axis1=(0, 3, 4), axis2=(1, 0, 0), point=(3, 2, 1)),
    ]
    mechanism = replace(jk.Mechanism.build(fixed=[GROUND], joints=joints), motors=("hand.phi",))
    back = written(mechanism, tmp_path).mechanism()
    if limits and "x" in limits:
        assert back.joints["hand_x"].limits == ((-1.0, 1.0),) and "hand" not in back.joints
        return
    assert [joint.kind for joint in back.all_joints if joint.freedoms] == [joint.kind for joint in joints]
    assert back.joints["hand"].limits == mechanism.joints["hand"].limits and back.motors == mechanism.motors
    compare_moved(mechanism, back, single=False, metres=False)


def test_the_ground_is_called_world_where_the_mechanism_has_one(tmp_path):
    arm = jk.Mechanism.build(fixed=["world"], joints=[jk.revolute("A", "world", "arm", point=(0, 0, 0), axis=Z)])
    back = written(arm, tmp_path).mechanism()
    assert back.fixed == ("world",) and back.parts == ("world", "arm")


def on_carrier(coupling, *, ground=False, flip=1, axis=Z, kind=jk.revolute):
    """A turn and another joint on an arm, or on two fixed parts, tied to each other."""
    arm = jk.revolute("arm", GROUND, "carrier", point=(0.5, 0.2, 0), axis=Z)
    on = ("left", "right") if ground else ("carrier", "carrier")
    a = jk.revolute("a", "one", on[0], point=(1, 0, 0), axis=(0, 0, flip))
    b = kind("b", on[1], "two", **({"point": (3, 1, 0.5)} if kind is jk.revolute else {}), axis=axis)
    fixed = ["left", "right"] if ground else [GROUND]
    return jk.Mechanism.build(fixed=fixed, joints=[*(() if ground else (arm,)), a, b], couplings=[coupling])


@pytest.mark.parametrize("flip", [1, -1])
@pytest.mark.parametrize("ground", [False, True])
@pytest.mark.parametrize(
    ("coupling", "axis", "kind"),
    [
        (jk.gear("a", "b", -0.4, name="ring"), (0, 0, 1), jk.revolute),
        (jk.gear("a", "b", 0.4, name="outer"), (0, 0, 1), jk.revolute),
        (jk.gear("a", "b", 0.4), (0, 0, -1), jk.revolute),
        (jk.belt("b", "a", 2.0, 0.7), (0, 0, 1), jk.revolute),
        (jk.rack("a", "b", 0.8), (0.6, 0.8, 0), jk.prismatic),
        (jk.rack("a", "b", -0.8), (0.6, 0.8, 0), jk.prismatic),
        (jk.relation({"b": 2.0, "a": 0.1}), (0, 0, 1), jk.prismatic),
        (jk.relation({"a": 2.0, "b": 0.1}), (0, 0, -1), jk.prismatic),
    ],
    ids=lambda value: getattr(value, "name", ""),
)
def test_gears_belts_racks_and_screws_come_back(tmp_path, coupling, axis, kind, ground, flip):
    mechanism = on_carrier(coupling, ground=ground, flip=flip, axis=axis, kind=kind)
    back = written(mechanism, tmp_path).mechanism()
    assert [each.name for each in back.linkage.couplings] == [coupling.name]
    compare_moved(mechanism, back, single=False, metres=False)


def test_wheels_that_touch_have_radii_that_reach_from_axis_to_axis(tmp_path):
    jk.write_asmt(on_carrier(jk.gear("a", "b", 0.4)), tmp_path / "model.asmt")
    lines = [line.strip() for line in (tmp_path / "model.asmt").read_text().splitlines()]
    radii = [float(lines[lines.index(key) + 1]) for key in ("radiusI", "radiusJ")]
    np.testing.assert_allclose(sum(np.abs(radii)), np.hypot(2, 1), rtol=1e-15)


@pytest.mark.parametrize(
    "mechanism",
    [
        on_carrier(jk.relation({"arm": 1.0, "b": 0.5})),  # on two carriers
        on_carrier(jk.polynomial("a", "b", [0.0, 1.0, 0.5])),
        on_carrier(jk.gear("a", "b", 1.0), axis=(0, 1, 0)),  # bevel wheels
        on_carrier(jk.rack("a", "b", 1.0), axis=(0, 0.6, 0.8), kind=jk.prismatic),
    ],
    ids=["carriers", "curved", "bevel", "askew"],
)
def test_couplings_that_are_no_gear_rack_or_screw_are_refused(tmp_path, mechanism):
    with pytest.raises(ValueError, match="ASMT cannot say the coupling"):
        jk.write_asmt(mechanism, tmp_path / "model.asmt")
    assert not list(tmp_path.iterdir())


def test_what_cannot_be_written_is_refused(tmp_path):
    with pytest.raises(ValueError, match=r"\.asmt file"):
        jk.write_asmt(planar_fourbar(), tmp_path / "model.xml")
    with pytest.raises(ValueError, match="ASMT cannot say the coupling"):
        jk.write_asmt(coupled(), tmp_path / "model.asmt")
    shaft = jk.constant_velocity("shaft", GROUND, "out", point=(0, 0, 0), axis=Z)
    with pytest.raises(ValueError, match=r"'shaft'.* moves twice, and no coupling .* ties two motions of one joint"):
        jk.write_asmt(jk.Mechanism.build(fixed=[GROUND], joints=[shaft]), tmp_path / "model.asmt")
    ball = jk.Mechanism.build(fixed=[GROUND], joints=[jk.spherical("hip", GROUND, "leg", point=(0, 0, 0))])
    with pytest.raises(ValueError, match="angles of the ball 'hip'"):
        jk.write_asmt(replace(ball, motors=("hip.phi",)), tmp_path / "model.asmt")
    assert not list(tmp_path.iterdir())


def test_a_part_that_is_called_as_the_ground_and_moves_still_does(tmp_path):
    """Readers call the assembly itself "world": the part was taken for it, and all that hung on it stood still."""
    joints = [
        jk.revolute("A", "base", "world", point=(0, 0, 0), axis=(0, 0, 1)),
        jk.revolute("B", "world", "arm", point=(1, 0, 0), axis=(0, 0, 1)),
    ]
    mechanism = jk.Mechanism.build(fixed=["base"], joints=joints)
    back = written(mechanism, tmp_path).mechanism()
    drive = {"A": [0.0, 0.4], "B": [0.0, -0.3]}
    ours, theirs = (each.sweep(drive) for each in (mechanism, back))
    for part, other in (("base", "base"), ("world", "world#2"), ("arm", "arm")):
        np.testing.assert_allclose(ours.transforms[part], theirs.transforms[other], atol=1e-14)  # sums of 1
