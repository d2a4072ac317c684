"""What is of another type than its annotation is refused in words, before anything is computed.

These calls are kept apart from those in which continuous integration checks types of arguments.
"""

from pathlib import Path

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples import path

Z = (0.0, 0.0, 1.0)
NOTHING, TEXT, NUMBER, OBJECT, IMAGINARY = None, "nonsense", 3, object(), 1j
NO_MECHANISM = NO_MOTION = (NOTHING, TEXT, NUMBER, {}, [1, 2])
NO_NUMBER = (NOTHING, TEXT, OBJECT, IMAGINARY, {})
NOT_FINITE = (np.nan, np.inf)
NO_LIST = (NUMBER, TEXT, OBJECT)
NO_NAMES = (NUMBER, TEXT, OBJECT, [OBJECT], np.zeros((2, 3)))
NO_MAPPING = (NUMBER, TEXT, OBJECT, [1, 2])
NO_COUNT = (TEXT, -1, 1.5, OBJECT, True)
NO_TEXT = (NOTHING, NUMBER, OBJECT, [1, 2])
NO_CHOICE = (NOTHING, NUMBER, TEXT, OBJECT)


@pytest.fixture(scope="module")
def assembly():
    return jk.load(path("fourbar"))


@pytest.fixture(scope="module")
def fourbar(assembly):
    return assembly.mechanism(fixed=["ground"])


@pytest.fixture(scope="module")
def motion(fourbar):
    return fourbar.sweep({"ground-crank": np.linspace(0.0, 0.4, 5)})


def hinge(name="A", one="base", other="arm"):
    return jk.revolute(name, one, other, point=(0.0, 0.0, 0.0), axis=Z)


def framed(kind="revolute", places=None):
    return jk.joint_on_frames("A", "base", "arm", kind=kind, frame1=np.eye(4), frame2=np.eye(4), places=places)


def refused(call, given):
    """Call with something wrong: a ValueError of jaxkin's own, of a few lines, and no output of another library."""
    with pytest.raises(ValueError) as error:
        call(given)
    assert Path(error.traceback[-1].path).is_relative_to(Path(jk.__file__).parent)
    assert "truth value" not in str(error.value) and str(error.value).count("\n") < 6


DRIVE = {"ground-crank": np.linspace(0.0, 0.4, 5)}
LENGTH = {("coupler", "crank-coupler", "coupler-rocker"): (1.0, 1e3)}
OF_MECHANISMS = {
    "equilibrium": (
        (lambda m, x: jk.equilibrium(x, DRIVE), NO_MECHANISM),
        (jk.equilibrium, (NOTHING, *NO_MAPPING)),
        (lambda m, x: jk.equilibrium(m, {"ground-crank": x}), NO_NUMBER),
    ),
    "limits": (
        (lambda m, x: jk.limits(x, "ground-crank"), NO_MECHANISM),
        (jk.limits, NO_TEXT),
        (lambda m, x: jk.limits(m, "ground-crank", hold=x), (NOTHING, *NO_LIST)),
        (lambda m, x: jk.limits(m, "ground-crank", ranges=x), NO_MAPPING),
    ),
    "assembly modes": (
        (lambda m, x: jk.assembly_modes(x, {"ground-crank": 0.1}), NO_MECHANISM),
        (lambda m, x: jk.assembly_modes(m, {"ground-crank": x}), (*NO_NUMBER, *NOT_FINITE, True)),
        (lambda m, x: jk.assembly_modes(m, {"ground-crank": 0.1}, tries=x), (NOTHING, 0, *NO_COUNT)),
        (lambda m, x: jk.assembly_modes(m, {"ground-crank": 0.1}, seed=x), (NOTHING, *NO_COUNT)),
    ),
    "workspace": (
        (lambda m, x: jk.workspace(x, DRIVE, "crank", Z), NO_MECHANISM),
        (lambda m, x: jk.workspace(m, x, "crank", Z), (NOTHING, *NO_MAPPING)),
    ),
    "tolerances": (
        (lambda m, x: jk.tolerances(x, {("crank", "A", "B"): 0.1}, len), NO_MECHANISM),
        (lambda m, x: jk.tolerances(m, x, len), (NOTHING, *NO_MAPPING)),
        (lambda m, x: jk.tolerances(m, {next(iter(m.lengths)): 0.1}, len, drive=x), NO_MAPPING),
        (lambda m, x: jk.tolerances(m, {next(iter(m.lengths)): 0.1}, len, samples=x), (NOTHING, *NO_COUNT)),
        (lambda m, x: jk.tolerances(m, {next(iter(m.lengths)): 0.1}, len, seed=x), (NOTHING, *NO_COUNT)),
        (lambda m, x: jk.tolerances(m, {next(iter(m.lengths)): 0.1}, x), (NOTHING, TEXT, NUMBER)),
    ),
    "project": (
        (lambda m, x: jk.project(x, {"ground-crank": [0.1]}), NO_MECHANISM),
        (lambda m, x: jk.project(m, {"ground-crank": x}), (*NO_NUMBER, [])),
        (lambda m, x: jk.project(m, {"ground-crank": [0.1]}, hold=x), (NOTHING, *NO_LIST)),
        (lambda m, x: jk.project(m, {"ground-crank": [0.1]}, weights=x), NO_MAPPING),
    ),
    "inverse": (
        (lambda m, x: jk.inverse(x, {"ground-crank": [0.1]}), NO_MECHANISM),
        (lambda m, x: jk.inverse(m, {"ground-crank": [0.1]}, weights=x), NO_MAPPING),
        (lambda m, x: jk.inverse(m, {"ground-crank": [0.1]}, inputs=x), NO_LIST),
        (lambda m, x: jk.inverse(m, {"ground-crank": [0.1]}, rest=x), NO_MAPPING),
        (lambda m, x: jk.inverse(m, {"ground-crank": [0.1]}, limits=x), NO_CHOICE),
        (lambda m, x: jk.inverse(m, {"ground-crank": [0.1]}, starts=x), (NOTHING, *NO_COUNT)),
    ),
    "calibrate": (
        (lambda m, x: jk.calibrate(x, DRIVE, {"ground-rocker": np.zeros(5)}), NO_MECHANISM),
        (lambda m, x: jk.calibrate(m, x, {"ground-rocker": np.zeros(5)}), (NOTHING, *NO_MAPPING)),
        (lambda m, x: jk.calibrate(m, DRIVE, x), (NOTHING, *NO_MAPPING)),
        (lambda m, x: jk.calibrate(m, DRIVE, {"ground-rocker": np.zeros(5)}, lengths=x), (NOTHING, *NO_LIST)),
        (lambda m, x: jk.calibrate(m, DRIVE, {"ground-rocker": np.zeros(5)}, frames=x), (NOTHING, *NO_LIST, [1])),
        (lambda m, x: jk.calibrate(m, DRIVE, {"ground-rocker": np.zeros(5)}, markers=x), (*NO_LIST, [1])),
        (lambda m, x: jk.calibrate(m, DRIVE, {"ground-rocker": np.zeros(5)}, iterations=x), (NOTHING, *NO_COUNT)),
    ),
    "optimize": (
        (lambda m, x: jk.optimize(len, x, drive=DRIVE, lengths={("crank", "A", "B"): (1, 2)}), NO_MECHANISM),
        (lambda m, x: jk.optimize(len, m, drive=DRIVE, lengths=x), NO_MAPPING),
        (lambda m, x: jk.optimize(len, m, drive=x), (NOTHING, *NO_MAPPING)),
        (lambda m, x: jk.optimize(len, m, drive=DRIVE, extras=x), NO_MAPPING),
        (lambda m, x: jk.optimize(len, m, drive=DRIVE, starts=x), (NOTHING, 0, *NO_COUNT)),
        (lambda m, x: jk.optimize(len, m, drive=DRIVE, lengths=LENGTH, ties=x), NO_MAPPING),
        (lambda m, x: jk.optimize(len, m, drive=DRIVE, lengths=LENGTH, constraints=x), (NOTHING, len, *NO_LIST)),
    ),
    "work_precision": (
        (lambda m, x: jk.work_precision(x, DRIVE), NO_MECHANISM),
        (lambda m, x: jk.work_precision(m, DRIVE, tolerances=x), (NOTHING, *NO_LIST, ["a"], np.zeros((2, 3)))),
        (lambda m, x: jk.work_precision(m, DRIVE, methods=x), (NOTHING, *NO_LIST)),
    ),
    "sweep": (
        (lambda m, x: m.sweep(x), (NOTHING, *NO_MAPPING)),
        (lambda m, x: m.sweep({"ground-crank": x}), NO_NUMBER),
        (lambda m, x: m.plan(x), (NOTHING, *NO_LIST)),
        (lambda m, x: m.close(hold=x), (NOTHING, *NO_LIST)),
        (lambda m, x: m.with_couplings(x), (NOTHING, *NO_LIST)),
        (lambda m, x: m.at(x), NO_MOTION),
    ),
    "files": (
        (lambda m, x: jk.write_mjcf(x, "arm.xml"), NO_MECHANISM),
        (lambda m, x: jk.write_urdf(x, "arm.urdf"), NO_MECHANISM),
        (lambda m, x: jk.write_asmt(x, "arm.asmt"), NO_MECHANISM),
        (lambda m, x: jk.write_study(x, "arm.toml"), NO_MECHANISM),
    ),
}
OF_MOTIONS = {
    "rates": (
        (lambda m, x: jk.velocities(x, {"ground-crank": 1.0}), NO_MOTION),
        (jk.velocities, (NOTHING, *NO_MAPPING)),
        (lambda m, x: jk.velocities(m, {"ground-crank": x}), NO_NUMBER),
        (lambda m, x: jk.accelerations(m, {}, x), NO_MAPPING),
        (lambda m, x: jk.screw_axes(x, "crank"), NO_MOTION),
    ),
    "forces": (
        (lambda m, x: jk.drive_forces(x), NO_MOTION),
        (jk.drive_forces, (TEXT, NUMBER, {}, OBJECT)),
        (
            lambda m, x: jk.drive_forces(m, jk.masses(m.mechanism, "steel"), gravity=x),
            (*NO_NUMBER, [1, 2], [np.nan] * 3),
        ),
        (lambda m, x: jk.drive_forces(m, applied=x), (NOTHING, *NO_LIST)),
        (lambda m, x: jk.reactions(m, applied=x), (NOTHING, *NO_LIST)),
        (lambda m, x: jk.transmission(x, "ground-rocker"), NO_MOTION),
        (lambda m, x: jk.masses(x, "steel"), NO_MECHANISM),
        (lambda m, x: jk.masses(m.mechanism, "steel", given=x), NO_MAPPING),
    ),
    "clashes": (
        (lambda m, x: jk.clashes(x), NO_MOTION),
        (lambda m, x: jk.clashes(m, within=x), (TEXT, -1.0, np.nan, [1, 2], OBJECT, IMAGINARY)),
        (lambda m, x: jk.clashes(m, tolerance=x), (TEXT, -1.0, np.nan, [1, 2], OBJECT, IMAGINARY)),
        (lambda m, x: jk.clashes(m, ignore=x), (NOTHING, *NO_LIST, [1], [(1, 2)])),
        (lambda m, x: jk.contact_validity(x), NO_MOTION),
        (lambda m, x: jk.curve_contacts(x), NO_MOTION),
    ),
    "geometry of motion": (
        (lambda m, x: jk.swept_volume(x, "crank"), NO_MOTION),
        (jk.swept_volume, NO_TEXT),
        (lambda m, x: jk.swept_volume(m, "crank", resolution=x), (TEXT, 0.0, -1.0, [1, 2], OBJECT, True, *NOT_FINITE)),
        (lambda m, x: jk.coupler_curve(x, "crank", Z), NO_MOTION),
        (lambda m, x: jk.coupler_curve(m, "crank", x), NO_NUMBER),
    ),
    "poses": (
        (lambda m, x: m.mechanism.at(m, x), (NOTHING, 5, TEXT, 1.0, OBJECT, True, [1, 2], slice(0, 2))),
        (lambda m, x: m.poses(x), (NOTHING, *NO_MAPPING)),
        (lambda m, x: m.poses({"crank": x}), (*NO_NUMBER, NUMBER, [1, 2], 2 * np.eye(4), np.full((4, 4), np.nan))),
        (lambda m, x: m.save("out", only=x), NO_LIST),
    ),
}
ALONE = {
    "loads": (
        (lambda x: jk.force(x, Z, Z), NO_TEXT),
        (lambda x: jk.force("crank", x, Z), NO_NUMBER),
        (lambda x: jk.force("crank", Z, x), NO_NUMBER),
        (lambda x: jk.force("crank", Z, Z, turns=x), NO_CHOICE),
        (lambda x: jk.torque("crank", x), NO_NUMBER),
        (lambda x: jk.spring("crank", Z, "rocker", Z, x), (*NO_NUMBER, *NOT_FINITE)),
        (lambda x: jk.spring("crank", Z, x, Z, 1.0), NO_TEXT),
        (lambda x: jk.joint_spring("ground-crank", x), (*NO_NUMBER, *NOT_FINITE)),
        (lambda x: jk.joint_load(x, 1.0), NO_TEXT),
        (lambda x: jk.joint_load("ground-crank", x), (*NO_NUMBER, *NOT_FINITE)),
        (lambda x: jk.joint_friction("ground-crank", x), (*NO_NUMBER, *NOT_FINITE, -1.0)),
    ),
    "motion law": (
        (jk.motion_law, (NOTHING, *NO_LIST, [1], [([], 1.0)])),
        (lambda x: jk.motion_law([("dwell", 1.0)], start=x), (*NO_NUMBER, *NOT_FINITE)),
    ),
    "joints": (
        (hinge, NO_TEXT),
        (lambda x: hinge("A", x), NO_TEXT),
        (lambda x: jk.revolute("A", "base", "arm", point=x, axis=Z), NO_NUMBER),
        (lambda x: jk.screw("A", "base", "arm", point=Z, axis=Z, pitch=x), (*NO_NUMBER, *NOT_FINITE)),
        (lambda x: jk.contact_joint("A", "base", "arm", state="b", frames=x), (NOTHING, *NO_LIST)),
        (lambda x: framed(places=x), NO_MAPPING),
        (lambda x: framed(kind=x), (*NO_TEXT, TEXT)),
        (lambda x: jk.gear("A", "B", x), (*NO_NUMBER, *NOT_FINITE, 0.0)),
        (lambda x: jk.gear(x, "B", 2.0), NO_TEXT),
        (lambda x: jk.relation({"A": 1.0, "B": 1.0}, offset=x), (*NO_NUMBER, *NOT_FINITE)),
        (lambda x: jk.relation({x: 1.0, "B": 1.0}), (NOTHING, NUMBER)),
        (jk.pose, NO_TEXT),
    ),
    "mechanisms": (
        (lambda x: jk.Mechanism.build(fixed=x, joints=[hinge()]), (NOTHING, *NO_NAMES)),
        (lambda x: jk.Mechanism.build(fixed=["base"], joints=x), (NOTHING, *NO_NAMES)),
        (lambda x: jk.Mechanism.build(fixed=["base"], joints=[hinge()], couplings=x), (NOTHING, *NO_LIST)),
        (lambda x: jk.Mechanism.build(fixed=["base"], joints=[hinge()], unit=x), NO_TEXT),
        (lambda x: jk.structure(["a", "b"], x, ["a"]), (NOTHING, *NO_LIST, [1], [("j", "a")])),
        (lambda x: jk.load(path("fourbar"), unit=x), (NUMBER, TEXT, [1, 2], {})),
    ),
}


def rows(table):
    return [
        pytest.param(*row, id=f"{name} {number}")
        for name, entries in table.items()
        for number, row in enumerate(entries)
    ]


@pytest.mark.parametrize(("call", "wrong"), rows(OF_MECHANISMS))
def test_what_is_asked_of_mechanisms(fourbar, call, wrong):
    for given in wrong:
        refused(lambda x: call(fourbar, x), given)


@pytest.mark.parametrize(("call", "wrong"), rows(OF_MOTIONS))
def test_what_is_asked_of_motions(motion, call, wrong):
    for given in wrong:
        refused(lambda x: call(motion, x), given)


@pytest.mark.parametrize(("call", "wrong"), rows(ALONE))
def test_what_is_made_of_numbers_and_names(call, wrong):
    for given in wrong:
        refused(call, given)


@pytest.mark.parametrize(
    ("option", "wrong"),
    [
        ("fixed", (NOTHING, *NO_NAMES)),
        ("exclude", (NOTHING, *NO_NAMES)),
        ("rigid", (NOTHING, *NO_NAMES)),
        ("ignore", (NOTHING, *NO_LIST, [1], [(1, 2)])),
        ("joints", (NOTHING, *NO_LIST, ["weld"])),
    ],
)
def test_words_of_an_assembly(assembly, option, wrong):
    for given in wrong:
        refused(lambda x: assembly.mechanism(**{"fixed": ["ground"], option: x}), given)


@pytest.mark.parametrize(
    ("tolerance", "wrong"), [("length", (0.0,)), ("angle", (NOTHING, 0.0)), ("fit", (NOTHING,))], ids=str
)
def test_tolerances_of_contacts(assembly, tolerance, wrong):
    for given in (*wrong, TEXT, OBJECT, IMAGINARY, -0.1, [1, 2], True, *NOT_FINITE):
        refused(lambda x: assembly.contacts(**{tolerance: x}), given)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"fixed": None}, "fixed must be a list of part names, got None"),
        ({"fixed": "ground"}, "fixed must be a list of part names, got the text 'ground'; write fixed=['ground']"),
        (
            {"fixed": ["ground"], "joints": ["weld"]},
            "joints must be a list of joints, such as [jk.revolute(...)], got 'weld' among them",
        ),
    ],
)
def test_what_to_write_is_said(assembly, options, said):
    with pytest.raises(ValueError) as error:
        assembly.mechanism(**options)
    assert said in str(error.value)


def test_a_drive(fourbar):
    with pytest.raises(ValueError, match=r"such as plan\(\['A'\]\), got None"):
        fourbar.plan(None)
