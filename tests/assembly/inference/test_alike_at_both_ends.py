"""Two ends of a coupling that are drawn alike are read alike, one of the fixed body as well.

Drawn at a place, a size and in an order at random: these change nothing.
"""

import pytest

from reference.round_parts import SEEDS, across, anywhere, assembly, block, kind_of, owners, part, pin, ring


def end(number, at, turned=lambda *pieces: [each for piece in pieces for each in piece], cheeks=2):
    """A fork, its pin with a head, and a collar on that, with a taper pin through both; with one cheek a bearing, and a
    shaft with its head on what it carries."""
    head = -44 if cheeks == 2 else -28
    cheeks = [ring(8.0, 15.0, *span, at) for span in ((28, 44), (-44, -28))][:cheeks]
    web = block((-10, 36 if at[1] > 0 else -60, -44), (10, 60 if at[1] > 0 else -36, 44))
    hole = (-52.0, at[1])
    headed = [pin(8.0, head, 60, at), pin(12.5, head - 10, head, at), across(ring(1.5, 1.6, -8, 8, hole))]
    collar = [ring(8.0, 12.5, 44, 60, at), across(ring(1.5, 1.6, 8, 12.5, hole))]
    pieces = {"fork": [*cheeks, web], "pin": headed, "collar": collar, "taper pin": [across(pin(1.5, -15, 15, hole))]}
    return [part(f"{name} {number}", turned(*some)) for name, some in pieces.items()]


def coupling(cheeks=2):
    eyes = [ring(8.0, 15.0, -28, 28, (0.0, 20.0)), across(ring(8.0, 15.0, -28, 28, (0.0, -20.0)))]
    return assembly(part("block", *eyes), *end(1, (0.0, 20.0), cheeks=cheeks), *end(2, (0.0, -20.0), across))


@pytest.mark.parametrize("seed", SEEDS)
@pytest.mark.parametrize("fixed", ["fork 1", "block"])
def test_both_pins_of_a_coupling_are_held_in_their_forks_whatever_is_fixed(fixed, seed):
    """Each turns between fork and block, which moves nothing else."""
    mechanism = anywhere(coupling(), seed).mechanism(fixed=[fixed])
    body = owners(mechanism)
    assert all(body[f"{name} {k}"] == body[f"fork {k}"] for name in ("pin", "collar", "taper pin") for k in (1, 2))
    assert {kind_of(mechanism, "block", f"fork {k}") for k in (1, 2)} == {"revolute"}


@pytest.mark.parametrize("seed", [0, 2, 3])
def test_a_shaft_that_carries_something_beside_its_bearing_turns_in_what_is_fixed(seed):
    """It may go with what it carries, whichever of the two comes first in the file, as in the last two of these."""
    body = owners(anywhere(coupling(cheeks=1), seed).mechanism(fixed=["fork 1"]))
    assert body["pin 1"] != body["fork 1"] and body["pin 2"] == body["fork 2"]


@pytest.mark.parametrize("seed", SEEDS)
def test_what_something_slides_along_turns_in_what_is_fixed(seed):
    """As a screw does that moves a slide, its thread drawn plain, with a link from the slide to a lever."""
    rails = [block((-10, 35, -28), (10, 36, 28)), *(block((x, 28, -28), (x + 1, 35, 28)) for x in (-11, 10))]
    pivot = across(pin(4.0, -12, -3, (-80.0, -50.0)), pin(2.0, -3, 3, (-80.0, -50.0)))
    fork, *others = end(1, (0.0, 20.0))
    fork = part("fork 1", [(each.surface, each.triangles) for each in fork.faces], *rails, pivot)
    arm = [block((-3, -30, -3), (3, 5, 3)), across(pin(2.0, 3, 9, (0.0, -27.0)))]
    slide = part("slide", ring(8.0, 15.0, -10, 10, (0.0, 20.0)), block((-10, 30, -10), (10, 35, 10)), *arm)
    eyes = [across(ring(2.0, 4.0, 3, 9, at)) for at in ((0.0, -27.0), (-40.0, -50.0))]
    link = part("link", *eyes, block((4, -48, 5), (8, -30, 35)))
    eye = [across(ring(2.0, 4.0, -3, 3, (-80.0, -50.0))), across(pin(2.0, 3, 9, (-40.0, -50.0)))]
    lever = part("lever", *eye, block((-3, -54, 36), (3, -46, 76)))
    mechanism = anywhere(assembly(fork, *others, slide, link, lever), seed).mechanism(fixed=["fork 1"])
    body = owners(mechanism)
    assert body["pin 1"] != body["fork 1"] and kind_of(mechanism, "slide", "fork 1") == "prismatic"
