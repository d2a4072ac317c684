"""What is of another type than its annotation is refused in words.

These calls are kept apart from those in which continuous integration checks types of arguments.
"""

import pytest

import jaxkin as jk
from jaxkin.examples import path


@pytest.fixture(scope="module")
def fourbar():
    return jk.load(path("fourbar"))


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({"fixed": None}, "fixed must be a list of part names, got None"),
        (
            {"fixed": ["ground"], "joints": ["weld"]},
            "joints must be a list of joints, such as [jk.revolute(...)], got 'weld' among them",
        ),
    ],
)
def test_words_of_an_assembly(fourbar, options, said):
    with pytest.raises(ValueError) as error:
        fourbar.mechanism(**options)
    assert said in str(error.value)


def test_a_drive(fourbar):
    with pytest.raises(ValueError, match=r"such as plan\(\['A'\]\), got None"):
        fourbar.mechanism(fixed=["ground"]).plan(None)
