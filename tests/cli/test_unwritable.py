"""What cannot be written is refused before any work: the files to read are not even looked for."""

import errno
import os
from pathlib import Path

import pytest
from typer.testing import CliRunner

import jaxkin as jk
from jaxkin import _files
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


def test_a_folder_in_which_nothing_can_be_written_is_named_with_the_file(tmp_path, monkeypatch):
    def refused(**_):
        raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(tmp_path / ".draft"))

    monkeypatch.setattr(_files, "TemporaryDirectory", refused)
    said = r"cannot write .*found\.html: read-only file system; name a folder"
    with pytest.raises(OSError, match=said) as error, _files.whole(tmp_path / "found.html"):
        pass
    assert ".draft" not in str(error.value)


def test_a_folder_that_cannot_be_made_is_named_with_the_reason(tmp_path, monkeypatch):
    def refused(path, **_):
        raise OSError(errno.EROFS, os.strerror(errno.EROFS), str(path))

    monkeypatch.setattr(Path, "mkdir", refused)
    said = r"^cannot save into '.*out': it cannot be made, read-only file system; name a folder that can be written in$"
    with pytest.raises(OSError, match=said):
        _files.make_folder(tmp_path / "out")


def test_a_file_in_a_folder_that_is_not_there_is_refused_once(tmp_path):
    """In the words of the file, with nothing before them."""
    joints = [jk.revolute("A", "ground", "arm", point=(0, 0, 0), axis=(0, 0, 1))]
    motion = jk.Mechanism.build(fixed=["ground"], joints=joints).sweep({"A": [0.0, 0.1]})
    with pytest.raises(FileNotFoundError, match=r"^cannot write .*m\.csv: there is no folder .*none; make it"):
        motion.save(tmp_path / "none" / "m.csv")
