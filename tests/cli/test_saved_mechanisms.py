"""The commands on mechanisms that `Mechanism.save` wrote."""

from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import jaxkin as jk
from jaxkin.cli.app import app
from jaxkin.examples import path

FOURBAR = str(path("fourbar"))
FIXED, DRIVE = ["--fixed", "ground"], ["--drive", "ground-crank=0:360:5"]


def invoke(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def saved_motion(folder: Path) -> dict[str, np.ndarray]:
    with np.load(folder / "motion.npz") as file:
        return dict(file)


@pytest.mark.long
@pytest.mark.usefixtures("without_pictures")
def test_a_saved_mechanism_is_inspected_swept_and_written_as_a_study(tmp_path):
    saved, study = tmp_path / "linkage.json", tmp_path / "study.toml"
    jk.load(FOURBAR).mechanism(fixed=["ground"]).save(saved)
    done = invoke("inspect", saved, "--study", study)
    assert done.exit_code == 0 and "Mobility: 1 freedom" in done.output, done.output
    study.write_text(study.read_text() + '\n[drive]\nground-crank = "0:360:5"\n')
    for file, drive in ((saved, DRIVE), (study, []), (FOURBAR, [*FIXED, *DRIVE])):
        done = invoke("sweep", file, *drive, "--out", tmp_path / Path(file).stem)
        assert done.exit_code == 0 and "5  CLOSED" in done.output, done.output
    one, *others = (saved_motion(tmp_path / name) for name in ("fourbar", "linkage", "study"))
    for other in others:
        for name in ("ground-rocker", "coupler-rocker"):
            np.testing.assert_allclose(other[f"joint:{name}"], one[f"joint:{name}"], atol=1e-12)
    refused = invoke("sweep", saved, *FIXED, *DRIVE, "--out", tmp_path / "motion")
    assert refused.exit_code == 2 and "linkage.json holds a whole mechanism" in refused.stderr
