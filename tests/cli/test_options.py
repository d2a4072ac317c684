"""`--drive`, `--rigid`, `--ignore`: what is read, in which unit, and what is refused."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import jaxkin as jk
from jaxkin.cli.app import app
from jaxkin.cli.options import Options, parse_drives, parse_parts
from jaxkin.io.ranges import Range, in_radians
from jaxkin.joints.pairs import cylindrical, revolute
from jaxkin.mechanism.mechanism import Mechanism

MECHANISM = Mechanism.build(
    fixed=["base"],
    joints=[
        revolute("hinge", "base", "arm", point=(0, 0, 0), axis=(0, 0, 1)),
        cylindrical("sleeve=2", "arm", "tool", point=(1, 0, 0), axis=(0, 0, 1)),
    ],
)


def test_range_and_list():
    drives = parse_drives(["hinge=-30:30:3", "sleeve=2.z=0,2.5,1e1"])
    assert list(drives) == ["hinge", "sleeve=2.z"]
    np.testing.assert_array_equal(drives["hinge"].values, [-30.0, 0.0, 30.0])
    np.testing.assert_array_equal(drives["sleeve=2.z"].values, [0.0, 2.5, 10.0])


def test_angles_are_degrees_and_lengths_are_not():
    drives = parse_drives(["sleeve=2.z=0:90:2", "hinge=0:90:2", "sleeve=2.phi=0:-90:2"])
    converted = in_radians(MECHANISM, drives)
    np.testing.assert_array_equal(converted["sleeve=2.z"], [0.0, 90.0])
    np.testing.assert_allclose(converted["hinge.phi"], [0.0, np.pi / 2])
    np.testing.assert_allclose(converted["sleeve=2.phi"], [0.0, -np.pi / 2])


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (["hinge"], "--drive hinge: write JOINT=START:STOP:COUNT"),
        (["=0:1:2"], "--drive =0:1:2: write JOINT="),
        (["hinge=0:360"], "cannot read '0:360' as a range"),
        (["hinge=0:360:many"], "cannot read '0:360:many'"),
        (["hinge=0:360:2.5"], "cannot read '0:360:2.5'"),
        (["hinge=0:360:0"], "COUNT must be a number from 1 to 10000000, got 0"),
        (["hinge=0:nan:5"], "displacements must be finite numbers, got '0:nan:5'; write START:STOP:COUNT"),
        (["hinge=0:inf:5"], "displacements must be finite numbers, got '0:inf:5'"),
        (["hinge=1,nan"], "displacements must be finite numbers, got '1,nan'"),
        (["hinge=0:1:2:3"], "cannot read '0:1:2:3'"),
        (["hinge=a,b"], "cannot read 'a,b'"),
        (["hinge=0:1:2", "hinge=0:2:2"], "hinge was given a range already"),
    ],
)
def test_unreadable_options_are_refused(options, said):
    with pytest.raises(ValueError, match="--drive") as error:
        parse_drives(options)
    assert said in str(error.value)


def test_a_file_given_twice_is_named():
    crank, other = Path("crank.stl"), Path("other/crank.stl")
    with pytest.raises(ValueError, match=r"^crank\.stl is given twice: give each file once$"):
        Options().on([crank, Path("rod.stl"), Path("crank.stl")])
    with pytest.raises(ValueError, match=r"other.crank\.stl and crank\.stl: two parts would be called 'crank'"):
        Options().on([crank, other])


def test_parts_of_an_option():
    """A comma or the dash of the reports; but the comma in the name of a merged face belongs to it."""
    values = [
        "bolt,plate",
        "bolt - plate",
        "bolt , plate",
        "bolt,plate,nut",
        "a-b face 3, 8 - c face 1",
        "a face 3, 8,b",
    ]
    assert parse_parts("--rigid", values) == [
        ["bolt", "plate"],
        ["bolt", "plate"],
        ["bolt", "plate"],
        ["bolt", "plate", "nut"],
        ["a-b face 3, 8", "c face 1"],
        ["a face 3, 8", "b"],
    ]
    for value in ("bolt", "bolt-plate", "bolt,", ""):
        with pytest.raises(ValueError, match=r"--ignore .*two parts"):
            parse_parts("--ignore", [value])


def test_units():
    drive = {"hinge": Range(np.array([0.25]), "turn"), "sleeve=2.z": Range(np.array([2.0]), "cm")}
    drive |= {"sleeve=2.phi": Range(np.array([1.5]), "rad")}
    converted = in_radians(replace(MECHANISM, unit="mm"), drive)
    assert [float(values[0]) for values in converted.values()] == pytest.approx([np.pi / 2, 20.0, 1.5], rel=1e-15)


@pytest.mark.parametrize(
    ("name", "unit", "said"),
    [
        ("hinge", "mm", "drive 'hinge': the unit is 'mm', but 'hinge.phi' is an angle; write one of deg, rad, turn"),
        ("sleeve=2.z", "deg", "'sleeve=2.z' is a length; write one of um, mm, cm"),
    ],
)
def test_units_of_the_other_kind_are_refused(name, unit, said):
    with pytest.raises(ValueError) as error:
        in_radians(replace(MECHANISM, unit="mm"), {name: Range(np.array([1.0]), unit)})
    assert said in str(error.value)


def test_the_help_says_what_each_effect_is():
    from jaxkin.cli.arguments import Effects
    from jaxkin.io.named_effects import EFFECTS

    (option,) = Effects.__metadata__
    assert [name for name in EFFECTS if f"{name} (" not in option.help] == []


def test_the_version_is_that_of_the_package():
    done = CliRunner().invoke(app, ["--version"])
    assert done.exit_code == 0 and done.output == f"jaxkin {jk.__version__}\n"
