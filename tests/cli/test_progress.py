"""The bar of a command: whole steps, and how far the present one has come."""

import io
from pathlib import Path

import numpy as np
import pytest
from rich.console import Console
from rich.progress import Progress
from typer.testing import CliRunner

from jaxkin.cli import run
from jaxkin.cli.app import app
from jaxkin.cli.progress import CommandSteps, progress
from jaxkin.cli.threads import one_thread
from jaxkin.examples import path


def test_the_bar_moves_within_a_step():
    with Progress(console=Console(file=io.StringIO(), force_terminal=True)) as bar:
        step = CommandSteps(bar, 2)
        (task,) = bar.tasks
        seen = []
        for text in ("reading", "finding contacts"):
            step(text)
            assert task.description == text
            seen.append(task.completed)
            for done in (1, 2, 4):
                step.within(done, 4)
                seen.append(task.completed)
    assert seen == pytest.approx([0, 0.25, 0.5, 1, 1, 1.25, 1.5, 2])


def test_nothing_is_written_where_there_is_no_terminal(capsys):
    with progress(1) as step:
        step("reading")
        step.within(1, 2)
    told = capsys.readouterr()
    assert told.out == told.err == ""


@pytest.mark.long
def test_a_large_assembly_is_told_before_the_search(monkeypatch):
    monkeypatch.setattr(run, "MANY_PARTS", 3)
    done = CliRunner().invoke(app, ["inspect", str(path("fourbar")), "--fixed", "ground"])
    assert done.exit_code == 0
    assert "fourbar.step has 4 parts" in done.stderr
    assert "--fixed PART" in done.stderr


def test_numpy_works_on_one_thread_unless_told_otherwise(monkeypatch):
    """The same numbers, and no error where there is no library of OpenBLAS."""
    matrix = np.random.default_rng(0).normal(size=(60, 40))
    before = np.linalg.svd(matrix, compute_uv=False)
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    one_thread()
    np.testing.assert_allclose(np.linalg.svd(matrix, compute_uv=False), before, rtol=1e-12)
    monkeypatch.setattr(Path, "glob", lambda *given: pytest.fail("looked for a library"))
    monkeypatch.setenv("OPENBLAS_NUM_THREADS", "2")
    one_thread()
