import numpy as np
import pytest

from jaxkin.view.labels import Input, named, title, values
from jaxkin.view.sheet import fitted, text_width


@pytest.mark.parametrize(
    ("value", "text"),
    [(60.0, "60°"), (59.99999, "60°"), (27.04, "27°"), (27.06, "27.1°"), (-1e-12, "0°"), (-33.75, "\u221233.8°")],
)
def test_angles_are_rounded_to_a_tenth_of_a_degree(value, text):
    assert Input("A", np.array([value]), "°").at(0) == text


@pytest.mark.parametrize(
    ("value", "text"), [(12.0, "12 mm"), (0.0123456, "0.01235 mm"), (1.5e-7, "1.5e\u221207 mm"), (-3.0, "\u22123 mm")]
)
def test_lengths_have_four_digits_and_their_unit(value, text):
    assert Input("A", np.array([value]), " mm").at(0) == text


def test_one_input_needs_no_name_and_of_many_some_are_told():
    entries = tuple(Input(f"j{i}", np.array([10.0 * i]), "°") for i in range(5))
    assert title(entries[1:2], 0) == "10°" and named(entries[1:2], 0) == "j1 10°"
    assert title(entries[:2], 0) == named(entries[:2], 0) == "j0 0°, j1 10°"
    assert named(entries, 0) == "j0 0°, j1 10°, j2 20° and 2 more"
    assert values(entries, 0) == "0°, 10°, 20° and 2 more"


@pytest.mark.parametrize("text", ["iiiiiiiiiiiiiiiiiiiiiiii", "WWWWWWWWWWWWWWWWWWWWWWWW", "Kurbel #2, Höhe 3°"])
def test_a_text_is_cut_to_its_measured_width(text):
    """The longest beginning that fits: a letter more is too wide."""
    whole = text_width(text, 10, "bold")
    assert fitted(text, whole, 10, "bold") == text
    cut = fitted(text, whole / 2, 10, "bold")
    assert cut[-1] == "…" and text.startswith(cut[:-1])
    assert text_width(cut, 10, "bold") <= whole / 2 < text_width(f"{text[: len(cut)]}…", 10, "bold")


def test_letters_that_the_font_lacks_are_measured_without_a_word():
    """Names in Chinese, and a letter that combines with the one before it: a warning is an error in tests."""
    assert text_width("支架", 10) > text_width("", 10) == 0
    assert text_width("crank \u0366", 10) >= text_width("crank", 10)
