"""The file of loops beside a URDF: read where it is named, on the command line and in a study, and told otherwise."""

import numpy as np
import pytest
from typer.testing import CliRunner

import jaxkin as jk
from jaxkin.cli.app import app
from reference import mechanisms


def invoke(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.fixture
def urdf(tmp_path):
    """A four-bar as a tree of four hinges: one freedom with its loop, four without."""
    return jk.write_urdf(mechanisms.planar_fourbar(), tmp_path / "four bar.urdf")


def test_loops_beside_a_robot_that_nobody_named_are_told(urdf):
    """What the note says to write closes the loop, on the command line and in Python."""
    done = invoke("inspect", urdf)
    assert done.exit_code == 0 and "Loops: 0" in done.output and "4 freedoms" in done.output
    (note,) = [note for note in jk.load(urdf).mechanism().notes if "file of loops" in note]
    assert note in done.output
    assert f"--loops '{urdf.with_suffix('.yaml')}'" in note and f"loops={str(urdf.with_suffix('.yaml'))!r}" in note
    done = invoke("inspect", urdf, "--loops", urdf.with_suffix(".yaml"))
    assert done.exit_code == 0 and "Loops: 1" in done.output and "1 freedom," in done.output
    assert "file of loops" not in done.output
    assert "file of loops" not in str(jk.load(urdf, loops=urdf.with_suffix(".yaml")).mechanism())


def test_a_yaml_of_something_else_is_not_told(urdf):
    urdf.with_suffix(".yaml").write_text("controller_manager:\n  ros__parameters: {update_rate: 100}\n")
    assert not any("file of loops" in note for note in jk.load(urdf).mechanism().notes)
    urdf.with_suffix(".yaml").write_text("no yaml of ours\n")
    assert not any("file of loops" in note for note in jk.load(urdf).mechanism().notes)


def test_a_study_names_its_loops_from_where_it_stands(urdf, tmp_path):
    """The study that is written closes the loop again: solids and joints are where they were."""
    (tmp_path / "studies").mkdir()
    target = tmp_path / "studies" / "robot.toml"
    done = invoke("inspect", urdf, "--loops", urdf.with_suffix(".yaml"), "--study", target)
    assert done.exit_code == 0, done.output
    assert 'loops = "../four bar.yaml"' in target.read_text()
    again, first = jk.load_study(target), jk.load(urdf, loops=urdf.with_suffix(".yaml"))
    assert again.assembly is not None
    assert again.mechanism.mobility().freedoms == 1
    for one, other in zip(again.assembly.parts, first.parts, strict=True):
        np.testing.assert_array_equal(one.triangles, other.triangles)
    target.write_text('geometry = "../four bar.urdf"\nloops = "../four bar.yaml"\nfixed = ["ground"]\n')
    assert len(jk.load_study(target).mechanism.structure.loops) == 1


def test_loops_without_a_urdf_are_refused(urdf, tmp_path):
    study = tmp_path / "study.toml"
    study.write_text('geometry = "four bar.urdf"\nfixed = ["ground"]\n')
    done = invoke("inspect", study, "--loops", urdf.with_suffix(".yaml"))
    assert done.exit_code == 2 and "write the key loops beside geometry in study.toml" in done.stderr
    study.write_text('loops = "four bar.yaml"\nfixed = ["a"]\n[joints.A]\nkind = "fixed"\nparts = ["a", "b"]\n')
    done = invoke("inspect", study)
    assert done.exit_code == 2 and "loops is about parts from files, but no geometry is given" in done.stderr
    with pytest.raises(ValueError, match="loops of a robot in URDF; got a file for each of 2 parts"):
        jk.load({"a": "a.stl", "b": "b.stl"}, loops="robot.yaml")
