"""Joints in doubt: those whose other reading changes what moves, the least certain first."""

from dataclasses import replace

import jaxkin as jk
from jaxkin.joints.evidence import Certainty, Doubt, Evidence, EvidenceKind
from jaxkin.joints.kinds import JointKind
from jaxkin.mobility.doubts import doubts

STAYS = Evidence(EvidenceKind.CLEARANCE, doubt=Doubt(JointKind.REVOLUTE, "nothing stops it", Certainty.NO_STOP))
HELD = Evidence(EvidenceKind.CONTACT, doubt=Doubt(JointKind.FIXED, "it fits", Certainty.FIT))
SLIDES = Evidence(EvidenceKind.CLEARANCE, doubt=Doubt(JointKind.CYLINDRICAL, "it may slide", Certainty.SHORT))


def four_bar(last: jk.Joint) -> jk.Mechanism:
    """A planar loop with one joint given."""
    z = (0.0, 0.0, 1.0)
    pins = [
        jk.revolute("A", "ground", "crank", point=(0, 0, 0), axis=z),
        jk.revolute("B", "crank", "coupler", point=(0, 40, 0), axis=z),
        jk.revolute("C", "coupler", "rocker", point=(120, 80, 0), axis=z),
    ]
    return jk.Mechanism.build(fixed=["ground"], joints=[*pins, last])


def test_a_slide_that_its_loop_stops_is_in_no_doubt_and_one_outside_of_loops_is():
    at = dict(point=(100, 0, 0), axis=(0, 0, 1))
    slides = replace(jk.cylindrical("D", "ground", "rocker", **at), evidence=STAYS)
    assert not doubts(four_bar(slides).linkage)
    alone = jk.Mechanism.build(fixed=["ground"], joints=[slides])
    assert [joint.name for joint, _ in doubts(alone.linkage)] == ["D"]
    turns = replace(jk.revolute("D", "ground", "rocker", **at), evidence=SLIDES)
    assert [joint.name for joint, _ in doubts(four_bar(turns).linkage)] == ["D"]


def test_a_piston_whose_slide_alone_moves_its_loop_is_in_no_doubt():
    z = (0.0, 0.0, 1.0)
    piston = replace(jk.cylindrical("P", "barrel", "rod", point=(50, 20, 0), axis=(5, 2, 0)), evidence=STAYS)
    boom = [
        jk.revolute("A", "ground", "barrel", point=(0, 0, 0), axis=z),
        jk.revolute("B", "rod", "boom", point=(100, 40, 0), axis=z),
    ]
    alone = jk.Mechanism.build(
        fixed=["ground"], joints=[*boom, piston, jk.revolute("C", "ground", "boom", point=(0, 60, 0), axis=z)]
    )
    assert alone.mobility().freedoms == 1 and not doubts(alone.linkage)
    # with one link more something moves without the slide, too
    links = [
        jk.revolute("C", "boom", "link", point=(0, 60, 0), axis=z),
        jk.revolute("D", "link", "ground", point=(-40, 30, 0), axis=z),
    ]
    more = jk.Mechanism.build(fixed=["ground"], joints=[*boom, piston, *links])
    assert [joint.name for joint, _ in doubts(more.linkage)] == ["P"]


def test_doubts_come_by_how_often_such_joints_were_right():
    given = {"a": SLIDES, "b": HELD, "c": STAYS}
    joints, below = [], "ground"
    for name, evidence in given.items():
        make = jk.cylindrical if evidence is STAYS else jk.revolute
        joints.append(replace(make(name, below, f"arm {name}", point=(0, 0, 0), axis=(0, 0, 1)), evidence=evidence))
        below = f"arm {name}"
    chain = jk.Mechanism.build(fixed=["ground"], joints=joints)
    found = doubts(chain.linkage)
    assert [joint.name for joint, _ in found] == ["b", "c", "a"]
    assert sorted(doubt.seen.share for _, doubt in found) == [doubt.seen.share for _, doubt in found]
    told = str(chain)
    assert "Doubtful: 3 of 3 joints, the least certain first" in told
    assert told.index("b is taken") < told.index("c is taken") < told.index("a is taken")
    assert "b is taken as revolute, and may be one body: it fits" in told and "rigid=[['arm c'" not in told
