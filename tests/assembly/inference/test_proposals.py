"""What may be fixed and driven, found by trying."""

from dataclasses import replace
from itertools import pairwise

import pytest

import jaxkin as jk
from jaxkin.assembly import dropped_inference
from jaxkin.assembly.assembly import Assembly
from jaxkin.assembly.dropped_inference import DROPPED
from jaxkin.assembly.proposals import grouped
from jaxkin.cli.run import unlock
from jaxkin.examples import path
from jaxkin.io.study import Study
from reference.round_parts import assembly, block, part, pin, ring


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


def test_proposals_of_one_effect_are_told_in_one_line():
    one, other = (jk.Proposal((name,), ("a.phi",), 1, 3, 2) for name in ("base", "lid"))
    lines = grouped([one, jk.Proposal(("arm",), ("b.phi",), 2, 3, 2), other])
    assert len(lines) == 2 and lines[0].startswith("with fixed = ['base'] or ['lid'] it has one freedom")


def test_several_fixed_parts_that_still_most_of_what_moves_come_after_single_ones():
    """Levers are what a machine moves, and no brackets on a wall: fixed, they leave the shaft two freedoms of seven."""
    places = [(40.0, 0.0), (80.0, 0.0), (120.0, 0.0)]
    posts = [pin(5.0, -60, -20, at) for at in places]
    base = part("base", block((-60, -60, -100), (160, -50, 100)), ring(5.0, 12.0, -60, -20), *posts)
    shaft = part("shaft", pin(5.0, -80, 60), block((-30, -2, -75), (4, 2, -70)))
    wheel = part("wheel", ring(5.0, 9.0, 20, 50), block((8, -3, 20), (30, 3, 50)))
    levers = [
        part(f"lever {k}", ring(5.0, 9.0, -45, -15, at), block((at[0] - 2, 8, -45), (at[0] + 2, 30, -15)))
        for k, at in enumerate(places)
    ]
    found = assembly(base, shaft, wheel, *levers).proposals()
    assert found[0].fixed == ("base",)
    several = next(each for each in found if len(each.fixed) > 1)
    assert several.freedoms < found[0].freedoms  # it would come first by its freedoms


@pytest.fixture
def chain():
    """Five links in a row on a base."""
    places = [(0.0, 0.0), (30.0, 40.0), (80.0, 30.0), (120.0, 70.0), (160.0, 20.0), (190.0, 60.0)]
    base = part("base", block((-60, -60, -40), (60, 60, -20)), pin(5.0, -20, 10))
    links = []
    for k, (one, other) in enumerate(pairwise(places)):
        low = 10.0 * k
        eye, low_corner, high_corner = ring(5.0, 9.0, low, low + 10, one), min(one, other), max(one, other)
        bar = block((low_corner[0] + 8, low_corner[1] - 2, low), (high_corner[0] - 8, low_corner[1] + 2, low + 10))
        links.append(part(f"link {k}", eye, bar, pin(5.0, low, low + 20, other)))
    return assembly(base, *links)


def test_the_ends_of_an_open_chain_are_no_brackets_on_a_wall(chain):
    """Fixed at both ends, five hinges in a row leave fewer freedoms, and all of them move."""
    found = chain.proposals()
    assert found[0].fixed == ("base",)
    several = next(each for each in found if len(each.fixed) > 1)
    assert 1 < several.freedoms < found[0].freedoms and several.moving == found[0].moving  # it came first by both


def test_ends_that_lock_what_moves_are_not_proposed_to_be_fixed(chain, monkeypatch):
    """As those of a Hooke's joint: a pin of its cross would turn instead, after what holds it was dropped."""
    make = Assembly.mechanism

    def dropping(self, fixed, **options):
        made = make(self, fixed=fixed, **options)
        return replace(made, history=(f"{DROPPED}: a pin", *made.history)) if len(fixed) > 1 else made

    monkeypatch.setattr(Assembly, "mechanism", dropping)
    assert all(len(each.fixed) == 1 for each in chain.proposals())


def test_the_longest_part_of_a_body_is_not_fixed_where_it_is_a_screw():
    """By itself it fastens nothing, so that fixed alone it would leave its plate free."""
    bolts = [(40.0, 0.0), (-40.0, 0.0)]
    base = part(
        "base",
        block((-34, -30, 0), (34, 30, 50)),
        *(ring(2.6, 8.0, 0, 50, at) for at in bolts),
        pin(5.0, 50, 75),
    )
    plate = part("plate", *(ring(2.6, 8.0, -50, 0, at) for at in bolts), block((-34, -30, -50), (34, 30, 0)))
    screws = [part(f"screw {k}", pin(2.5, -100, 50, at), pin(4.5, 50, 54, at)) for k, at in enumerate(bolts)]
    nuts = [part(f"nut {k}", ring(2.5, 5.0, -54, -50, at)) for k, at in enumerate(bolts)]
    lever = part("lever", ring(5.0, 9.0, 50, 75), block((8, -2, 50), (30, 2, 75)))
    found = assembly(*screws, *nuts, base, plate, lever).proposals()
    assert found[0].fixed == ("base",) and found[0].freedoms == 1
    assert not {name for each in found for name in each.fixed} & {each.name for each in screws}


@pytest.fixture
def clamped(monkeypatch):
    """A bracket under the head of a screw. Trials would drop the one inference that locks it: without them it stays
    locked, as a machine does that several inferences lock."""
    monkeypatch.setattr(dropped_inference, "_TRIED", 0)
    base = part("base", block((-80, -80, -30), (80, 80, -20)), ring(2.5, 9.0, -20, 0))
    bracket = part("bracket", ring(2.75, 9.0, 0, 6), block((8, -4, 0), (40, 4, 6)))
    return assembly(base, bracket, part("screw", pin(2.5, -10, 6), pin(4.5, 6, 11)))


def test_where_nothing_can_move_inferences_are_taken_back_in_turn(clamped):
    locked, *others = clamped.proposals(fixed=["base"])
    assert locked.problem and not locked.ignore
    assert others and all(each.ignore and not each.problem for each in others)
    for each in others:
        mechanism = clamped.mechanism(fixed=each.fixed, ignore=each.ignore)
        assert mechanism.mobility().useful == each.freedoms > 0
        assert not mechanism.plan(each.drive).notes
    assert "and ignore = [['" in str(others[0])
    assert "assembly.proposals(fixed=...) tries" in str(clamped.mechanism(fixed=["base"]))


def test_inspection_prints_what_takes_an_inference_back(clamped, capsys):
    unlock(Study("bracket.step", clamped, fixed=["base"]))
    told = capsys.readouterr().out
    assert "Inferences were taken back in turn:" in told and "and ignore = [['" in told
    unlock(Study("bracket.step", clamped, fixed=["base"], infer=False))
    assert not capsys.readouterr().out


def test_what_takes_an_inference_back_comes_before_what_cannot_move(clamped):
    found = clamped.proposals()
    assert not found[0].problem and found[0].ignore
    assert [bool(each.problem) for each in found] == sorted(bool(each.problem) for each in found)


def test_nothing_is_taken_back_where_something_moves():
    base = part("base", block((-60, -60, -60), (60, -30, 0)), pin(5.0, -30, 10), pin(9.0, 10, 12), pin(9.0, -12, 0))
    lever = part("lever", ring(5.0, 9.0, 0, 10), block((8, -4, 0), (60, 4, 10)))
    found = assembly(base, lever).proposals(fixed=["base"])
    assert len(found) == 1 and found[0].freedoms == 1
