"""Mistakes of the user are one line and exit code 2; ours keep their traceback."""

import numpy as np
import pytest
import typer

from jaxkin.cli.errors import one_line_errors
from jaxkin.examples import path
from jaxkin.geometry.pose import unit


def test_what_the_library_refuses_is_one_line(capsys):
    with pytest.raises(typer.Exit) as stop, one_line_errors():
        unit(np.zeros(3))
    assert stop.value.exit_code == 2
    assert capsys.readouterr().err.startswith("jaxkin: a direction must be a finite vector")


def test_key_errors_are_not_quoted(capsys):
    with pytest.raises(typer.Exit), one_line_errors():
        path("fourbars")
    assert capsys.readouterr().err.startswith("jaxkin: no example is named 'fourbars'")


def test_files_are_named(capsys, tmp_path):
    with pytest.raises(typer.Exit), one_line_errors():
        (tmp_path / "none.step").read_bytes()
    assert "none.step" in capsys.readouterr().err


def test_defects_keep_their_traceback():
    with pytest.raises(ValueError, match="broadcast"), one_line_errors():
        np.zeros(2) + np.zeros(3)


def test_a_defect_in_a_writer_keeps_its_traceback():
    with pytest.raises(OSError, match=r"motion\.png"), one_line_errors():
        try:
            np.zeros(2) + np.zeros(3)
        except ValueError as error:
            raise OSError("could not write motion.png") from error
