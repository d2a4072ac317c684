"""Robots in URDF that are written: read back they move as before, and Pinocchio closes them where we do."""

from dataclasses import replace

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples import path
from jaxkin.io.yaml_subset import parse_yaml
from reference.cassie import cassie_leg
from reference.catalogue import GROUND, delta
from reference.mechanisms import cardan_shafts, planar_fourbar, slider_crank
from reference.pinocchio_models import with_balls
from reference.round_trips import METRES, check_solids, compare_moved, host_pose, scale_of, small_drive
from reference.tied import press

Z = (0.0, 0.0, 1.0)


def written(mechanism, folder):
    """The file, and what is read back from it."""
    file = jk.write_urdf(mechanism, folder / "robot.urdf")
    loops = file.with_suffix(".yaml")
    return file, jk.load(file, loops=loops if loops.exists() else None)


def test_a_screw_in_inches_and_a_coupling_are_mimics(tmp_path):
    file, back = written(press(), tmp_path)
    compare_moved(press(), back.mechanism(), single=True)
    assert 'mimic joint="spindle"' in file.read_text()
    joints = [jk.revolute(name, GROUND, f"{name} wheel", point=(0, 0, 10.0 * k), axis=Z) for k, name in enumerate("ab")]
    slide = jk.prismatic("slide", GROUND, "bar", axis=(1, 0, 0))
    couplings = [jk.gear("a", "b", -2.5), jk.rack("b", "slide", 20.0)]
    tied = jk.Mechanism.build(fixed=[GROUND], joints=[*joints, slide], couplings=couplings, unit="mm")
    again = written(replace(tied, motors=("a",)), tmp_path)[1].mechanism()
    compare_moved(tied, again, single=True)
    assert again.motors == ("a",)
    assert not (tmp_path / "robot.yaml").exists()  # there are no loops; the file of the press is taken away


def test_the_tree_is_shallow_and_cut_at_balls(tmp_path):
    file, _ = written(delta(), tmp_path)
    loops = parse_yaml(file.with_suffix(".yaml").read_text(), "robot.yaml")
    assert loops["type"] == ["3d"] * 5  # six forearms hold the platform: one of them is in the tree
    assert len(loops["joint_name"]) == 7 and {*loops["joint_type"]} == {"SPHERICAL"}


@pytest.mark.long
def test_solids_limits_and_motors_come_back(tmp_path):
    mechanism = replace(jk.load(path("fourbar")).mechanism(fixed=["ground"]), motors=("ground-crank",))
    back = written(mechanism, tmp_path)[1]
    check_solids(back.parts, mechanism.solids)
    assert back.mechanism().motors == mechanism.motors
    slide = jk.prismatic("slide", GROUND, "bar", axis=(1, 0, 0), limits=(-5.0, np.inf))
    pin = jk.cylindrical("pin", "bar", "end", point=(0, 0, 0), axis=Z, limits={"phi": (-0.5, 2.0)})
    limited = written(jk.Mechanism.build(fixed=[GROUND], joints=[slide, pin], unit="mm"), tmp_path)[1].mechanism()
    limits = {name: joint.limits for name, joint in limited.joints.items()}
    assert limits == {"slide": ((-0.005, np.inf),), "pin_phi": ((-0.5, 2.0),), "pin_z": ()}


def test_what_cannot_be_written_is_refused(tmp_path):
    mechanism = planar_fourbar()
    with pytest.raises(ValueError, match=r"\.urdf file"):
        jk.write_urdf(mechanism, tmp_path / "model.xml")
    with pytest.raises(FileNotFoundError, match=r"cannot write .*robot\.urdf: there is no folder .*nowhere; make it"):
        jk.write_urdf(mechanism, tmp_path / "nowhere" / "robot.urdf")
    with pytest.raises(ValueError, match="close"):
        jk.write_urdf(mechanism.with_lengths({next(iter(mechanism.lengths)): 45.0}), tmp_path / "robot.urdf")
    joints = [
        jk.revolute(name, GROUND, f"{name} wheel", point=(0, 0, 10.0 * k), axis=Z) for k, name in enumerate("abc")
    ]
    for coupling in (jk.differential("a", "b", "c"), jk.polynomial("a", "b", [0.0, 1.0, 0.5])):
        tied = jk.Mechanism.build(fixed=[GROUND], joints=joints, couplings=[coupling])
        with pytest.raises(ValueError, match=r"URDF cannot say the coupling .*'a"):
            jk.write_urdf(tied, tmp_path / "robot.urdf")
    assert not list(tmp_path.iterdir())


PINOCCHIO = (planar_fourbar, slider_crank, cardan_shafts, delta, cassie_leg)


@pytest.mark.long
@pytest.mark.parametrize("make", PINOCCHIO)
def test_pinocchio_closes_the_loops_where_we_do(make, tmp_path):
    """From our drive alone, by Newton's method on its own kinematics of the written files."""
    pinocchio = pytest.importorskip("pinocchio")
    mechanism = make()
    drive = small_drive(mechanism)
    file, _ = written(mechanism, tmp_path)
    loops = parse_yaml(file.with_suffix(".yaml").read_text(), "robot.yaml")
    model = with_balls(pinocchio, pinocchio.buildModelFromUrdf(str(file)), loops.get("joint_name", ()))
    data, q = model.createData(), pinocchio.neutral(model)
    free = np.ones(model.nv, bool)
    for key, value in drive.items():
        joint = model.joints[model.getJointId(key.rpartition(".")[0])]
        value *= scale_of(mechanism, key)
        q[joint.idx_q : joint.idx_q + joint.nq] = value if joint.nq == 1 else (np.cos(value), np.sin(value))
        free[joint.idx_v] = False
    for _ in range(30):
        pinocchio.computeJointJacobians(model, data, q)
        pinocchio.updateFramePlacements(model, data)
        errors, rows = [], []
        for (one, other), kind in zip(loops["closed_loop"], loops["type"], strict=True):
            first, second = (model.getFrameId(name, pinocchio.FrameType.BODY) for name in (one, other))
            point = kind == "3d"
            between = data.oMf[second].translation - data.oMf[first].translation
            sides = [
                pinocchio.getFrameJacobian(model, data, each, pinocchio.LOCAL_WORLD_ALIGNED) for each in (first, second)
            ]
            turn = pinocchio.log3(data.oMf[second].rotation @ data.oMf[first].rotation.T)
            errors.append(between if point else np.concatenate([between, turn]))
            rows.append((sides[1] - sides[0])[: 3 if point else 6])
        error, jacobian = np.concatenate(errors), np.concatenate(rows)
        step = np.zeros(model.nv)
        step[free] = -np.linalg.lstsq(jacobian[:, free], error, rcond=1e-10)[0]
        q = pinocchio.integrate(model, q, step)
    # the URDF has the numbers of the mechanism in metres, or as they are where it has no unit
    size = max(1.0, *(float(np.abs(joint.frames_1[0][:3, 3]).max()) for joint in mechanism.all_joints))
    assert np.abs(error).max() < 1e-12 * size
    places = host_pose(mechanism, drive)
    spinning = {part for idle in mechanism.mobility().idle_motions for part in idle.parts}
    for part in {*mechanism.parts} - {*mechanism.fixed} - spinning:
        frame = data.oMf[model.getFrameId(part, pinocchio.FrameType.BODY)].homogeneous
        start = begins(file, part)
        np.testing.assert_allclose(frame[:3, :3], places[part][:3, :3], atol=1e-9)  # what the issue asks for
        at = (places[part] @ [*start / METRES[mechanism.unit], 1.0])[:3] * METRES[mechanism.unit]
        np.testing.assert_allclose(frame[:3, 3], at, atol=1e-9 * size, err_msg=part)


def begins(file, part):
    """Where a link begins in the assembled pose: the sum of the origins above it, since no link is turned."""
    from xml.etree import ElementTree

    above = {joint.find("child").get("link"): joint for joint in ElementTree.parse(file).getroot().iterfind("joint")}
    place = np.zeros(3)
    while part in above:
        place += np.array(above[part].find("origin").get("xyz").split(), float)
        part = above[part].find("parent").get("link")
    return place
