"""What fits a pin exactly, and no face keeps there, is pressed on where others have play; short holes guide nothing."""

import re

import pytest

import jaxkin as jk
from jaxkin.joints.evidence import EvidenceKind
from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, moving, owners, part, pin, ring


def machine(play=0.2, kept=False, inner=3.0, extra=()):
    """A lever between collars on a pin of a base, and on its peg a grip, amid that and with no face near.

    The lever has `play`; collars of the peg are near to the grip on both sides where it is `kept`.
    """
    collar = [pin(9.0, -20, -5), pin(9.0, 5, 20)]
    base = part("base", block((-60, -60, -30), (60, 60, -20)), pin(5.0 - play, -20, 20), *collar)
    collars = [pin(6.0, 8.5, 9.5, at=(80, 0)), pin(6.0, 24.5, 25.5, at=(80, 0))] if kept else []
    bar = block((11, -3, -4), (90, 3, 4))
    lever = part("lever", ring(5.0, 12.0, -4, 4), bar, pin(3.0, 4, 30, at=(80, 0)), *collars)
    grip = part("grip", ring(inner, 5.0, 10, 24, at=(80, 0)), block((84, -3, 12), (94, 3, 22)))
    return assembly(base, lever, grip, *extra)


@pytest.mark.parametrize("seed", SEEDS)
def test_what_no_face_keeps_on_a_pin_that_it_fits_is_pressed_on_where_others_have_play(seed):
    mechanism = anywhere(machine(), seed).mechanism(fixed=["base"])
    body = owners(mechanism)
    assert body["grip"] == body["lever"] != body["base"]
    (bond,) = (each for each in mechanism.bonds if each.evidence.kind is EvidenceKind.TIGHT_FIT)
    sizes = dict(bond.evidence.sizes)
    assert {*bond.parts} == {"grip", "lever"} and sizes["clearance"] <= 1e-4 * sizes["radius"]
    assert "14 of 14" in bond.evidence.text


@pytest.mark.parametrize("seed", SEEDS)
def test_the_line_that_is_told_makes_the_hinge_again(seed):
    drawn = anywhere(machine(), seed)
    told = next(note for note in drawn.mechanism(fixed=["base"]).notes if "if they turn, say joints=" in note)
    written = re.search(r"say joints=\[(.*)\]$", told)
    assert written is not None
    hinge = eval(written[1], {"jk": jk})
    mechanism = drawn.mechanism(fixed=["base"], joints=[hinge])
    assert kind_of(mechanism, "lever", "grip") == "revolute" and mechanism.mobility().useful == 2


@pytest.mark.parametrize(("play", "kept"), [(0.0, False), (0.2, True)])
def test_it_turns_where_nothing_has_play_or_faces_keep_it(play, kept):
    mechanism = machine(play, kept).mechanism(fixed=["base"])
    assert kind_of(mechanism, "lever", "grip") == "revolute"


def test_exact_contacts_alone_leave_it_on_its_pin():
    mechanism = machine().mechanism(fixed=["base"], rigid=[["base", "lever"]], infer=False)
    assert kind_of(mechanism, "lever", "grip") == "cylindrical"


def test_what_has_play_itself_turns():
    mechanism = machine(inner=3.2).mechanism(fixed=["base"])
    assert kind_of(mechanism, "lever", "grip") == "revolute"


def test_what_alone_could_move_is_not_held():
    """With the lever fixed only the grip is left: held, nothing would move."""
    roller = part("roller", ring(4.2, 8.0, 6, 30, at=(-40, 0)))
    post = [pin(4.0, -20, 40, at=(-40, 0)), pin(9.0, 0, 5.5, at=(-40, 0)), pin(9.0, 30.5, 35, at=(-40, 0))]
    drawn = machine(extra=(part("post", *post), roller))
    mechanism = drawn.mechanism(fixed=["base", "lever", "post"])
    assert kind_of(mechanism, "lever", "grip") == "revolute"


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("length", "kind"), [(4.0, "revolute"), (14.0, "cylindrical")])
def test_a_hole_shorter_than_wide_guides_no_slide_where_no_face_stops_it_either(length, kind, seed):
    base = part("base", block((-40, -40, -60), (40, 40, -50)), pin(3.0, -50, 60))
    plate = part("plate", ring(3.2, 8.0, 0, length), block((7, -4, 0), (70, 4, length)))
    mechanism = anywhere(assembly(base, plate), seed).mechanism(fixed=["base"])
    (joint,) = moving(mechanism)
    assert joint.evidence is not None and joint.kind == kind
    assert ("would jam on a slide:" in joint.evidence.text) == (kind == "revolute")
