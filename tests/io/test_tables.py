import csv
from dataclasses import replace

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import jaxkin as jk
from jaxkin.io.long_motion import write_stream


def _robot(names=("A", "B", "C"), unit="mm"):
    """An arm with three joints and four coordinates; no loops, so nothing to solve."""
    a, b, c = names
    return jk.Mechanism.build(
        fixed=["ground"],
        unit=unit,
        joints=[
            jk.revolute(a, "ground", "arm", point=(0, 0, 0), axis=(0, 0, 1)),
            jk.cylindrical(b, "arm", "wrist", point=(1, 0, 0), axis=(1, 2, 2)),
            jk.prismatic(c, "wrist", "tool", point=(2, 0, 0), axis=(0, 1, 0)),
        ],
    )


@pytest.fixture(scope="module")
def motion():
    """Thirds and roots: numbers that take all digits."""
    part = jnp.linspace(0.0, 1.0, 41)
    drive = {"A": 7 * part, "B.z": jnp.sqrt(part), "B.phi": -part / 3, "C": part**2 / 7}
    motion = _robot().sweep(drive)
    codes = np.where(np.arange(41) > 32, jk.Status.UNREACHABLE.value, jk.Status.CLOSED.value)
    return replace(motion, status=jnp.array(codes), residual=part / 9)


@pytest.mark.long
def test_chunks_make_the_same_arrays(motion, tmp_path):
    """Of a mechanism without loops: nothing is compiled for it."""
    motion = motion.mechanism.sweep(motion.inputs)
    motion.save(tmp_path, only="motion.npz")
    stream, written = motion.mechanism.stream(motion.inputs, chunk=9), []
    said = write_stream(stream, tmp_path / "long.npz", lambda: written.append(1))
    assert said == str(motion) and len(written) == len(stream) == 5
    with np.load(tmp_path / "motion.npz") as whole, np.load(tmp_path / "long.npz") as arrays:
        assert set(arrays) == {name for name in whole if not name.startswith("part:")}
        for name in arrays:
            assert arrays[name].dtype == whole[name].dtype and np.array_equal(arrays[name], whole[name]), name
    assert {file.name for file in tmp_path.iterdir()} == {"motion.npz", "long.npz"}


def _rows(path):
    with path.open(newline="", encoding="utf-8") as file:
        heading, *rows = csv.reader(file)
    return heading, rows


def test_arrays_come_back_bit_for_bit(motion, tmp_path):
    motion.save(tmp_path, only="motion.npz")
    with np.load(tmp_path / "motion.npz") as arrays:  # without allow_pickle: nothing is pickled
        back = dict(arrays)
    expected = {"status": motion.status, "residual": motion.residual}
    expected |= {f"input:{name}": values for name, values in motion.inputs.items()}
    expected |= {f"joint:{name}": values for name, values in motion.coordinates.items()}
    expected |= {f"part:{name}": values for name, values in motion.transforms.items()}
    for key, values in expected.items():
        values = np.asarray(values)
        assert back[key].dtype == values.dtype and back[key].shape == values.shape, key
        assert back[key].tobytes() == values.tobytes(), key
    words = {"status_names", "unit", *(f"coordinates:{name}" for name in "ABC")}
    assert set(back) == set(expected) | words
    assert back["coordinates:B"].tolist() == ["z", "phi"] and back["coordinates:C"].tolist() == ["z"]
    assert str(back["unit"]) == "mm"
    assert back["part:wrist"].shape == (41, 4, 4) and back["joint:B"].shape == (41, 2)
    assert back["status_names"][back["status"]].tolist() == ["CLOSED"] * 33 + ["UNREACHABLE"] * 8


def test_table_has_one_row_a_pose_in_full_precision(motion, tmp_path):
    motion.save(tmp_path, only="motion.csv")
    heading, rows = _rows(tmp_path / "motion.csv")
    joints = ["A.phi [rad]", "B.z [mm]", "B.phi [rad]", "C.z [mm]"]
    assert heading == ["pose", *(f"input:{joint}" for joint in joints), *joints, "status", "residual"]
    columns = dict(zip(heading, zip(*rows, strict=True), strict=True))
    assert list(columns["pose"]) == [str(pose) for pose in range(41)]
    assert list(columns["status"]) == ["CLOSED"] * 33 + ["UNREACHABLE"] * 8
    numbers = {heading: np.array(column, float) for heading, column in columns.items() if heading != "status"}
    for name, values in motion.inputs.items():
        (column,) = (column for column in numbers if column.startswith(f"input:{name} "))
        assert np.array_equal(numbers[column], values)
    displacements = np.concatenate([np.asarray(values) for values in motion.coordinates.values()], axis=1)
    assert np.array_equal(np.stack([numbers[joint] for joint in joints], axis=1), displacements)
    assert np.array_equal(numbers["residual"], motion.residual)


def test_names_with_commas_and_quotes_stay_one_column(tmp_path):
    names = ("crank, left", "Gelenk Ü", 'the "pin"')
    drive = dict.fromkeys((names[0], "Gelenk Ü.z", "Gelenk Ü.phi", names[2]), jnp.zeros(3))
    motion = _robot(names, unit="").sweep(drive)
    motion.save(tmp_path, only=("motion.csv", "motion.npz"))
    heading, rows = _rows(tmp_path / "motion.csv")
    # a length whose unit nobody said stands alone
    assert heading[5:9] == ["crank, left.phi [rad]", "Gelenk Ü.z", "Gelenk Ü.phi [rad]", 'the "pin".z']
    assert {len(row) for row in rows} == {len(heading)}
    with np.load(tmp_path / "motion.npz") as arrays:
        assert arrays["coordinates:Gelenk Ü"].tolist() == ["z", "phi"]


@pytest.mark.filterwarnings("ignore:.*float32.*")
def test_single_precision_stays_single_and_is_written_short(tmp_path):
    with jax.enable_x64(False):
        crank = jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=(0, 0, 1))
        motion = jk.Mechanism.build(fixed=["ground"], joints=[crank]).sweep({"A": jnp.array([0.1, 0.7])})
        motion.save(tmp_path, only=("motion.csv", "motion.npz"))
    assert [row[1] for row in _rows(tmp_path / "motion.csv")[1]] == ["0.1", "0.7"]
    with np.load(tmp_path / "motion.npz") as arrays:
        assert arrays["input:A.phi"].dtype == np.float32
