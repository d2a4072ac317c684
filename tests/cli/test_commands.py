"""The commands on the assemblies that come with the package, and on input that is wrong."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from jaxkin.cli.app import app
from jaxkin.examples import path
from jaxkin.io.writers import WRITERS
from reference.planar import fourbar
from tessellation import tessellated, write_stl

FOURBAR = str(path("fourbar"))
CRANK = ["--fixed", "ground", "--drive", "ground-crank=0:360:5"]


def invoke(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def run(*arguments, **environment):
    """The command line as a process of its own."""
    program = "from jaxkin.cli import main; main()"
    return subprocess.run(
        [sys.executable, "-c", program, *map(str, arguments)],
        env={name: value for name, value in os.environ.items() if name != "JAX_COMPILATION_CACHE_DIR"} | environment,
        capture_output=True,
        text=True,
        check=False,
    )


@pytest.mark.long
@pytest.mark.parametrize("arguments", [["--help"], ["sweep", "--help"], ["sweep", "--bogus"], ["sweep"]])
def test_help_and_errors_of_arguments_come_without_jax(arguments):
    """JAX, and what else the computing needs, takes seconds to import."""
    program = "import sys; from jaxkin.cli import main\ntry:\n main()\nfinally:\n sys.exit('jax' in sys.modules)"
    done = subprocess.run([sys.executable, "-c", program, *arguments], capture_output=True, text=True, check=False)
    assert done.returncode == 0 and ("Usage" in done.stdout + done.stderr), done.stderr


@pytest.mark.long
def test_demo_writes_all_files_and_keeps_compiled_programs(tmp_path):
    # with few optimisations programs take less than the 0.1 s from which on they are kept
    kept = {"XDG_CACHE_HOME": str(tmp_path / "cache"), "JAX_PERSISTENT_CACHE_MIN_COMPILE_TIME_SECS": "0"}
    done = run("demo", "--out", tmp_path / "out", **kept)
    assert done.returncode == 0, done.stderr
    assert {file.name for file in (tmp_path / "out").iterdir()} == set(WRITERS)
    assert "361  CLOSED" in done.stdout
    assert any((tmp_path / "cache" / "jaxkin").iterdir())
    with np.load(tmp_path / "out" / "motion.npz") as arrays:
        assert arrays["residual"].dtype == np.float64
        assert arrays["residual"].max() < 1e-12


@pytest.mark.long
def test_sweep_takes_degrees_and_says_what_cannot_be_reached(tmp_path):
    """The rocker of a crank-rocker swings between two dead points, where crank and coupler are in line."""
    done = invoke("sweep", FOURBAR, "--fixed", "ground", "--drive", "ground-rocker=-180:180:91", "--out", tmp_path)
    assert done.exit_code == 0, done.output
    assert "UNREACHABLE" in done.output and "JUMPED" in done.output  # the mirrored circuit lies in the range too
    with np.load(tmp_path / "motion.npz") as arrays:
        rocker, crank = arrays["input:ground-rocker.phi"], arrays["joint:ground-crank"][:, 0]
        closed = arrays["status_names"][arrays["status"]] == "CLOSED"
    np.testing.assert_allclose(rocker, np.radians(np.linspace(-180, 180, 91)))
    dead_points = np.arccos([(100**2 + 80**2 - length**2) / (2 * 100 * 80) for length in (120 - 40, 120 + 40)])
    assert closed.sum() == pytest.approx(np.degrees(np.ptp(dead_points)) / 4, abs=1)
    # both axes point the same way along the pins, but that may be either way
    home = fourbar(np.array([np.pi / 3])).rocker
    errors = [sign * (fourbar(np.pi / 3 + sign * crank[closed]).rocker - home) - rocker[closed] for sign in (1, -1)]
    # placements are read through float32
    assert min(np.abs(error).max() for error in errors) < 5e-7


@pytest.mark.long
def test_a_long_range_is_written_as_arrays(tmp_path, monkeypatch):
    monkeypatch.setattr("jaxkin.cli.run.LONG", 4)
    done = invoke("sweep", FOURBAR, *CRANK, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    assert "5  CLOSED" in done.output and "arrays only" in done.output
    assert [file.name for file in (tmp_path / "out").iterdir()] == ["motion.npz"]


@pytest.mark.long
def test_inspect_says_what_was_found():
    done = invoke("inspect", FOURBAR, "--fixed", "ground")
    assert done.exit_code == 0, done.output
    assert "Assembly of 4 parts from fourbar.step, lengths in mm" in done.output
    assert "8 contacts" in done.output
    for joint in ("ground-crank", "crank-coupler", "coupler-rocker", "ground-rocker"):
        assert joint in done.output
    assert "revolute" in done.output
    assert "Loops: 1" in done.output
    assert "Mobility: 1 freedom" in done.output


@pytest.mark.long
def test_several_files_are_one_part_each(tmp_path):
    files = []
    for part in tessellated(path("cam"), 0.35):
        files.append(write_stl(tmp_path / f"{part.name}.stl", part.triangles))
    done = invoke("inspect", *files, "--fixed", "frame", "--unit", "mm")
    assert done.exit_code == 0, done.output
    assert "Assembly of 3 parts from cam.stl, follower.stl, frame.stl, lengths in mm" in done.output
    assert "cam-follower" in done.output and "Mobility: 1 freedom" in done.output
    (tmp_path / "other").mkdir()
    (tmp_path / "study.toml").touch()
    for wrong, said in (
        ([files[0], files[0].rename(tmp_path / "other" / "cam.stl")], "two parts would be called 'cam'; rename a file"),
        ([files[1], tmp_path / "study.toml"], "study.toml is a study, which names its geometry itself: give it alone"),
        ([tmp_path / "study.toml", "--unit", "mm"], 'write unit = "mm" in study.toml'),
    ):
        done = invoke("inspect", *wrong)
        assert (done.exit_code, said in done.output) == (2, True), done.output


@pytest.mark.long
def test_inspect_without_combining_keeps_every_contact():
    combined = invoke("inspect", FOURBAR, "--fixed", "ground")
    separate = invoke("inspect", FOURBAR, "--fixed", "ground", "--no-combine")
    assert separate.exit_code == 0, separate.output
    assert "revolute" not in separate.output
    assert len(separate.output.splitlines()) > len(combined.output.splitlines())


STUDY = """
geometry = "fourbar.step"
fixed = ["base"]

[rename]
ground = "base"

[drive]
base-crank = "0:360:5"
"""


@pytest.mark.long
@pytest.mark.usefixtures("without_pictures")
def test_a_study_is_swept_and_inspected_like_the_options_that_it_stands_for(tmp_path):
    (tmp_path / "fourbar.step").write_bytes(path("fourbar").read_bytes())
    study = tmp_path / "study.toml"
    study.write_text(STUDY)
    for arguments, folder in (([study], "study"), ([FOURBAR, *CRANK], "options")):
        done = invoke("sweep", *arguments, "--out", tmp_path / folder)
        assert done.exit_code == 0, done.output
    tables = [(tmp_path / folder / "motion.csv").read_text() for folder in ("study", "options")]
    assert tables[0].replace("base", "ground") == tables[1]

    study.write_text(STUDY.replace("base-crank", "base-cranc"))
    done = invoke("sweep", study, "--out", tmp_path / "none")
    assert done.exit_code == 2
    assert "did you mean 'base-crank'?" in done.stderr
    done = invoke("inspect", study, "--rigid", "crank,coupler", "--ignore", "coupler - rocker")
    assert done.exit_code == 0, done.output
    assert ["crank-coupler", "crank", "-", "coupler", "fixed", "none"] in map(str.split, done.output.splitlines())
    assert "2 contacts ignored" in done.output


def test_inspect_tells_everything_once(tmp_path):
    """A misfit, and a torus, are told where they are found."""
    file = tmp_path / "fillet.toml"
    fillet = Path(__file__).parents[1] / "io" / "data" / "fillet.step"
    file.write_text(f"geometry = {fillet.as_posix()!r}\nfixed = ['shaft']\n")
    done = invoke("inspect", file)
    assert done.exit_code == 0, done.output
    assert done.output.count("torus") == 1


@pytest.mark.long
def test_inspect_draws_what_it_found(tmp_path):
    done = invoke("inspect", FOURBAR, "--fixed", "ground", "--png", tmp_path / "found.png")
    assert done.exit_code == 0, done.output
    assert f"Written: {tmp_path / 'found.png'}." in done.output.replace("\n", "")
    assert (tmp_path / "found.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.long
@pytest.mark.usefixtures("without_pictures")
def test_inspect_writes_a_page_and_a_study_that_sweeps(tmp_path):
    page, study = tmp_path / "report.html", tmp_path / "study.toml"
    done = invoke("inspect", FOURBAR, "--page", page, "--study", study)
    assert done.exit_code == 0, done.output
    text = page.read_text("utf-8")
    assert "To move it, give a range for this: ground-crank.phi" in text and "The best of 3 choices" in text
    done = invoke("sweep", study, "--out", tmp_path / "motion")
    assert done.exit_code == 0 and "21  CLOSED" in done.output, done.output


@pytest.mark.long
def test_inspect_writes_the_page_of_what_is_refused_too(tmp_path):
    """The four-bar with its rocker placed a metre away, where nothing may be inferred."""
    text = Path(FOURBAR).read_text().replace("(106.25950699647,", "(1106.25950699647,")
    (tmp_path / "apart.step").write_text(text)
    page = tmp_path / "report.html"
    done = invoke("inspect", tmp_path / "apart.step", "--fixed", "ground", "--exact-only", "--page", page)
    assert done.exit_code == 2 and "'rocker' touches no other part" in done.stderr
    assert "report.html. Open it in a browser." in done.stdout
    assert "There is no mechanism yet. apart.step: 'rocker' touches no other part" in page.read_text("utf-8")


@pytest.mark.long
def test_loops_prints_and_draws_the_structure(tmp_path):
    done = invoke("loops", FOURBAR, "--fixed", "ground", "--png", tmp_path / "loops.png")
    assert done.exit_code == 0, done.output
    assert "4 parts, 4 joints; independent loops: 4 - 4 + 1 = 1\n" in done.output
    assert "single loop of ground, crank, coupler, rocker (fixed)" in done.output
    assert "planar (3)" in done.output and "Mobility: 1 freedom" in done.output
    assert [file.name for file in tmp_path.iterdir()] == ["loops.png"]
    assert invoke("loops", FOURBAR).exit_code == 2
    assert "Plan of a drive of ground-crank.phi\n  1. 1 planar dyad RRR over" in invoke("loops", FOURBAR, *CRANK).output


FILES = {
    "empty.step": lambda text: "",
    "text.step": lambda text: "Dear reader,\nthis is no STEP file.\n",
    "hollow.step": lambda text: text[: text.index("DATA;")] + "DATA;\nENDSEC;\nEND-ISO-10303-21;\n",
}


@pytest.mark.long
@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["missing.step", *CRANK], ["missing.step"]),
        (["empty.step", *CRANK], ["empty.step"]),
        (["text.step", *CRANK], ["text.step"]),
        (["hollow.step", *CRANK], ["hollow.step"]),
        ([FOURBAR, "--drive", "ground-crank=0:360:5"], ["--fixed PART", "ground, crank, coupler, rocker"]),
        ([FOURBAR, "--fixed", "grund", "--drive", "ground-crank=0:360:5"], ["'grund'", "'ground'"]),
        ([FOURBAR, "--fixed", "ground"], ["--drive", "ground-crank.phi"]),
        ([FOURBAR, "--fixed", "ground", "--drive", "ground-cranc=0:360:5"], ["'ground-cranc'", "'ground-crank'"]),
        ([FOURBAR, "--fixed", "ground", "--drive", "ground-crank.z=0:1:5"], ["'ground-crank'", "'z'", "phi"]),
        ([FOURBAR, *CRANK, "--drive", "ground-rocker=0:1:6"], ["equal length", "5", "6"]),
        ([FOURBAR, "--fixed", "ground", "--drive", "ground-crank=0,nan,1"], ["ground-crank", "nan"]),
        ([FOURBAR, "--fixed", "ground", "--drive", "ground-crank=0-360"], ["ground-crank=0-360", "START:STOP:COUNT"]),
        ([FOURBAR, "--fixed", "ground", "--drive", "ground-crank=0:360:1"], ["both ends of '0:360:1'; write 0, or"]),
    ],
)
def test_wrong_input_is_one_message_and_leaves_nothing(arguments, said, tmp_path, monkeypatch):
    for name, make in FILES.items():
        (tmp_path / name).write_text(make(path("fourbar").read_text()))
    monkeypatch.chdir(tmp_path)
    done = invoke("sweep", *arguments, "--out", "out")
    assert done.exit_code == 2, done.output
    assert done.stdout == ""
    assert done.stderr.startswith("jaxkin: ")
    assert "Traceback" not in done.stderr
    for words in said:
        assert words in done.stderr
    assert {file.name for file in tmp_path.iterdir()} == set(FILES)


@pytest.mark.long
def test_a_part_that_is_tied_to_nothing_is_left_at_rest_and_named(tmp_path):
    """The four-bar with its rocker placed a metre away: the crank still turns, with the coupler in tow."""
    text = Path(FOURBAR).read_text().replace("(106.25950699647,", "(1106.25950699647,")
    (tmp_path / "apart.step").write_text(text)
    done = invoke("sweep", tmp_path / "apart.step", *CRANK, "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    assert "'rocker' is tied to nothing: left at rest" in " ".join(done.output.split())


def test_a_file_in_place_of_the_folder_is_refused_before_the_sweep(tmp_path):
    (tmp_path / "out").write_text("in the way")
    done = invoke("sweep", FOURBAR, *CRANK, "--out", tmp_path / "out")
    assert done.exit_code == 2
    assert "--out" in done.stderr
    assert (tmp_path / "out").read_text() == "in the way"


@pytest.mark.long
def test_a_process_ends_with_code_2_and_no_traceback(tmp_path):
    done = run("inspect", tmp_path / "missing.step", "--fixed", "ground")
    assert done.returncode == 2
    assert done.stdout == ""
    assert "missing.step" in done.stderr
    assert "Traceback" not in done.stderr


@pytest.mark.long
@pytest.mark.study
def test_accuracy_prints_and_draws_what_it_costs(tmp_path):
    picture = tmp_path / "cost.png"
    done = invoke("accuracy", FOURBAR, "--fixed", "ground", "--drive", "ground-crank=0:90:13", "--png", picture)
    assert done.exit_code == 0, done.output
    assert "dfp-autodiff" in done.output and "An error of" in done.output
    assert picture.read_bytes().startswith(b"\x89PNG")


@pytest.mark.long
def test_accuracy_needs_a_drive():
    done = invoke("accuracy", FOURBAR, "--fixed", "ground")
    assert done.exit_code == 2 and "nothing is driven" in done.stderr
