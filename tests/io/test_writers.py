from pathlib import Path

import jax
import jax.numpy as jnp
import pytest

import jaxkin as jk
from jaxkin.io.writers import WRITERS, save


@pytest.fixture(scope="module")
def motion():
    """A crank alone: the smallest mechanism that moves."""
    crank = jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=(0, 0, 1))
    return jk.Mechanism.build(fixed=["ground"], joints=[crank]).sweep({"A": jnp.linspace(0.0, 1.0, 5)})


def text(content):
    """A writer of a text."""
    return lambda motion, path: path.write_text(content)


def _files(directory: Path) -> dict[str, str]:
    return {path.name: path.read_text() for path in directory.iterdir()}


def test_files_are_written_in_their_order_and_paths_come_back_in_it(motion, tmp_path):
    writers = {"table.csv": text("a table"), "arrays.npz": text("arrays"), "picture.png": text("a picture")}
    paths = save(motion, tmp_path / "deep" / "out", writers=writers)
    assert [path.name for path in paths] == list(writers)
    assert _files(tmp_path / "deep" / "out") == {path.name: path.read_text() for path in paths}
    assert paths[2].read_text() == "a picture"


def test_the_draft_has_the_name_of_the_file_and_is_out_of_sight(motion, tmp_path):
    seen = []

    def write(motion, path):
        seen.append(path)
        assert not (tmp_path / "movie.tar.gz").exists()
        path.write_text("whole")

    save(motion, tmp_path, writers={"movie.tar.gz": write})
    assert seen[0].name == "movie.tar.gz"
    assert _files(tmp_path) == {"movie.tar.gz": "whole"}


def test_a_failing_writer_leaves_whole_files_only_and_is_named(motion, tmp_path):
    def fail(motion, path):
        path.write_text("half of a pic")
        path.with_name("beside.tmp").write_text("left behind")
        raise RuntimeError("no more ink")

    (tmp_path / "picture.png").write_text("the picture of an earlier run")
    writers = {"table.csv": text("a table"), "picture.png": fail, "after.txt": text("not reached")}
    with pytest.raises(OSError, match=r"picture\.png.*no more ink"):
        save(motion, tmp_path, writers=writers)
    assert _files(tmp_path) == {"table.csv": "a table", "picture.png": "the picture of an earlier run"}


def test_an_interrupted_writer_leaves_nothing(motion, tmp_path):
    def stop(motion, path):
        path.write_text("half of a pic")
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        save(motion, tmp_path, writers={"picture.png": stop})
    assert _files(tmp_path) == {}


def test_a_writer_that_writes_nothing_is_named(motion, tmp_path):
    with pytest.raises(OSError, match=r"could not write .*picture\.png"):
        save(motion, tmp_path, writers={"picture.png": lambda motion, path: None})


def test_files_are_chosen_by_name(motion, tmp_path):
    writers = {name: text(name) for name in ("a.txt", "b.txt", "c.txt")}
    assert [path.name for path in save(motion, tmp_path, ["c.txt", "a.txt"], writers)] == ["a.txt", "c.txt"]
    assert [path.name for path in save(motion, tmp_path, "b.txt", writers)] == ["b.txt"]
    with pytest.raises(ValueError, match=r"'d\.txt'.*a\.txt, b\.txt, c\.txt"):
        save(motion, tmp_path / "untouched", ["a.txt", "d.txt"], writers)
    assert not (tmp_path / "untouched").exists()


def test_a_path_that_ends_as_a_file_does_is_that_file(motion, tmp_path):
    """`save("rocker.csv")` made a folder of this name, with all files in it."""
    (path,) = motion.save(tmp_path / "rocker.csv")
    assert path == tmp_path / "rocker.csv" and path.read_text().startswith("pose")
    assert [each.name for each in tmp_path.iterdir()] == ["rocker.csv"]
    (tmp_path / "v1.csv").mkdir()
    (inside,) = motion.save(tmp_path / "v1.csv", only="motion.csv")
    assert inside.read_text() == path.read_text()


@pytest.mark.parametrize("end", [".svg", ".JSON"])
def test_a_path_that_ends_as_another_file_does_makes_no_folder(motion, tmp_path, end):
    with pytest.raises(
        ValueError, match=rf"a file that ends in \.npz, \.csv, .* or as all of them .*; got 'rocker{end}'"
    ):
        motion.save(tmp_path / f"rocker{end}")
    assert not list(tmp_path.iterdir())
    (tmp_path / f"v1{end}").mkdir()
    (inside,) = motion.save(tmp_path / f"v1{end}", only="motion.csv")
    assert inside.is_file()


@pytest.mark.parametrize("inside", [".", "out"])
def test_a_file_is_no_directory(motion, tmp_path, inside):
    (tmp_path / "taken").write_text("mine")
    with pytest.raises(NotADirectoryError, match=r"taken.*name a directory"):
        save(motion, tmp_path / "taken" / inside, writers={"a.txt": text("a")})
    assert (tmp_path / "taken").read_text() == "mine"


@pytest.mark.long
def test_a_motion_saves_itself(motion, tmp_path):
    paths = motion.save(tmp_path)
    assert [path.name for path in paths][:2] == ["motion.npz", "motion.csv"]
    assert {path.name for path in tmp_path.iterdir()} == set(WRITERS) >= {"motion.glb"}


def test_a_traced_motion_prints_itself_and_is_not_saved(motion, tmp_path):
    texts = []

    def traced(angles):
        swept = motion.mechanism.sweep({"A": angles})
        texts.append(str(swept))
        with pytest.raises(ValueError, match="traced by JAX: call save outside of jit, vmap and grad"):
            swept.save(tmp_path / "out")
        return swept.status

    jax.jit(traced)(jnp.linspace(0.0, 1.0, 5))
    assert texts[0].startswith("Motion of 2 parts over 5 poses, driven by A.phi: traced by JAX")
    assert not list(tmp_path.iterdir())
