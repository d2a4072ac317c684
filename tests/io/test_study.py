"""One file for a whole study: what it gives, and what is said about mistakes in it."""

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples import path
from jaxkin.io.study import Study, load_study

FOURBAR = path("fourbar").as_posix()
SAME = f"""
geometry = "{FOURBAR}"
unit = "mm"
fixed = ["base"]

[rename]
ground = "base"

[drive]
base-crank = "0:90:4"
"""


def written(tmp_path, text):
    file = tmp_path / "study.toml"
    file.write_text(text)
    return file


@pytest.mark.long
def test_a_study_is_the_same_as_the_calls_it_stands_for(tmp_path):
    study = load_study(written(tmp_path, SAME))
    mechanism = jk.load(path("fourbar")).mechanism(fixed=["ground"])
    assert study.mechanism.parts == ("base", "crank", "coupler", "rocker")
    assert study.mechanism.fixed == ("base",)
    motion = study.sweep()
    other = mechanism.sweep({"ground-crank": np.deg2rad([0.0, 30.0, 60.0, 90.0])})
    np.testing.assert_array_equal(motion.coordinates["coupler-rocker"], other.coordinates["coupler-rocker"])


@pytest.mark.long
def test_everything_that_a_study_may_say(tmp_path):
    file = path("fourbar")
    (tmp_path / "parts").mkdir()
    (tmp_path / "parts" / "bar.step").write_bytes(file.read_bytes())
    text = """
geometry = "parts/bar.step"
fixed = ["ground"]
rigid = [["coupler", "rocker"]]
ignore = [["crank", "coupler"]]
combine = false
tolerance = { length = 0.01, angle = 1e-3, fit = 0.05 }

[joints.slide]
kind = "prismatic"
parts = ["crank", "coupler"]
axis = [0, 0, 1]

[drive]
"ground-crank:e.phi" = { from = 0, to = 0.25, poses = 3, unit = "turn" }
"ground-crank:e.z" = [0, 1, 2]
"""
    study = load_study(written(tmp_path, text))
    mechanism = study.mechanism
    assert study.contacts is study.assembly.contacts(length=0.01, angle=1e-3, fit=0.05)
    assert mechanism.joints["coupler-rocker"].kind == "fixed"
    assert mechanism.joints_between("crank", "coupler") == ("slide",)
    assert mechanism.joints_between("ground", "crank") == ("ground-crank:a", "ground-crank:e")
    assert list(study.drive) == ["ground-crank:e.phi", "ground-crank:e.z"]
    np.testing.assert_allclose(study.drive["ground-crank:e.phi"], [0, np.pi / 4, np.pi / 2])
    np.testing.assert_array_equal(study.drive["ground-crank:e.z"], [0, 1, 2])


@pytest.mark.long
@pytest.mark.parametrize("align, misfit", [("", True), ("align = 1e-3", False)])
def test_how_much_is_taken_for_rounding(tmp_path, align, misfit):
    """A parallelogram of which one axis is tilted by 5e-4."""
    pins = {"A": (0, 0, "ground", "left"), "B": (0, 2, "left", "top"), "C": (3, 2, "top", "right")}
    text = f'fixed = ["ground"]\n{align}\n'
    for name, (x, y, one, other) in (pins | {"D": (3, 0, "ground", "right")}).items():
        axis = "[5e-4, 0, 1]" if name == "C" else "[0, 0, 1]"
        text += f'[joints.{name}]\nkind = "revolute"\nparts = ["{one}", "{other}"]\n'
        text += f"point = [{x}, {y}, 0]\naxis = {axis}\n"
    mechanism = load_study(written(tmp_path, text)).mechanism
    assert bool(mechanism.linkage.ideal) == misfit and len(mechanism.notes) == 1


def test_a_study_without_geometry(tmp_path):
    text = """
unit = "m"
fixed = ["ground"]

[joints.A]
kind = "revolute"
parts = ["ground", "arm"]
point = [0, 0, 0]
axis = [0, 0, 1]

[joints.B]
kind = "contact"
parts = ["arm", "tool"]
state = "e"
frames = [[[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]]

[drive]
A = [0, 90]
"B.z" = { values = [0, 5], unit = "cm" }
"B.phi" = [0, -90]
"""
    study = load_study(written(tmp_path, text))
    assert study.assembly is None and len(study.contacts) == 0
    motion = study.sweep()
    assert study.mechanism.unit == "m"
    np.testing.assert_allclose(motion.points("tool", (2.0, 1.0, 0.0))[1], [0.0, 3.0, 0.05], atol=1e-12)


HEAD = f'geometry = "{FOURBAR}"\nfixed = ["ground"]\n'
HINGE = '[joints.A]\nkind = "revolute"\nparts = ["ground", "crank"]\n'


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("", "study.toml: fixed is missing"),
        ('fixed = ["ground"]', "the file: there is nothing to study: expected geometry, or joints, or both"),
        ("fixed = [", "study.toml cannot be read as TOML: Invalid value (at end of document)"),
        ("x = " + "[" * 100_000, "study.toml cannot be read as TOML: it is nested too deeply"),
        ("#" * 1_000_001, "study.toml has 1000001 bytes: a study has 1000000 at most"),
        (HEAD + "fixd = 3", "there is no key 'fixd'; did you mean 'fixed'?"),
        (HEAD + "drive.A = {from = 0, to = 1, count = 5}", "there is no key 'drive.A.count'; did you mean 'poses'?"),
        (f'geometry = "{FOURBAR}"\nfixed = "ground"', "fixed: expected a list in brackets, got 'ground'"),
        (f'geometry = "{FOURBAR}"\nfixed = [3]', "fixed[0]: expected a text in quotes, got 3"),
        (f'geometry = "{FOURBAR}"\nfixed = []', "fixed: expected a list of at least 1, got []"),
        ('geometry = 3\nfixed = ["a"]', "geometry: expected the name of a file, or a table of files by part, got 3"),
        (HEAD + "align = 1", "align: expected a number not greater than 0.001, got 1"),
        (HEAD + "align = -1e-6", "align: expected a number not less than 0.0, got -1e-06"),
        (HEAD + 'combine = "no"', "combine: expected true or false, got 'no'"),
        (HEAD + 'unit = "inch"', "unit: expected one of 'um', 'mm', 'cm', 'dm', 'm', 'km', 'in', 'ft', got 'inch'"),
        (HEAD + 'unit = "cm"', "unit is 'cm', but fourbar.step is in 'mm'; write all lengths of study.toml in mm"),
        (HEAD + "rigid = [[]]", "rigid[0]: expected a list of at least 1, got []"),
        (HEAD + 'ignore = [["a", "b", "c"]]', "ignore[0]: expected a list of 2, got ['a', 'b', 'c']"),
        (HEAD + "tolerance.length = -1", "tolerance.length: expected a number greater than 0.0, got -1"),
        (HEAD + "tolerance.lenght = 1", "there is no key 'tolerance.lenght'; did you mean 'length'?"),
        (HEAD + '[rename]\nfixed = ["x"]', "if fixed is meant for the whole file, write it above the first [table]"),
        (
            HEAD + '[rename]\ngrund = "base"',
            "rename: fourbar.step has no part 'grund' to rename; did you mean 'ground'?",
        ),
        (HEAD + '[rename]\ncrank = "rocker"', "rename: two parts would be called 'rocker'"),
        (HEAD + HINGE + "point = [0, 0]", "joints.A.point: expected a list of 3, got [0, 0]"),
        (HEAD + HINGE + "point = [0, 0, inf]", "joints.A.point[2]: expected a finite number, got inf"),
        (HEAD + HINGE + "point = [0, 0, 0]", "joints.A: a joint of kind 'revolute' needs axis"),
        (HEAD + HINGE + "point = [0, 0, 0]\naxis = [0, 0, 0]", "'A': axis must be a direction, got the zero vector"),
        (HEAD + HINGE + "axes = [0, 0, 0]", "there is no key 'joints.A.axes'; did you mean 'axis'?"),
        (HEAD + HINGE + '[drive]\nA.phi = "0:9:4"', "'unit'; a name with a dot stands in quotes: 'A.phi'"),
        (HEAD + '[joints.A.1]\nkind = "revolute"', "; a name with a dot stands in quotes: 'A.1'"),
        (
            HEAD + HINGE + "point = [0, 0, 0]\naxis = [0, 0, 1]\npitch = 1",
            "joints.A: a joint of kind 'revolute' has no pitch; it takes point, axis",
        ),
        (HEAD + HINGE.replace("lute", "lut"), "joints.A.kind: expected one of 'revolute'"),
        (HEAD + HINGE.replace("lute", "lut"), "got 'revolut'; did you mean 'revolute'?"),
        (
            HEAD + HINGE + "point = [0, 0, 0]\naxis = [0, 0, 1]\nlimits = [10, -10]",
            "the limits of phi must be two numbers, the lower one first, in degrees or a length, got [10, -10]",
        ),
        (HEAD + "[drive]\na = []", "drive.a.values: expected a list of at least 1, got []"),
        (HEAD + "[drive]\na = 3", "drive.a: expected a text START:STOP:COUNT"),
        (HEAD + '[drive]\na = "0:360"', "drive.a: cannot read '0:360' as a range"),
        (HEAD + '[drive]\na = "0:1:9999999999"', "drive.a: COUNT must be a number from 1 to 10000000"),
        (HEAD + "[drive]\na = { from = 0, to = 1 }", "drive.a: expected either values, or from, to and poses"),
        (
            HEAD + "[drive]\na = { from = 0, to = 90, poses = 1 }",
            "drive.a: one pose cannot be both from = 0 and to = 90",
        ),
        (
            HEAD + '[drive]\na = { values = [0], unit = "degrees" }',
            "drive.a.unit: expected one of 'deg', 'rad', 'turn'",
        ),
        (
            'fixed = ["ground"]\nrename = {}\n' + HINGE + "axis = [0, 0, 1]\npoint = [0, 0, 0]",
            "rename is about parts from",
        ),
        (
            HEAD + "contacts = false\ntolerance = { length = 0.1 }",
            "tolerance is about contacts, which contacts = false does not look for",
        ),
        ('geometry = "missing.step"\nfixed = ["a"]', "missing.step does not exist"),
    ],
)
def test_mistakes_are_told_with_file_key_and_what_was_expected(tmp_path, text, said):
    with pytest.raises((ValueError, FileNotFoundError)) as error:
        load_study(written(tmp_path, text))
    assert said in str(error.value)
    assert "study.toml" in str(error.value) or "missing.step" in str(error.value)


def test_a_study_may_begin_with_the_mark_of_an_editor(tmp_path):
    study = written(tmp_path, HEAD)
    study.write_bytes(b"\xef\xbb\xbf" + study.read_bytes())
    assert load_study(study).fixed == ["ground"]


def test_all_mistakes_are_told_at_once(tmp_path):
    with pytest.raises(ValueError) as error:
        load_study(written(tmp_path, "geometry = 3\ncombine = 3\n"))
    assert len(str(error.value).splitlines()) == 3


@pytest.mark.long
def test_what_can_only_be_checked_with_the_mechanism(tmp_path):
    study = load_study(written(tmp_path, HEAD + "[drive]\ncrank = [0]"))
    with pytest.raises(ValueError, match="there is no joint 'crank'"):
        _ = study.drive
    with pytest.raises(ValueError, match=r"nothing is driven: .*; ground-crank\.phi would be enough; there are"):
        _ = Study("here", study.assembly, fixed=["ground"]).drive
    with pytest.raises(FileNotFoundError, match="study"):
        load_study(tmp_path / "none.toml")
    with pytest.raises(ValueError, match="is a folder"):
        load_study(tmp_path)
