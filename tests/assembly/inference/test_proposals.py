"""What may be fixed and driven, found by trying."""

import pytest

import jaxkin as jk
from jaxkin.examples import path


@pytest.fixture(scope="module")
def fourbar():
    return jk.load(path("fourbar"))


@pytest.mark.long
def test_each_proposal_holds_what_it_says(fourbar):
    found = fourbar.proposals()
    assert found
    for proposal in found:
        mechanism = fourbar.mechanism(fixed=proposal.fixed)
        assert mechanism.mobility().useful == proposal.freedoms
        assert proposal.problem or not mechanism.plan(proposal.drive).notes
    assert found[0].freedoms == 1
    assert "one freedom" in str(found[0])
    assert [bool(each.problem) for each in found] == sorted(bool(each.problem) for each in found)


@pytest.mark.long
def test_the_part_and_the_drive_may_be_given(fourbar):
    (proposal,) = fourbar.proposals(fixed=["gr*"], drive=["ground-crank.phi"])
    assert proposal.fixed == ("ground",)
    assert proposal.drive == ("ground-crank.phi",)
    assert "can be driven" in str(proposal)


def test_what_cannot_move_is_said(fourbar):
    assembly = fourbar.without([name for name in fourbar.names if name != "ground"])
    (proposal,) = assembly.proposals()
    assert proposal.problem
    assert proposal.drive == ()


def test_many_coordinates_are_counted():
    """All of them are in `drive`; a line of text tells the first."""
    drive = tuple(f"j{number}.phi" for number in range(18))
    told = str(jk.Proposal(("base",), drive, 18, 19, 18))
    assert "'j0.phi'" in told and "and 13 more can be driven" in told and "'j17.phi'" not in told
