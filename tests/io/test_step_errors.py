"""Files that cannot be read: one clear message each, nothing printed, and the process lives on."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from jaxkin.examples import path
from jaxkin.io.load import load
from jaxkin.io.step import read_step

DATA = Path(__file__).parent / "data"
CAM = path("cam").read_bytes()
RNG = np.random.default_rng(0)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "bad.step is empty"),
        (b" \n", "bad.step is empty"),
        (b"a four-bar linkage\n" * 20, "bad.step is not a STEP file: .*ISO-10303-21"),
        (RNG.bytes(5000), "bad.step is not a STEP file"),
        (b"ISO-10303-21;\n" + RNG.bytes(5000), "bad.step is cut off: .*END-ISO-10303-21"),
        (CAM[: len(CAM) // 2], "bad.step is cut off: .*END-ISO-10303-21"),
        (CAM[:500], "bad.step is cut off"),
        (CAM[: CAM.index(b"DATA;")] + b"DATA;\nENDSEC;\nEND-ISO-10303-21;\n", "bad.step holds no solids"),
        ((DATA / "sheet.step").read_bytes(), "bad.step holds no solids, only surfaces"),
        # syntax that breaks off in the middle, and a section of data that never ends
        (CAM[: len(CAM) // 2] + b"\nENDSEC;\nEND-ISO-10303-21;\n", "bad.step cannot be read as STEP"),
    ],
)
def test_content_that_is_no_step_file(tmp_path, capfd, content, message):
    file = tmp_path / "bad.step"
    file.write_bytes(content)
    with pytest.raises(ValueError, match=message):
        read_step(file)
    assert capfd.readouterr() == ("", "")
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize("seed", range(3))
def test_damaged_files_do_not_take_the_process_down(tmp_path, capfd, seed):
    """The native reader dies on most of these; on the others it leaves parts out."""
    rng = np.random.default_rng(seed)
    content = bytearray(CAM)
    for place in rng.integers(500, len(content) - 500, 30):
        content[place] = rng.integers(32, 127)
    file = tmp_path / "bad.step"
    file.write_bytes(content)
    with pytest.raises((ValueError, UserWarning), match=r"bad\.step.*export it again"):
        read_step(file)
    assert capfd.readouterr() == ("", "")


def test_missing_files_and_folders(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"nowhere\.step does not exist"):
        load(tmp_path / "nowhere.step")
    folder = tmp_path / "folder.step"
    folder.mkdir()
    with pytest.raises(ValueError, match=r"folder\.step is a folder"):
        load(folder)


@pytest.mark.parametrize("name", ["part.iges", "part.STEPX", "part"])
def test_other_formats_are_refused_by_what_can_be_read(tmp_path, name):
    with pytest.raises(ValueError, match=r"STEP files \(\.step, \.stp\) and meshes \(\.stl"):
        load(tmp_path / name)


def test_no_files_are_refused():
    with pytest.raises(ValueError, match="a dict of files by part"):
        load({})


def test_load_gives_an_assembly(tmp_path):
    file = tmp_path / "CAM.STP"
    file.write_bytes(CAM)
    assembly = load(str(file))
    assert [part.name for part in assembly.parts] == ["cam", "follower", "frame"]
    assert assembly.unit == "mm"
    assert assembly.source == "CAM.STP"
