"""What reads the sizes of evidence does so for evidence of every kind, with whatever sizes its rule gave."""

from dataclasses import replace
from itertools import combinations

import pytest

from jaxkin.assembly.exact_fits import any_has_play, fits_its_hole, has_play, with_doubts
from jaxkin.assembly.guides import has_free_slide
from jaxkin.assembly.hinge_bores import holes_of, pins_of
from jaxkin.assembly.meant_to_turn import with_turning
from jaxkin.assembly.tight_fits import tight_fits
from jaxkin.joints.evidence import Certainty, Doubt, Evidence, EvidenceKind
from jaxkin.joints.kinds import JointKind
from reference.round_parts import SEEDS, across, anywhere, assembly, block, moving, owners, part, pin, ring

NAMES = ("radius", "clearance", "play", "depth")
SIZES = [chosen for count in range(len(NAMES) + 1) for chosen in combinations(NAMES, count)]
DOUBT = Doubt(JointKind.CYLINDRICAL, "one face only", Certainty.ONE_FACE)


def with_evidence(mechanism, *evidence):
    """The mechanism with the evidence of its joints, in their order."""
    joints = tuple(replace(joint, evidence=each) for joint, each in zip(moving(mechanism), evidence, strict=True))
    return replace(mechanism, linkage=replace(mechanism.linkage, joints=joints))


@pytest.mark.parametrize("kind", EvidenceKind)
def test_each_reader_of_sizes_takes_evidence_of_each_kind_with_any_sizes(kind):
    """An arm and a roller on a base: the arm has the evidence, and the roller play."""
    posts = [
        each for at in ((0, 0), (90, 0)) for each in (pin(4.0, 0, 20, at), pin(6.0, 0, 5, at), pin(6.0, 15, 20, at))
    ]
    base = part("base", block((-20, -20, -10), (110, 20, 0)), *posts)
    arm = part("arm", ring(4.1, 8.0, 5.1, 14.9), block((7, -3, 6), (60, 3, 14)))
    drawn = assembly(base, arm, part("roller", ring(4.1, 14.0, 5.1, 14.9, (90, 0))))
    plain, measured = drawn.mechanism(fixed=["base"]), drawn._measured
    hinge, other = moving(plain)
    assert [*hinge.parts, *other.parts] == ["base", "arm", "base", "roller"] and len(plain.linkage.spinning) == 1
    for names in SIZES:
        pin_in_hole = kind is EvidenceKind.CLEARANCE and {"radius", "clearance"} <= {*names}
        for size in (0.0, 0.5):
            sizes = tuple((name, 1.0 if name == "radius" else size) for name in names)
            evidence = Evidence(kind, sizes, "as is", DOUBT)
            assert has_play(evidence) == (pin_in_hole and size > 0)
            assert fits_its_hole(evidence) == (pin_in_hole and size == 0)
            mechanism = with_evidence(plain, evidence, other.evidence)
            tight = tight_fits(mechanism, measured, ())
            assert [each.parts for each in tight] == ([hinge.parts] if fits_its_hole(evidence) else [])
            assert with_doubts(mechanism, ()).parts == mechanism.parts
            where = {each.part for find in (holes_of, pins_of) for each in find(moving(mechanism)[0], measured.bores)}
            assert where <= {*hinge.parts}
            assert with_turning(with_evidence(plain, other.evidence, evidence), measured, ()).parts == mechanism.parts
            assert not has_free_slide(mechanism) and any_has_play(mechanism)


@pytest.mark.parametrize("kind", EvidenceKind)
def test_evidence_without_sizes_has_no_clearance(kind):
    assert Evidence(kind).relative_clearance is None and not has_play(Evidence(kind)) and not has_play(None)


@pytest.mark.parametrize("seed", SEEDS)
def test_a_pin_across_a_telescope_that_moves_as_a_whole_tells_no_play_of_what_moves(seed):
    """The telescope swings on a lever that is fixed; its pin has a clearance, and holds what it is in."""
    walls = [block((24, -30, -100), (30, 30, 100)), block((-30, -30, -100), (-24, 30, 100))]
    walls += [block((-24, 24, -100), (24, 30, 100)), block((-24, -30, -100), (24, -24, 100))]
    at, far = (-50.0, 0.0), (100.0, 60.0)
    eyes = [across(ring(6.2, 8.0, low, low + 6, at)) for low in (-30, 24)]
    outer = part("outer", *walls, *eyes, pin(4.0, 0, 60, far), pin(8.0, 0, 5, far), pin(8.0, 15, 60, far))
    inner = part("inner", block((-23.8, -23.8, -60), (23.8, 23.8, 160)), across(ring(6.2, 8.0, -23.8, 23.8, at)))
    cotter = part("cotter", across(pin(6.0, -34, 30, at), pin(10.0, 30, 34, at)))
    lever = part("lever", ring(4.0, 9.0, 5, 15, far), block((108, 57, 5), (140, 63, 15)))
    mechanism = anywhere(assembly(outer, inner, cotter, lever), seed).mechanism(fixed=["lever"])
    body = owners(mechanism)
    assert body["outer"] == body["inner"] == body["cotter"] != body["lever"]
    assert any("goes across" in bond.evidence.text for bond in mechanism.bonds)
    assert not any_has_play(mechanism)
