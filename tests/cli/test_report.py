"""What of an assembly is printed once its mechanism is known."""

from dataclasses import replace

import numpy as np
import pytest

from jaxkin.cli import report
from jaxkin.solve.status import Status
from reference.mechanisms import planar_fourbar
from reference.round_parts import assembly, block, part, pin, ring

BASE = part("base", block((-40, -40, -10), (40, 40, 0)), pin(4.0, 0, 20))
LEVER = part("lever", ring(4.2, 9.0, 0, 19.5), block((8, -4, 0), (40, 4, 6)))


@pytest.mark.parametrize("verbose", [False, True])
def test_near_misses_that_a_joint_accounts_for_are_counted(capsys, verbose):
    """A pin with play is a hinge of the mechanism: how nearly it touches its hole is told where it is not."""
    drawn = assembly(BASE, LEVER)
    contacts, mechanism = drawn.contacts(), drawn.mechanism(fixed=["base"])
    (miss,) = contacts.near_misses
    assert [joint.kind for joint in mechanism.all_joints] == ["revolute"]
    report.print_near_misses(contacts, mechanism, verbose)
    said = capsys.readouterr().out
    assert "1 near miss, 1 of them of bodies and joints that are known otherwise" in said
    assert (str(miss) in said) == verbose
    report.print_near_misses(contacts, None, False)
    assert str(miss) in capsys.readouterr().out


def test_near_misses_of_contacts_alone_are_listed(capsys):
    drawn = assembly(BASE, LEVER)
    contacts = drawn.contacts()
    exact = drawn.mechanism(fixed=["base"], infer=False)
    report.print_near_misses(contacts, exact, False)
    said = capsys.readouterr().out
    assert "known otherwise" not in said and str(contacts.near_misses[0]) in said
    # the fit that the near miss advises, and once how it is given
    assert "give fit=0.05" in said and said.count("tolerance = { length = 0.001 }") == 1


def test_ranges_of_joints_are_printed_of_closed_poses_only(capsys):
    motion = planar_fourbar(0.7).sweep({"A": np.array([-1e-9, -0.1, -0.2])})
    report.print_motion(motion)
    said = capsys.readouterr().out
    assert "least" in said and "-0.000" not in said
    report.print_motion(replace(motion, status=np.full(3, Status.UNREACHABLE.value)))
    said = capsys.readouterr().out
    assert "3  UNREACHABLE" in said and "least" not in said and "closed from" not in said


def test_nothing_is_said_where_nothing_is_nearly_in_contact(capsys):
    drawn = assembly(BASE)
    report.print_near_misses(drawn.contacts(), None, True)
    assert not capsys.readouterr().out
