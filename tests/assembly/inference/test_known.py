"""What is known of solids grows by what rules infer, and each pair of bodies is joined by the first rule that does."""

import jaxkin as jk
from jaxkin.assembly.inference.inference import Inference
from jaxkin.assembly.inference.known import Known
from jaxkin.assembly.inference.measured import Measured
from jaxkin.contacts.contact import Contacts
from jaxkin.joints.evidence import BY_HAND
from reference.round_parts import block, part

PARTS = [part(name, block((20 * k, 0, 0), (20 * k + 10, 10, 10))) for k, name in enumerate("abcde")]


def hinge(one: str, other: str, y: float = 0.0) -> Inference:
    return Inference.of(jk.revolute(f"{one}-{other}", one, other, point=(0, y, 0), axis=(0, 0, 1)), BY_HAND)


def test_parts_are_joined_once_by_the_surest_rule():
    by_hand = jk.revolute("motor", "a", "b", point=(0, 0, 0), axis=(0, 0, 1))
    known = Known(Measured(PARTS), Contacts(()), ["a"], (), [by_hand])
    known.rings = {frozenset("cd")}
    weld = Inference(("d", "e"), BY_HAND)
    assert known.take([hinge("d", "e"), hinge("a", "b"), weld])  # within a body, and where one by hand is
    assert known.found == [weld] and known.body["e"] == "d"
    assert not known.take([weld, Inference(("a", "b"), BY_HAND), Inference(("c", "e"), BY_HAND)])
    axes = [hinge("c", "e"), hinge("c", "d", 5.0)]
    assert known.take(axes) and known.found == [weld, *axes]  # one rule may find two axes
    assert known.jointed == {frozenset("ab"), frozenset("cd")}
    assert not known.take([hinge("d", "c", 9.0), Inference(("c", "d"), BY_HAND)])


def test_what_is_ignored_is_left_out_of_what_rules_infer():
    """Of a body the later part of the pair is left out, which its host, named first, does not hold then."""
    known = Known(Measured(PARTS), Contacts(()), ["a"], (), (), [frozenset("ac"), frozenset("de")])
    known.take([Inference(("a", "b", "c"), BY_HAND), Inference(("d", "e"), BY_HAND), hinge("e", "d")])
    assert [each.parts for each in known.found] == [("a", "b")] and not known.jointed
    assert known.taken_back == {frozenset("ac"), frozenset("de")}
    assert known.take([Inference(("b", "c"), BY_HAND)])  # by a third part they may be one body
