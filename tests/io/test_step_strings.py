"""Names in STEP files: with letters that end statements, and in the encodings that systems write."""

from __future__ import annotations

import re
import warnings

import pytest

from jaxkin.examples import path
from jaxkin.io.step import read_step
from jaxkin.io.step_strings import plain_strings, string_value
from jaxkin.io.step_tree import nameless_occurrences, placed_parts

TEXT = path("fourbar").read_bytes()
WHOLE = TEXT.decode()


@pytest.mark.parametrize(
    ("written", "name"),
    [
        ("Gerät 中".encode(), "Gerät 中"),
        ("Gerät Ø5€".encode("cp1252"), "Gerät Ø5€"),  # was read as "Ger"
        (rb"Ger\X2\00E4\X0\t", "Gerät"),
        (rb"Ger\X\E4t \S\d \X4\0001F600\X0\ ", "Gerät ä 😀"),
        (b"a;b", "a;b"),
        (b"x;#12,#13;", "x;#12,#13;"),
        (b"it''s;ENDSEC;DATA;", "it's;ENDSEC;DATA;"),  # was a part without a name
    ],
)
def test_a_part_has_the_name_that_was_given(tmp_path, written, name):
    file = tmp_path / "named.step"
    file.write_bytes(TEXT.replace(b"'crank'", b"'" + written + b"'"))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parts, _ = read_step(file)
    assert [part.name for part in parts] == ["ground", name, "coupler", "rocker"]


@pytest.mark.parametrize("text", ["a;b", "#1, #2", "it''s; #3", "", "Ger\xc3\xa4t;"])
def test_strings_say_the_same_without_awkward_letters(text):
    statement = f"#1 = PRODUCT('{text}','{text}',$,(#8));"
    plain = plain_strings(statement)
    assert plain.count(";") == 1 and re.findall(r"#\d+", plain) == ["#1", "#8"]
    assert string_value(plain[14 : plain.index("','")]) == string_value(text)


def test_a_quotation_mark_too_many_leaves_a_text_as_it_is():
    assert plain_strings("#1 = A('b;c);\n#2 = B();") == "#1 = A('b;c);\n#2 = B();"


def test_assemblies_with_such_names_are_counted_and_called():
    text = plain_strings(
        "#1 = PRODUCT('arm; left','arm; left',$,(#9));#2 = PRODUCT_DEFINITION_FORMATION('','',#1);"
        "#3 = PRODUCT_DEFINITION('','',#2,#9);#5 = NEXT_ASSEMBLY_USAGE_OCCURRENCE('a;1','a;1','#7, #8',#4,#3,$);"
    )
    assert placed_parts(text, "arm.step") == {"3": 1}
    assert nameless_occurrences(text) == {"a;1": "arm; left"}


def test_open_surfaces_of_a_product_with_such_a_name_are_left_out(tmp_path):
    """They were read as a part of their own, in a file that was called damaged."""
    found = re.search(r"#(\d+) = ADVANCED_BREP_SHAPE_REPRESENTATION\('',\(([^()]*)\),(#\d+)\);", WHOLE)
    face = re.search(r"#(\d+) = ADVANCED_FACE", WHOLE)
    assert found and face
    sheet = f"#90001 = OPEN_SHELL('',(#{face[1]}));\n#90002 = SHELL_BASED_SURFACE_MODEL('a;b',(#90001));\n"
    line = f"#{found[1]} = SHAPE_REPRESENTATION('a;b #5',({found[2]},#90002),{found[3]});"
    text = WHOLE.replace(found[0], line)
    end = text.rindex("ENDSEC;")
    file = tmp_path / "sheet.step"
    file.write_text(text[:end] + sheet + text[end:])
    with pytest.warns(UserWarning, match="open surfaces of 'ground' bound no solid: left out"):
        parts, _ = read_step(file)
    assert [part.name for part in parts] == ["ground", "crank", "coupler", "rocker"]
