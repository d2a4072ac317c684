"""Models of MuJoCo that are written: read back they move as before, and MuJoCo itself, where it is there, closes them.

Random poses of the tree are no solution of the loops: MuJoCo's residual of a pose of ours is the independent check.
"""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import jaxkin as jk
from jaxkin.examples import path
from reference.catalogue import GROUND, delta, oldham, scotch_yoke, swash_plate
from reference.mechanisms import cam, planar_fourbar, slider_crank
from reference.round_trips import METRES, check_solids, host_pose, in_metres
from reference.tied import coupled, press

Z = (0.0, 0.0, 1.0)


CASES = {
    "four-bar": (planar_fourbar, {"A": np.linspace(0, 1.5, 7)}),
    "slider-crank": (slider_crank, {"A": np.linspace(0, 1.5, 7)}),
    "scotch yoke": (scotch_yoke, None),
    "cam": (cam, None),
    "Oldham": (oldham, None),
    "swash plate": (swash_plate, None),
    "press": (press, {"spindle": np.linspace(0, 0.8, 5)}),
    "delta": (delta, None),
    "couplings": (coupled, {"a": np.linspace(0, 1, 5), "b": np.linspace(0, -2, 5)}),
}


def drive_of(mechanism, drive):
    """The given drive, or small steps of what can drive."""
    if drive is not None:
        return drive
    names = mechanism.mobility().drivable[: mechanism.mobility().freedoms]
    return {name: np.linspace(0, 0.2, 5) for name in names}


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.long] * (name != "four-bar")) for name in CASES]
)
def test_it_is_read_back_as_the_same_mechanism(name, tmp_path):
    make, drive = CASES[name]
    mechanism = make()
    drive = drive_of(mechanism, drive)
    back = jk.load(jk.write_mjcf(mechanism, tmp_path / "model.xml")).mechanism()
    assert back.mobility().freedoms == mechanism.mobility().freedoms
    drive_back = {written_as(mechanism, key): values * scale_of(mechanism, key) for key, values in drive.items()}
    expected = in_metres(mechanism, mechanism.sweep(drive, throw=True).transforms)
    found = in_metres(back, back.sweep(drive_back, throw=True).transforms)
    size = max(1.0, *(float(np.abs(each).max()) for each in expected.values()))
    for part, transforms in expected.items():
        # 1e-12 of the largest number: both sweeps close to rounding, and conditioning takes two digits
        np.testing.assert_allclose(found[part], transforms, rtol=0, atol=1e-12 * size, err_msg=part)


def written_as(mechanism, key):
    """The name in the file of a driven coordinate."""
    joint = key if key in mechanism.joints else key.rpartition(".")[0]
    several = len(mechanism.joints[joint].driven_together) > 1
    return f"{joint}_{key.rpartition('.')[2]}" if several else joint


def scale_of(mechanism, key):
    joint = key if key in mechanism.joints else key.rpartition(".")[0]
    coordinate = mechanism.joints[joint].coordinates[0] if joint == key else key.rpartition(".")[2]
    return METRES[mechanism.unit] if coordinate[0] in "xyz" else 1.0


@pytest.mark.long
def test_solids_limits_and_motors_come_back(tmp_path):
    assembly = jk.load(path("fourbar"))
    mechanism = assembly.mechanism(fixed=["ground"])
    mechanism = replace(mechanism, motors=("ground-crank",))
    back = jk.load(jk.write_mjcf(mechanism, tmp_path / "model.xml"))
    check_solids(back.parts, mechanism.solids)
    assert back.mechanism().motors == mechanism.motors


def test_limits_come_back_in_metres(tmp_path):
    slide = jk.prismatic("slide", GROUND, "bar", axis=(1, 0, 0), limits=(-5.0, np.inf))
    pin = jk.cylindrical("pin", "bar", "end", point=(0, 0, 0), axis=Z, limits={"phi": (-0.5, 2.0)})
    mechanism = jk.Mechanism.build(fixed=[GROUND], joints=[slide, pin], unit="mm")
    back = jk.load(jk.write_mjcf(mechanism, tmp_path / "model.xml")).mechanism()
    assert back.joints["slide"].limits == ((-0.005, np.inf),)
    assert back.joints["pin_phi"].limits == ((-0.5, 2.0),)
    assert back.joints["pin_z"].limits == ()


def test_what_cannot_be_written_is_refused(tmp_path):
    mechanism = planar_fourbar()
    with pytest.raises(ValueError, match=r"\.xml file"):
        jk.write_mjcf(mechanism, tmp_path / "model.urdf")
    longer = mechanism.with_lengths({next(iter(mechanism.lengths)): 45.0})
    with pytest.raises(ValueError, match="close"):
        jk.write_mjcf(longer, tmp_path / "model.xml")
    joints = [jk.revolute(name, GROUND, f"{name} wheel", point=(0, 0, 10.0 * k), axis=Z) for k, name in enumerate("ab")]
    tied = jk.Mechanism.build(fixed=[GROUND], joints=joints, couplings=[jk.polynomial("a", "b", [0, 1, 0, 0, 0, 1.0])])
    with pytest.raises(ValueError, match="power 4"):
        jk.write_mjcf(tied, tmp_path / "model.xml")
    assert not list(tmp_path.iterdir())


@pytest.mark.long
@pytest.mark.parametrize("name", CASES)
def test_mujoco_closes_it_where_we_do(name, tmp_path):
    """MuJoCo's own kinematics and constraints at the joint values of our poses: the loops are closed there."""
    mujoco = pytest.importorskip("mujoco")
    make, drive = CASES[name]
    mechanism = make()
    back = jk.load(jk.write_mjcf(mechanism, tmp_path / "model.xml")).mechanism()
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "model.xml"))
    data = mujoco.MjData(model)
    drive = drive_of(mechanism, drive)
    motion = back.sweep({written_as(mechanism, key): at * scale_of(mechanism, key) for key, at in drive.items()})
    for pose in range(len(motion)):
        for number in range(model.njnt):
            joint, first = model.joint(number), model.jnt_qposadr[number]
            values = np.asarray(motion.coordinates[joint.name])[pose]
            if len(values) == 3:  # theta, phi, psi about x, y, z of the world, as Rz Ry Rx
                quaternion = Rotation.from_euler("xyz", values).as_quat(scalar_first=True)
                data.qpos[first : first + 4] = quaternion
            else:
                data.qpos[first] = values[0]
        mujoco.mj_forward(model, data)
        np.testing.assert_allclose(data.efc_pos[data.efc_type == 0], 0, atol=1e-12)  # rounding, of metres below 1e3
        for body in range(1, model.nbody):
            expected = np.asarray(motion.transforms[model.body(body).name])[pose]
            np.testing.assert_allclose(data.xpos[body], expected[:3, 3], rtol=0, atol=1e-12)
            np.testing.assert_allclose(data.xmat[body].reshape(3, 3), expected[:3, :3], rtol=0, atol=1e-12)


def test_mujoco_settles_where_we_close_it(tmp_path):
    """Its own simulation from a start that is open, slowed down: what it comes to is a pose of ours."""
    mujoco = pytest.importorskip("mujoco")
    sizes = {"ground": 1.0, "crank": 0.4, "coupler": 1.2, "rocker": 0.8}
    mechanism = planar_fourbar(**sizes)
    model = mujoco.MjModel.from_xml_path(str(jk.write_mjcf(mechanism, tmp_path / "model.xml")))
    data = mujoco.MjData(model)
    model.opt.gravity[:] = 0
    model.dof_armature[0] = 1e-5  # ten times the rest, so that the loop closes near where the crank is put
    data.qpos[0] = 0.3
    for _ in range(10_000):
        data.qvel[:] *= 0.9
        mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    soft = np.abs(data.efc_pos[: data.ne]).max()
    assert soft < 1e-6 and data.qpos[0] > 0.01
    places = host_pose(mechanism, {"A.phi": float(data.qpos[0])})
    for body in ("crank", "coupler", "rocker"):
        # the loop is regular: angles follow what is left open, with factors of a few
        np.testing.assert_allclose(data.body(body).xpos, places[body][:3, 3], atol=1e-9 + 100 * soft)
        np.testing.assert_allclose(data.body(body).xmat.reshape(3, 3), places[body][:3, :3], atol=1e-9 + 100 * soft)
