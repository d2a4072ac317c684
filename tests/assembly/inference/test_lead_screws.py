"""Lead screws, drawn plain, in the flanged nuts of carriages: they turn, and the carriage goes along them.

Each is drawn with a known truth, at a place, a size and in an order at random: these change nothing.
"""

import pytest

import jaxkin as jk
from reference.round_parts import SEEDS, anywhere, assembly, block, kind_of, moving, owners, part, pin, ring


def axis_with_a_flanged_nut(bore, screws):
    """A screw with a collar in a bush of the frame, through a nut whose flange is on a carriage that a rod guides."""
    at = [(9.0, 0.0), (-9.0, 0.0), (0.0, 9.0), (0.0, -9.0)]
    feet = block((-30, -30, -40), (80, -14, -30)), block((-30, -30, -30), (-14, -14, 10))
    frame = part("frame", ring(4.05, 14.0, 0, 10), *feet, pin(4.0, -30, 220, (50.0, 0.0)))
    screw = part("screw", pin(4.0, 1, 200), pin(7.0, 10, 13))
    holes = [ring(1.7, 2.5, 100, 112, each) for each in at]
    carriage = part("carriage", ring(5.3, 6.5, 100, 112), *holes, ring(4.05, 9.0, 100, 112, (50.0, 0.0)))
    flange = [ring(1.75, 2.5, 112, 116, each) for each in at]
    nut = part("nut", ring(bore, 5.1, 97, 112), ring(bore, 11.5, 112, 116), *flange)
    held = [part(f"bolt {k}", pin(1.6, 104, 116, each), pin(3.0, 116, 119, each)) for k, each in enumerate(at[:screws])]
    return frame, screw, carriage, nut, part("wheel", ring(4.0, 15.0, 170, 178)), *held


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("bore", "screws"), [(3.25, 0), (3.25, 2), (3.5, 4), (4.05, 0), (4.0, 2)])
def test_a_lead_screw_turns_in_the_flanged_nut_of_a_carriage_that_a_rod_guides(bore, screws, seed):
    """Its thread is drawn plain, and the hole of the nut at its minor or at its major diameter."""
    mechanism = anywhere(assembly(*axis_with_a_flanged_nut(bore, screws)), seed).mechanism(fixed=["frame"])
    body = owners(mechanism)
    assert body["nut"] == body["carriage"] and len({body[each] for each in ("frame", "screw", "nut")}) == 3
    assert kind_of(mechanism, "frame", "screw") in ("revolute", "cylindrical")
    assert kind_of(mechanism, "screw", "nut") == "cylindrical"
    assert any("pitch=...)" in note for note in mechanism.notes) == (bore < 4.0)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_joint_that_the_note_on_a_lead_screw_gives_couples_screw_and_carriage(seed):
    drawn = anywhere(assembly(*axis_with_a_flanged_nut(3.25, 2)), seed, scaled_at_random=False)
    (note,) = (note for note in drawn.mechanism(fixed=["frame"]).notes if "jk.screw(" in note)
    said = note[note.index("joints=[") + len("joints=[") : note.index("pitch=...")]
    screw = eval(f"{said}pitch=8.0)", {"jk": jk})
    mechanism = drawn.mechanism(fixed=["frame"], joints=[screw])
    assert kind_of(mechanism, "screw", "nut") == "screw"
    assert mechanism.mobility().useful == 1


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("change", ["no flange", "no guide", "short"])
def test_a_screw_in_a_hole_for_its_thread_that_is_no_lead_screw_is_held_there(change, seed):
    """A nut without a flange, a plate that nothing guides, a screw that ends behind its nut."""
    frame, screw, carriage, nut, *_ = axis_with_a_flanged_nut(3.25, 0)
    if change == "no flange":
        nut = part("nut", ring(3.25, 5.1, 97, 112), ring(3.25, 11.5, 112, 116))
    if change == "no guide":
        frame = part("frame", ring(4.05, 14.0, 0, 10), block((-30, -30, -40), (80, -14, -30)))
    if change == "short":
        screw = part("screw", pin(4.0, 60, 117), pin(7.0, 55, 60))
    mechanism = anywhere(assembly(frame, screw, carriage, nut), seed).mechanism(fixed=["frame"])
    assert owners(mechanism)["nut"] == owners(mechanism)["screw"]


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("hole", [1.4, 1.45, 1.49])
def test_bolts_that_are_tight_in_two_plates_on_a_guide_rod_are_no_lead_screws(hole, seed):
    """They stand out far beyond both plates, whose holes are drawn a little too narrow, and carry their nuts."""
    at = [(-10.0, 0.0), (10.0, 0.0)]
    frame = part("frame", block((-40, -40, -60), (40, -20, -50)), block((-4, -40, -50), (4, -6, 80)), pin(4.0, -50, 80))
    plates = [
        part(name, *(ring(hole, 3.0, low, low + 3, each) for each in at), ring(4.05, 7.0, low, low + 3))
        for name, low in (("plate", 0.0), ("other plate", 3.0))
    ]
    bolts = [part(f"bolt {k}", pin(1.5, -12, 15, each), pin(2.75, 15, 18, each)) for k, each in enumerate(at)]
    nuts = [part(f"nut {k}", ring(1.175, 3.0, -4, 0, each)) for k, each in enumerate(at)]
    mechanism = anywhere(assembly(frame, *plates, *bolts, *nuts), seed).mechanism(fixed=["frame"])
    assert (
        len({owners(mechanism)[each] for each in ("plate", "other plate", "bolt 0", "bolt 1", "nut 0", "nut 1")}) == 1
    )
    assert not any("lead screw" in note for note in mechanism.notes)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("seated", "told"), [(False, False), (True, True)])
def test_a_rod_on_which_a_bearing_is_a_roller_is_no_lead_screw(seated, told, seed):
    """A threaded rod in a flanged nut of a plate that a rod guides; a bearing in a seat lets it turn."""
    frame, _, carriage, nut, *_ = axis_with_a_flanged_nut(4.12, 0)
    seat = [ring(11.0, 14.0, 20, 27)] if seated else []
    faces = [*ring(4.05, 14.0, 0, 10), *block((-30, -30, -40), (80, -14, -30)), *block((-30, -30, -30), (-14, -14, 10))]
    frame = part("frame", faces, pin(4.0, -30, 220, (50.0, 0.0)), *seat)
    screw, roller = part("screw", pin(4.0, 1, 200)), part("roller", ring(4.0, 11.0, 20, 27))
    drawn = anywhere(assembly(frame, screw, carriage, nut, roller), seed, scaled_at_random=False)
    mechanism = drawn.mechanism(fixed=["frame"])
    assert any("lead screw" in note for note in mechanism.history) == told


def vise(thread):
    """A jaw that slides in the square channel of a body, with a screw that turns in it, in a nut of the body."""
    channel = [block(*each) for each in (((-14, -14, 0), (14, -10, 60)), ((-14, 10, 0), (14, 14, 60)))]
    channel += [block(*each) for each in (((-14, -10, 0), (-10, 10, 60)), ((10, -10, 0), (14, 10, 60)))]
    body = part("body", *channel, ring(thread, 9.5, -10, 0), block((-60, -60, -10), (60, -14, 60)))
    sides = [block(*each) for each in (((-10, -10, 30), (10, -7, 90)), ((-10, 7, 30), (10, 10, 90)))]
    sides += [block(*each) for each in (((-10, -7, 30), (-7, 7, 90)), ((7, -7, 30), (10, 7, 90)))]
    jaw = part("jaw", *sides, ring(4.0, 7.0, 80, 90), block((-10, 10, 70), (10, 40, 90)))
    ends = pin(6.0, 90, 110), pin(6.0, 76, 80)
    screw = part("screw", pin(4.0, -40, 90), *ends, block((6, -2, 94), (50, 2, 100)))
    return assembly(body, jaw, screw)


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize(("thread", "found"), [(3.4, True), (2.0, False)])
def test_a_screw_that_turns_in_a_jaw_is_on_the_thread_along_which_that_slides(thread, found, seed):
    """The nut is a hole of the body itself; one of half the radius is no thread."""
    mechanism = anywhere(vise(thread), seed).mechanism(fixed=["body"])
    assert kind_of(mechanism, "jaw", "screw") == "revolute" and kind_of(mechanism, "body", "jaw") == "prismatic"
    body = owners(mechanism)
    kinds = [
        str(joint.kind) for joint in moving(mechanism) if {body[part] for part in joint.parts} == {"body", "screw"}
    ]
    assert kinds == (["cylindrical"] if found else [])
    assert any("pitch=...)" in note for note in mechanism.notes) == found
    assert mechanism.mobility().useful == (1 if found else 2)  # the pitch couples both


@pytest.mark.parametrize("seed", SEEDS)
def test_the_screw_joint_of_a_vise_couples_its_screw_with_its_jaw(seed):
    drawn = anywhere(vise(3.4), seed, scaled_at_random=False)
    (note,) = (note for note in drawn.mechanism(fixed=["body"]).notes if "jk.screw(" in note)
    said = note[note.index("joints=[") + len("joints=[") : note.index("pitch=...")]
    mechanism = drawn.mechanism(fixed=["body"], joints=[eval(f"{said}pitch=5.0)", {"jk": jk})])
    assert mechanism.mobility().useful == 1
