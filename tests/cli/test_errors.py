"""Mistakes of the user are one line and exit code 2; ours keep their traceback."""

import warnings

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


def test_warnings_are_one_line_without_source(capsys):
    before = warnings.showwarning
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        with one_line_errors():
            warnings.warn("a.step does not say its length unit: taken for mm", stacklevel=1)
    assert capsys.readouterr().err == "jaxkin: warning: a.step does not say its length unit: taken for mm\n"
    assert warnings.showwarning is before


def test_warnings_that_are_not_for_users_tell_where_they_come_from(capsys):
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        with one_line_errors():
            _ = np.float64(1) / np.float64(0)
    (line,) = capsys.readouterr().err.splitlines()
    assert line.startswith("jaxkin: warning: divide by zero") and f"RuntimeWarning at {__file__}:" in line
