"""Colours of bodies in pictures and their legends."""

from dataclasses import replace

import pytest

from jaxkin.view.drawing import FIXED_COLOR, LEAST_DIFFERENCE, body_colors, told_apart
from jaxkin.view.inspection import draw_inspection
from jaxkin.view.scene import make_scene
from reference.round_parts import assembly, block, part, pin, ring

WHITE, RED, BLUE = (1.0, 1.0, 1.0), (0.8, 0.1, 0.1), (0.1, 0.1, 0.8)
BODIES = {"base": ("base",), "arm": ("arm", "screw"), "hand": ("hand",)}


def painted(**colors):
    """The parts of the bodies, in these colours."""
    made = [part(name, block((0, 0, 0), (1, 1, 1))) for parts in BODIES.values() for name in parts]
    return [replace(each, color=colors.get(each.name, WHITE)) for each in made]


def test_colours_of_the_file_are_kept_where_they_tell_bodies_apart():
    """Also where a screw of one body looks like those of another."""
    parts = painted(arm=RED, hand=BLUE)
    assert told_apart(parts, BODIES, ["base"]) == tuple(parts)


@pytest.mark.parametrize("hand", [WHITE, (0.97, 0.97, 1.0)])
def test_bodies_of_one_colour_get_those_of_the_palette(hand):
    found = {each.name: each.color for each in told_apart(painted(hand=hand), BODIES, ["base"])}
    assert found["base"] == FIXED_COLOR
    assert found["arm"] == found["screw"] != found["hand"]
    assert WHITE not in found.values()


def test_colours_of_bodies_differ_enough():
    """All that the palette and its shades have."""
    many = {f"b{number}": (f"b{number}",) for number in range(21)}
    colors = list(body_colors(many, []).values())
    gaps = [
        sum((x - y) ** 2 for x, y in zip(one, other, strict=True)) ** 0.5
        for k, one in enumerate(colors)
        for other in colors[:k]
    ]
    assert min(gaps) >= LEAST_DIFFERENCE


@pytest.fixture(scope="module")
def white():
    """A base with two levers on pins, one of them with a knob, all white."""
    base = part("base", block((-80, -40, -10), (80, 40, 0)), pin(4.0, 0, 20), pin(4.0, 0, 20, at=(40, 0)))
    levers = [
        part(f"lever {x}", ring(4.0, 9.0, 0, 19.5, at=(x, 0)), block((x - 4, 8, 0), (x + 4, 30, 6))) for x in (0, 40)
    ]
    knob = part("knob", block((36, 30, 0), (44, 38, 6)))
    return assembly(*(replace(each, color=WHITE) for each in (base, *levers, knob)))


def test_a_motion_of_white_parts_is_drawn_in_colours(white):
    mechanism = white.mechanism(fixed=["base"], rigid=[["lever 40", "knob"]])
    scene = make_scene(mechanism.sweep({name: [0.0, 0.1] for name in mechanism.mobility().drivable}))
    colors = {each.name: each.color for each in scene.parts}
    assert len(set(colors.values())) == 3 and colors["base"] == FIXED_COLOR


def test_the_legend_of_an_inspection_names_bodies(white, tmp_path, monkeypatch):
    """One entry a body, each with a colour of its own."""
    from jaxkin.view import inspection

    entries = []
    monkeypatch.setattr(inspection, "draw_legend", lambda sheet, found: entries.extend(found))
    mechanism = white.mechanism(fixed=["base"], rigid=[["lever 40", "knob"]])
    draw_inspection(white, tmp_path / "white.png", mechanism=mechanism, width=200)
    named = {text: patch.get_facecolor() for patch, text in entries if "lever" in text or "base" in text}
    assert {"base (fixed)", "lever 0", "lever 40, knob"} == set(named)
    assert len(set(named.values())) == 3
