from pathlib import Path

import jax.numpy as jnp
import pytest

import jaxkin as jk
from jaxkin.mechanism import writers


@pytest.fixture(scope="module")
def motion():
    """A crank alone: the smallest mechanism that moves."""
    crank = jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=(0, 0, 1))
    return jk.Mechanism.build(fixed=["ground"], joints=[crank]).sweep({"A": jnp.linspace(0.0, 1.0, 5)})


@pytest.fixture
def registry(monkeypatch):
    """An empty registry for the time of a test."""
    monkeypatch.setattr(writers, "_tables", {})
    monkeypatch.setattr(writers, "_others", {})


def _register(filename, text, **options):
    @writers.register(filename, **options)
    def write(motion, path):
        path.write_text(text)

    return write


def _files(directory: Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in directory.iterdir()}


def test_tables_are_written_first_and_paths_come_back_in_that_order(registry, motion, tmp_path):
    _register("picture.png", "a picture")
    _register("table.csv", "a table", table=True)
    _register("arrays.npz", "arrays", table=True)
    paths = writers.save(motion, tmp_path / "deep" / "out")
    assert [path.name for path in paths] == ["table.csv", "arrays.npz", "picture.png"] == list(writers.filenames())
    assert _files(tmp_path / "deep" / "out") == {path.name: path.read_text() for path in paths}
    assert paths[2].read_text() == "a picture"


def test_the_draft_has_the_name_of_the_file_and_is_out_of_sight(registry, motion, tmp_path):
    seen = []

    @writers.register("movie.tar.gz")
    def write(motion, path):
        seen.append(path)
        assert not (tmp_path / "movie.tar.gz").exists()
        path.write_text("whole")

    writers.save(motion, tmp_path)
    assert seen[0].name == "movie.tar.gz"
    assert _files(tmp_path) == {"movie.tar.gz": "whole"}


def test_a_failing_writer_leaves_whole_files_only_and_is_named(registry, motion, tmp_path):
    _register("table.csv", "a table", table=True)

    @writers.register("picture.png")
    def write(motion, path):
        path.write_text("half of a pic")
        path.with_name("beside.tmp").write_text("left behind")
        raise RuntimeError("no more ink")

    _register("after.txt", "not reached")
    (tmp_path / "picture.png").write_text("the picture of an earlier run")
    with pytest.raises(OSError, match=r"picture\.png.*no more ink"):
        writers.save(motion, tmp_path)
    assert _files(tmp_path) == {"table.csv": "a table", "picture.png": "the picture of an earlier run"}


def test_an_interrupted_writer_leaves_nothing(registry, motion, tmp_path):
    @writers.register("picture.png")
    def write(motion, path):
        path.write_text("half of a pic")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        writers.save(motion, tmp_path)
    assert _files(tmp_path) == {}


def test_a_writer_that_writes_nothing_is_named(registry, motion, tmp_path):
    writers.register("picture.png")(lambda motion, path: None)
    with pytest.raises(OSError, match=r"could not write .*picture\.png"):
        writers.save(motion, tmp_path)


def test_files_are_chosen_by_name(registry, motion, tmp_path):
    for name in ("a.txt", "b.txt", "c.txt"):
        _register(name, name)
    assert [path.name for path in writers.save(motion, tmp_path, only=["c.txt", "a.txt"])] == ["a.txt", "c.txt"]
    assert [path.name for path in writers.save(motion, tmp_path, only="b.txt")] == ["b.txt"]
    with pytest.raises(ValueError, match=r"'d\.txt'.*a\.txt, b\.txt, c\.txt"):
        writers.save(motion, tmp_path / "untouched", only=["a.txt", "d.txt"])
    assert not (tmp_path / "untouched").exists()


@pytest.mark.parametrize("inside", [".", "out"])
def test_a_file_is_no_directory(registry, motion, tmp_path, inside):
    _register("a.txt", "a")
    (tmp_path / "taken").write_text("mine")
    with pytest.raises(NotADirectoryError, match=r"taken.*name a directory"):
        writers.save(motion, tmp_path / "taken" / inside)
    assert (tmp_path / "taken").read_text() == "mine"


def test_one_writer_a_name(registry):
    _register("a.txt", "first", table=True)
    with pytest.raises(ValueError, match=r"'a\.txt' has a writer already"):
        _register("a.txt", "second")


@pytest.mark.long
def test_a_motion_saves_itself(motion, tmp_path):
    paths = motion.save(tmp_path)
    assert [path.name for path in paths][:2] == ["motion.npz", "motion.csv"]
    assert {path.name for path in tmp_path.iterdir()} == set(writers.filenames()) >= {"motion.glb"}
