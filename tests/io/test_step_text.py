"""STEP text as other systems than the modelling kernel write it: comments, sections, what is around the file."""

from __future__ import annotations

import gzip
import time
import warnings

import pytest

from jaxkin.examples import path
from jaxkin.io.load import load
from jaxkin.io.step import read_step
from jaxkin.io.step_text import step_text

TEXT = path("fourbar").read_text()
HEADER, DATA = TEXT.split("DATA;")

SAME = {
    "comments that end statements": HEADER + "/* by; 'hand' */DATA;" + DATA.replace(" = ", "/* #1=X(); */ = "),
    "comments before the file": "/* made by; a program */\n" + TEXT,
    "a comment in a name": TEXT.replace("FILE_NAME('fourbar.step'", "FILE_NAME('it''s /* no comment; */'"),
    "a signature": f"{TEXT}SIGNATURE;\n{'QUJDREVGR0g=' * 300}\nENDSEC;\n",
    "padding": TEXT + "\0" * 4096,
    "sections of the third edition": f"{HEADER}ANCHOR;\n<x> = #5;\nENDSEC;\nREFERENCE;\nENDSEC;\nDATA;{DATA}",
    "a section of data with a name": TEXT.replace("DATA;", "DATA('one',('AUTOMOTIVE_DESIGN'));"),
    "two sections of data": TEXT.replace("#2000 =", "ENDSEC;\nDATA ;\n#2000 =", 1),
}


@pytest.mark.parametrize("name", SAME)
def test_what_is_around_the_data_changes_nothing(tmp_path, name):
    """Each was refused, or read with a warning that the file is damaged."""
    plain, _ = read_step(path("fourbar"))
    file = tmp_path / "other.step"
    file.write_bytes(SAME[name].encode("latin-1"))
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        parts, unit = read_step(file)
    assert unit == "mm"
    assert [part.name for part in parts] == [part.name for part in plain]
    for part, same in zip(parts, plain, strict=True):
        assert (part.triangles == same.triangles).all()


def test_a_comment_without_an_end_is_left():
    text = "ISO-10303-21;\n#1=X('');/* without end; END-ISO-10303-21;"
    assert step_text(text.encode(), "a.step") == text


@pytest.mark.parametrize("repeated", ["/*'", "DATA(", "ENDSEC;DATA(", "END-"])
def test_hostile_text_is_read_at_once(repeated):
    """A pattern that looks ahead to the end would take the square of its length: 88 s."""
    text = f"ISO-10303-21;ENDSEC;{repeated * 200_000}END-ISO-10303-21;"
    begin = time.process_time()
    step_text(text.encode(), "a.step")
    assert time.process_time() - begin < 3.0  # some tenths


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"\0" * 4096, r"^bad\.step is empty"),
        (gzip.compress(TEXT.encode()), r"^bad\.step is packed by gzip: unpack it"),
        (b"PK\x03\x04" + bytes(99), r"^bad\.step is packed by zip: unpack it"),
        ((TEXT + TEXT).encode(), r"^bad\.step holds several STEP files, one after the other"),
    ],
)
def test_what_is_no_step_file_or_several(tmp_path, content, message):
    file = tmp_path / "bad.step"
    file.write_bytes(content)
    with pytest.raises(ValueError, match=message):
        read_step(file)


@pytest.mark.parametrize("name", ["a.stpZ", "a.step.gz", "a.zip"])
def test_packed_files_are_refused_by_what_to_do(tmp_path, name):
    (tmp_path / name).write_bytes(gzip.compress(TEXT.encode()))
    with pytest.raises(ValueError, match="load does not unpack files; unpack it"):
        load(tmp_path / name)
