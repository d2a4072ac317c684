"""What `benchmarks/baseline.py --compare` says of two runs."""

import importlib.util
import json
import sys
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"


@pytest.fixture(scope="module")
def baseline():
    sys.path.insert(0, str(BENCHMARKS))
    try:
        spec = importlib.util.spec_from_file_location("baseline", BENCHMARKS / "baseline.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        yield module
    finally:
        sys.path.remove(str(BENCHMARKS))


@pytest.mark.parametrize(
    ("before", "now", "said"),
    [
        ((1.0, 0.0), (1.09, 0.0), "same"),  # a tenth is nothing
        ((1.0, 0.0), (1.11, 0.0), "slower"),
        ((1.0, 0.1), (1.25, 0.1), "same"),  # within both noises
        ((1.0, 0.1), (1.35, 0.1), "slower"),
        ((1.0, 0.1), (0.6, 0.1), "faster"),
    ],
)
def test_what_counts_as_slower(baseline, before, now, said):
    assert baseline.verdict(baseline.Figure(*before), baseline.Figure(*now)) == said


def test_one_slower_figure_is_enough_and_all_are_named(baseline):
    before = {"a": baseline.Figure(1.0, 0.0), "b": baseline.Figure(2.0, 0.0), "gone": baseline.Figure(1.0, 0.0)}
    now = {"a": baseline.Figure(1.5, 0.0), "b": baseline.Figure(1.0, 0.0), "new": baseline.Figure(1.0, 0.0)}
    table, good = baseline.compared(before, now)
    said = {line.split()[0]: line for line in table.splitlines()[1:]}
    assert not good and "slower" in said["a"] and "faster" in said["b"]
    assert "not measured now" in said["gone"] and "not in the baseline" in said["new"]
    assert baseline.compared(before, before)[1]


def test_a_baseline_is_read_as_it_was_written(baseline, tmp_path):
    figures = {"a": baseline.Figure(1.25, 0.5)}
    baseline.write(tmp_path / "baseline.json", figures)
    assert baseline.read(tmp_path / "baseline.json") == figures


def test_the_committed_baseline_can_be_read(baseline):
    figures = baseline.read(baseline.FILE)
    assert all(figure.ratio > 0 and figure.noise >= 0 for figure in figures.values())
    assert len(json.loads(baseline.FILE.read_text())) == len(figures) > 20
