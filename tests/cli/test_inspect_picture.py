"""The picture of an inspection has what the text beside it goes on with."""

import pytest
from typer.testing import CliRunner

from jaxkin.cli.app import app
from jaxkin.examples import path

LOOSE = ["--exact-only", "--fixed", "crank", "--exclude", "ground", "--exclude", "coupler"]


@pytest.mark.long
@pytest.mark.parametrize(("options", "there"), [([], True), (LOOSE, False)])
def test_the_picture_has_the_joints_of_what_is_proposed(options, there, tmp_path, monkeypatch):
    """Without --fixed the text went on with the best proposal, and the picture knew of contacts only; what is refused
    is drawn without joints."""
    drawn = []
    monkeypatch.setattr("jaxkin.view.inspection.draw_inspection", lambda *given, **named: drawn.append(named))
    done = CliRunner().invoke(app, ["inspect", str(path("fourbar")), *options, "--png", str(tmp_path / "found.png")])
    assert (done.exit_code == 0) == there
    (named,) = drawn
    assert (named["mechanism"] is not None) == there
