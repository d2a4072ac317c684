"""A thousand files damaged at random: refused in one clear line, or read with a word about it, or none is needed.

On two cores that other programs use as well a hundred take two and a half minutes, and all of them twenty.
"""

import tempfile
import time
import traceback
import warnings
from pathlib import Path

import numpy as np
import pytest

from jaxkin.geometry.fit import rounding
from jaxkin.geometry.shells import open_loops, volume
from jaxkin.geometry.weld import weld
from jaxkin.io.load import load
from jaxkin.io.study import load_study
from jaxkin.io.time_limit import TimeLimit
from mutations import KINDS, mutated

FILES = {"step": 300, "stl": 100, "obj": 100, "ply": 100, "3mf": 150, "glb": 150, "toml": 100}
"""Seeds of each kind: from 0 on."""

ROUNDS = 10
"""The first tenth of the files is among the long tests, all of them are a study."""

BUSY = 3.0
"""Times the time allowed that a file may take: other programs may run, and the last part is read to its end."""


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("round", [0, *(pytest.param(k, marks=pytest.mark.study) for k in range(1, ROUNDS))])
def test_damaged_files_are_refused_or_told(tmp_path, monkeypatch, capfd, kind, round):
    work, temporary = tmp_path / "work", tmp_path / "temporary"
    work.mkdir()
    temporary.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    for seed in range(round * FILES[kind] // ROUNDS, (round + 1) * FILES[kind] // ROUNDS):
        content, about = mutated(kind, seed)
        file = work / f"bad.{kind}"
        file.write_bytes(content)
        begin = time.monotonic()
        wrong = failure(file)
        late = time.monotonic() - begin > BUSY * TimeLimit.start(file).seconds
        assert not wrong and not late, f"{kind} {seed} ({about}): {wrong or 'took too long'}"
        assert capfd.readouterr() == ("", ""), f"{kind} {seed} ({about}): printed"
        assert list(work.iterdir()) == [file] and not list(temporary.iterdir()), f"{kind} {seed} ({about}): left files"


def failure(file: Path) -> str:
    """What is wrong with how a damaged file was received; "" where nothing is."""
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        try:
            parts = load_study(file).assembly.parts if file.suffix == ".toml" else load(file).parts
        except (ValueError, OSError) as error:
            return unclear(error, file)
    for warning in said:
        if not str(warning.message).startswith(file.name) or "\n" in str(warning.message):
            return f"warned: {warning.message}"
    return "" if said else "; ".join(filter(None, map(unsound, parts)))


def unclear(error: Exception, file: Path) -> str:
    """What is wrong with a message: of a library, nameless, or more than a line (a study lists its mistakes)."""
    text = str(error)
    from_jaxkin = "jaxkin" in Path(traceback.extract_tb(error.__traceback__)[-1].filename).parts
    lines = text.splitlines()
    told = from_jaxkin and len(text) < 1000 and (len(lines) == 1 or file.suffix == ".toml")
    # a study may name a file that is not there
    named = all(file.name in line for line in lines) or (file.suffix == ".toml" and len(lines) == 1)
    return "" if told and named else f"{type(error).__name__}: {text}"


def unsound(part) -> str:
    """What is wrong with a part that was read without a word, in its notes or as a warning."""
    if any("four surfaces" not in note for note in part.notes):
        return ""
    size = np.linalg.norm(np.ptp(part.triangles.reshape(-1, 3), axis=0))
    # corners are float32 in the file and in the frame of the part: some roundings of its place in the world
    tolerance = 3 * rounding(part.triangles) + 1e-6 * size
    if open_loops(weld(part.triangles, 2 * tolerance), tolerance):
        return f"{part.name} is not closed"
    if not volume(part.triangles) > 0:
        return f"{part.name} has the volume {volume(part.triangles)}"
    off = max((np.abs(face.surface.distance(face.triangles)).max() for face in part.faces), default=0.0)
    return f"{part.name} has a face {off} off its surface" if not off < 1e-3 * size else ""
