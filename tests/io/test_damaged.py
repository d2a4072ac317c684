"""Damages that once stopped a reader, or went unnoticed; the smallest of those that `test_fuzz.py` and others found."""

import math
import os
import re
import signal
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import pytest

from jaxkin.examples import path
from jaxkin.io import sandbox
from jaxkin.io.load import load
from jaxkin.io.step_convert import convert
from jaxkin.io.study import load_study
from jaxkin.io.time_limit import TimeLimit
from mutations import mutated

DATA = Path(__file__).parent / "data"

ENDLESS = {
    "a coordinate that is no number": ("splines.step", "(8.,0.,0.)", "(nan,0.,0.)"),
    "a line without length": ("fillet.step", "#187 = VECTOR('',#188,1.)", "#187 = VECTOR('',#188,0.)"),
    "a corner at infinity": ("halves.step", "#695 = CARTESIAN_POINT('',(10.", "#695 = CARTESIAN_POINT('',(inf"),
}
"""What the kernel works on without end."""

UNNOTICED = {
    "a plane whose axis is a part's": (
        DATA / "nested.step",
        "#174 = AXIS2_PLACEMENT_3D('',#175,",
        "#174 = AXIS2_PLACEMENT_3D('',#186,",
        r"'washer': it is not closed, there is a hole, near \(",
    ),
    "an edge to a corner elsewhere": (
        path("cam"),
        "#499 = EDGE_CURVE('',#290,#500,",
        "#499 = EDGE_CURVE('',#290,#1058,",
        "3 parts are placed in it, 2 can be made as solids; its solids have 26 faces, 18 can be made",
    ),
}
"""What the kernel leaves parts or faces out for without a word."""


def damaged(folder, source, old, new):
    text = Path(source).read_text()
    assert old in text
    file = folder / "bad.step"
    file.write_text(text.replace(old, new, 1))
    return file


@pytest.mark.long
@pytest.mark.parametrize("name", ENDLESS)
def test_a_reader_that_does_not_return_is_ended(tmp_path, capfd, name):
    source, old, new = ENDLESS[name]
    file = damaged(tmp_path, DATA / source, old, new)
    begin = time.monotonic()
    late = r"\(0\.0\d+ MB\) was not read within 0\.8 seconds of a processor, .* or with --seconds 4$"
    # a kernel that fills its memory sooner than its time has crashed
    with pytest.raises(ValueError, match=rf"^bad\.step ?(: the reader of STEP files crashed .* 4 GB of memory|{late})"):
        load(file, seconds=0.8)
    assert time.monotonic() - begin < 20.0  # 8 s on a machine that is as busy as it may be, and to start
    assert capfd.readouterr() == ("", "")
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.long
def test_the_time_of_a_study_is_that_of_its_files(tmp_path):
    damaged(tmp_path, DATA / "fillet.step", *ENDLESS["a line without length"][1:])
    study = tmp_path / "study.toml"
    study.write_text('geometry = "bad.step"\nfixed = ["nose"]\n')
    with pytest.raises(ValueError, match=r"^bad\.step .* was not read within 0\.8 seconds"):
        load_study(study, seconds=0.8)


@pytest.mark.parametrize("name", UNNOTICED)
def test_what_a_reader_leaves_out_is_told(tmp_path, name):
    *edit, message = UNNOTICED[name]
    file = damaged(tmp_path, *edit)
    with pytest.warns(UserWarning, match=rf"^bad\.step is damaged or incomplete \(.*{message}") as said:
        load(file)
    assert len(said) == 1 and "\n" not in str(said[0].message)


REFUSED = {
    ("step", 31): "bad.step is damaged: none of its solids can be made",  # was: need at least one array to stack
    ("step", 79): "bad.step is damaged: coordinates of the part 'bush' are no numbers",  # was loaded
}
"""Mutations by kind and seed."""


@pytest.mark.parametrize(("kind", "seed"), REFUSED)
def test_errors_of_libraries_are_told_in_a_line(tmp_path, kind, seed):
    file = tmp_path / f"bad.{kind}"
    file.write_bytes(mutated(kind, seed)[0])
    with pytest.raises(ValueError, match=f"^{REFUSED[kind, seed]}") as caught:
        load(file)
    assert "\n" not in str(caught.value)


def test_an_archive_that_cannot_be_unpacked(tmp_path):
    """Was a bare zlib.error."""
    file = tmp_path / "bad.3mf"
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("3D/3dmodel.model", "<model></model>" * 100)
    content = bytearray(file.read_bytes())
    start = 30 + len("3D/3dmodel.model")  # of what is compressed: after a header of 30 bytes and the name
    content[start : start + 4] = b"\xff" * 4
    file.write_bytes(content)
    with pytest.raises(ValueError, match=r"^bad\.3mf is damaged or no 3MF file: Error -3 while decompressing.*again$"):
        load(file)


def test_the_time_allowed_grows_with_the_file(tmp_path):
    file = tmp_path / "some.step"
    for size, seconds in ((0, 20.0), (1_000_000, 25.0), (10_000_000, 70.0)):
        with file.open("wb") as target:
            target.truncate(size)
        assert TimeLimit.start(file).seconds == pytest.approx(seconds)
        assert TimeLimit.start(file).remaining() == pytest.approx(seconds, abs=1.0)
    assert TimeLimit.start(file, 3).seconds == 3.0


def test_other_programs_do_not_shorten_the_time(tmp_path, monkeypatch):
    """Of what the clock says only work counts: a file is read while it stands still for longer than is allowed."""
    begin = time.monotonic()
    limit = TimeLimit.start(path("cam"), 0.3)
    time.sleep(0.4)
    assert time.monotonic() - begin > 0.3 and limit.remaining() > 0.2
    work = time.thread_time()
    while time.thread_time() - work < 0.31:
        pass
    with pytest.raises(ValueError, match=r"cam\.step .* was not read within 0\.3 seconds of a processor, or 3 in all"):
        limit.remaining()


@pytest.mark.parametrize("seconds", [0, -1.0, math.nan, math.inf, "60", True])
def test_a_time_that_is_none(seconds):
    with pytest.raises(ValueError, match="seconds is the time allowed to read a file, a positive number; got "):
        load(path("cam"), seconds=seconds)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="there are no named pipes")
@pytest.mark.parametrize("suffix", ["step", "stl"])
def test_a_pipe_is_not_waited_for(tmp_path, suffix):
    os.mkfifo(tmp_path / f"pipe.{suffix}")
    with pytest.raises(ValueError, match=r"is a pipe or a device: give the \w+ file itself"):
        load(tmp_path / f"pipe.{suffix}")


ASKING = """
import sys
from pathlib import Path
from jaxkin.io.step_convert import convert
from jaxkin.io.time_limit import TimeLimit
file = Path(sys.argv[1])
convert(file.read_bytes(), TimeLimit.start(file, float(sys.argv[2])))
"""


def programs(folder) -> dict[int, str]:
    """The programs whose command names a folder, by their number."""
    listed = subprocess.run(["ps", "-ww", "-eo", "pid,command"], capture_output=True, text=True, check=True).stdout
    return {int(line.split()[0]): line for line in listed.splitlines() if f"{folder}/" in line}


def wait_until(true, seconds=30.0):
    """Wait until something holds; the machine may be busy."""
    ends = time.monotonic() + seconds
    while not true() and time.monotonic() < ends:
        time.sleep(0.02)
    assert true()


@pytest.fixture
def asked(tmp_path):
    """Starts a process that asks for a file without end to be read; the folder of the reader's files."""
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    source, old, new = ENDLESS["a coordinate that is no number"]
    file = damaged(tmp_path, DATA / source, old, new)
    processes = []

    def start(seconds):
        command = [sys.executable, "-c", ASKING, str(file), str(seconds)]
        process = subprocess.Popen(command, env={**os.environ, "TMPDIR": str(temporary)}, stderr=subprocess.DEVNULL)
        processes.append(process)
        wait_until(lambda: len(programs(temporary)) == 2)  # the guardian and the reader
        return process, temporary

    yield start
    for process in processes:
        process.kill()
        process.wait()


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="signals, and ps, are those of POSIX")
@pytest.mark.parametrize("how", [signal.SIGKILL, signal.SIGINT])
def test_nothing_is_left_of_a_reader_when_nobody_waits_for_it(asked, how):
    process, temporary = asked(300)
    process.send_signal(how)
    process.wait()
    wait_until(lambda: not programs(temporary), 10.0)  # some hundredths of a second
    wait_until(lambda: not list(temporary.iterdir()), 10.0)


@pytest.mark.long
@pytest.mark.skipif(sys.platform == "win32", reason="signals, and ps, are those of POSIX")
def test_a_reader_ends_by_itself_when_all_who_watch_it_are_killed(asked):
    process, temporary = asked(2)
    watching = next(number for number, command in programs(temporary).items() if "guardian.py" in command)
    os.kill(watching, signal.SIGSTOP)  # or it ends the reader when the process that asked is gone
    process.kill()
    os.kill(watching, signal.SIGKILL)
    wait_until(lambda: not programs(temporary), 60.0)  # 2 s of a processor that were allowed, 5 s more


def test_conversion_leaves_no_files(tmp_path, monkeypatch):
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    file = DATA / "painted.step"
    glb, damages = convert(file.read_bytes(), TimeLimit.start(file))
    assert re.match(rb"glTF", glb) and damages == []
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(sys.platform != "linux", reason="other systems have no bound of the address space to lower")
def test_a_bound_that_the_system_refuses_leaves_the_others(tmp_path):
    """Who may have 4 GB himself cannot allow 8 GB: the bound of the processor's time holds all the same."""
    (tmp_path / "worker.py").write_text("import resource\nprint(resource.getrlimit(resource.RLIMIT_CPU)[0])\n")
    lowered = f"import resource\nresource.setrlimit(resource.RLIMIT_AS, (1 << 32, 1 << 32))\n{sandbox._BOUNDED}"
    command = [sys.executable, "-c", lowered, "60", "7", str(8 << 30), str(tmp_path / "worker.py")]
    assert subprocess.run(command, capture_output=True, text=True, check=True).stdout.strip() == "7"
