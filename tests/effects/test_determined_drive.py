"""A drive that does not determine the poses is refused in the same words by all that search for poses."""

import numpy as np
import pytest

import jaxkin as jk
from reference.mechanisms import Z

PINS = {"A": (0, 0), "B": (-10, 50), "C": (20, 90), "D": (70, 95), "E": (110, 60), "F": (100, 0)}
LINKS = ["ground", "one", "two", "three", "four", "five", "ground"]


def six_pins(axis_of_c=Z) -> jk.Mechanism:
    """A ring of six hinges, which has three freedoms in its plane."""
    joints = [
        jk.revolute(name, LINKS[k], LINKS[k + 1], point=(*at, 0), axis=axis_of_c if name == "C" else Z)
        for k, (name, at) in enumerate(PINS.items())
    ]
    return jk.Mechanism.build(fixed=["ground"], joints=joints)


def limits(mechanism, hold):
    return jk.limits(mechanism, "A", hold=hold)


def assembly_modes(mechanism, hold):
    return jk.assembly_modes(mechanism, dict.fromkeys(["A", *hold], 0.0))


def workspace(mechanism, hold):
    grid = np.linspace(-0.1, 0.1, 3)
    return jk.workspace(mechanism, {"A": grid, hold[0]: grid}, "two", (0, 0, 0), hold=hold[1:])


@pytest.mark.parametrize("search", [limits, assembly_modes, workspace])
def test_what_does_not_determine_the_poses_is_refused(search):
    mechanism = six_pins()
    with pytest.raises(ValueError, match=r"^A\.phi, F\.phi leave freedoms, .*infinitely many .*: (hold|give) .* too"):
        search(mechanism, ["F"])
    with pytest.raises(ValueError, match=r"has 3 freedoms"):
        search(mechanism, ["F", "B", "E"])
    assert search(mechanism.with_lengths({("two", "B", "C"): 60.0}), ["F", "B"])  # the assembled pose is open
    opened = mechanism.with_lengths({("two", "B", "C"): 600.0})
    with pytest.raises(ValueError, match=r"cannot be assembled: where .*, the loop over .* is open by .*; give it len"):
        search(opened, ["F", "B"])
    tilted = six_pins((0.0, 1e-4, 1.0))
    assert tilted.linkage.ideal
    with pytest.raises(ValueError, match=r"cannot be told of joints that disagree: .*'C'"):
        search(tilted, ["F", "B"])
