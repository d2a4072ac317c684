"""What cannot be written is refused before any work: the files to read are not even looked for."""

import pytest
from typer.testing import CliRunner

from jaxkin.cli.app import app


def invoke(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


@pytest.mark.parametrize("command", ["inspect", "loops", "accuracy"])
@pytest.mark.parametrize(
    ("picture", "said"),
    [("found.svg", "name a file that ends in .png, got found.svg"), ("none/found.png", "there is no folder none")],
)
def test_a_picture_that_cannot_be_written_is_refused_before_all_work(command, picture, said, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    done = invoke(command, "missing.step", "--png", picture)
    assert done.exit_code == 2 and "'--png'" in done.stderr
    assert said in " ".join(done.stderr.replace("│", " ").split())  # in a box, some words a line
    assert "missing.step" not in done.stderr


@pytest.mark.parametrize(("option", "suffix"), [("--page", ".html"), ("--study", ".toml")])
def test_a_report_that_cannot_be_written_is_refused_before_all_work(option, suffix, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name, said in (("found.txt", f"ends in {suffix}, got found.txt"), (f"none/found{suffix}", "no folder none")):
        done = invoke("inspect", "missing.step", option, name)
        assert done.exit_code == 2 and f"'{option}'" in done.stderr
        assert said in " ".join(done.stderr.replace("│", " ").split())
