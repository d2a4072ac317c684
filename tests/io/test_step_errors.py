"""Files that cannot be read: one clear message each, nothing printed, and the process lives on."""

from __future__ import annotations

import re
import time
from pathlib import Path

import numpy as np
import pytest

from jaxkin.examples import path
from jaxkin.io import step, step_convert
from jaxkin.io.load import load
from jaxkin.io.step import read_step
from jaxkin.io.step_tree import MAX_STEP_PARTS

DATA = Path(__file__).parent / "data"
CAM = path("cam").read_bytes()
RNG = np.random.default_rng(0)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "bad.step is empty"),
        (b" \n", "bad.step is empty"),
        (b"a four-bar linkage\n" * 20, "bad.step is not a STEP file: .*ISO-10303-21"),
        (RNG.bytes(5000), "bad.step is not a STEP file"),
        (b"ISO-10303-21;\n" + RNG.bytes(5000), "bad.step is cut off: .*END-ISO-10303-21"),
        (CAM[: len(CAM) // 2], "bad.step is cut off: .*END-ISO-10303-21"),
        (CAM[:500], "bad.step is cut off"),
        (CAM[: CAM.index(b"DATA;")] + b"DATA;\nENDSEC;\nEND-ISO-10303-21;\n", "bad.step holds no solids"),
        ((DATA / "sheet.step").read_bytes(), "bad.step holds no solids, only surfaces"),
        (
            b"ISO-10303-21;\nDATA;\n#1=DOCUMENT_FILE('arm.stp','','',#2,'','');\nENDSEC;\nEND-ISO-10303-21;\n",
            "bad.step holds no solids: it places those of other files, arm.stp, which are not beside it: put them",
        ),
        # syntax that breaks off in the middle, and a section of data that never ends
        (CAM[: len(CAM) // 2] + b"\nENDSEC;\nEND-ISO-10303-21;\n", "bad.step cannot be read as STEP"),
    ],
)
def test_content_that_is_no_step_file(tmp_path, capfd, content, message):
    file = tmp_path / "bad.step"
    file.write_bytes(content)
    with pytest.raises(ValueError, match=message):
        read_step(file)
    assert capfd.readouterr() == ("", "")
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize("seed", range(3))
def test_damaged_files_do_not_take_the_process_down(tmp_path, capfd, seed):
    """The native reader dies on most of these; on the others it leaves parts out."""
    rng = np.random.default_rng(seed)
    content = bytearray(CAM)
    for place in rng.integers(500, len(content) - 500, 30):
        content[place] = rng.integers(32, 127)
    file = tmp_path / "bad.step"
    file.write_bytes(content)
    with pytest.raises((ValueError, UserWarning), match=r"bad\.step.*export it again"):
        read_step(file)
    assert capfd.readouterr() == ("", "")


def test_missing_files_and_folders(tmp_path):
    with pytest.raises(FileNotFoundError, match=r"nowhere\.step does not exist"):
        load(tmp_path / "nowhere.step")
    folder = tmp_path / "folder.step"
    folder.mkdir()
    with pytest.raises(ValueError, match=r"folder\.step is a folder"):
        load(folder)


@pytest.mark.parametrize("name", ["part.iges", "part.STEPX", "part"])
def test_other_formats_are_refused_by_what_can_be_read(tmp_path, name):
    with pytest.raises(ValueError, match=r"STEP files \(\.step, \.stp\), meshes \(\.stl"):
        load(tmp_path / name)


def test_no_files_are_refused():
    with pytest.raises(ValueError, match="a dict of files by part"):
        load({})


def test_load_gives_an_assembly(tmp_path):
    file = tmp_path / "CAM.STP"
    file.write_bytes(CAM)
    assembly = load(str(file))
    assert [part.name for part in assembly.parts] == ["cam", "follower", "frame"]
    assert assembly.unit == "mm"
    assert assembly.source == "CAM.STP"


FILLET = (DATA / "fillet.step").read_text()
MILLIMETRE = "( LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.) );"


def doubled(levels: int) -> str:
    """A part, as an assembly of two of it, of two of these, and so on: 2^levels of it, all in one place."""

    def number(pattern: str) -> str:
        return re.search(rf"#(\d+) *= *{pattern}", FILLET)[1]

    shape, context = re.search(r"#(\d+) *= *ADVANCED_BREP_SHAPE_REPRESENTATION\([^;]*#(\d+)\);", FILLET).groups()
    described = re.search(rf"SHAPE_DEFINITION_REPRESENTATION\(#(\d+),#{shape}\)", FILLET)[1]
    definition = re.search(rf"#{described} *= *PRODUCT_DEFINITION_SHAPE\('','',#(\d+)\)", FILLET)[1]
    place = number("AXIS2_PLACEMENT_3D")
    first = 1 + max(map(int, re.findall(r"^#(\d+)", FILLET, re.M)))
    lines = []
    for level in range(levels):
        n = first + 16 * level
        lines.append(
            f"#{n} = PRODUCT('level {level}','','',(#{number('PRODUCT_CONTEXT')}));"
            f"#{n + 1} = PRODUCT_DEFINITION_FORMATION('','',#{n});"
            f"#{n + 2} = PRODUCT_DEFINITION('','',#{n + 1},#{number('PRODUCT_DEFINITION_CONTEXT')});"
            f"#{n + 3} = PRODUCT_DEFINITION_SHAPE('','',#{n + 2});"
            f"#{n + 4} = SHAPE_REPRESENTATION('',(#{place}),#{context});"
            f"#{n + 5} = SHAPE_DEFINITION_REPRESENTATION(#{n + 3},#{n + 4});"
        )
        for m in (n + 6, n + 11):
            lines.append(
                f"#{m} = NEXT_ASSEMBLY_USAGE_OCCURRENCE('{m}','one of two','',#{n + 2},#{definition},$);"
                f"#{m + 1} = PRODUCT_DEFINITION_SHAPE('','',#{m});"
                f"#{m + 2} = ITEM_DEFINED_TRANSFORMATION('','',#{place},#{place});"
                f"#{m + 3} = ( REPRESENTATION_RELATIONSHIP('','',#{shape},#{n + 4})"
                f" REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION(#{m + 2}) SHAPE_REPRESENTATION_RELATIONSHIP() );"
                f"#{m + 4} = CONTEXT_DEPENDENT_SHAPE_REPRESENTATION(#{m + 3},#{m + 1});"
            )
        definition, shape = n + 2, n + 4
    return with_lines(FILLET, *lines)


def with_lines(text: str, *lines: str) -> str:
    """The file with some lines more at the end of its data."""
    end = text.rindex("ENDSEC;")
    return text[:end] + "\n".join((*lines, text[end:]))


def with_unit(unit: str, *lines: str) -> str:
    return with_lines(FILLET.replace(MILLIMETRE, unit), *lines)


CONVERTED = "( CONVERSION_BASED_UNIT('X',#90001) LENGTH_UNIT() NAMED_UNIT(*) );"
HOSTILE = {
    "more parts than there are atoms": (doubled(300), f"bad.step holds more than {MAX_STEP_PARTS} parts"),
    "a part of itself": (
        with_lines(FILLET, "#90000 = NEXT_ASSEMBLY_USAGE_OCCURRENCE('','','',#90001,#90001,$);"),
        "bad.step is damaged: an assembly in it is a part of itself",
    ),
    "light years": (
        with_unit(CONVERTED, "#90001 = LENGTH_MEASURE_WITH_UNIT(9.46E15,#90002);", f"#90002 = {MILLIMETRE}"),
        r"bad.step is in the length unit \( CONVERSION_BASED_UNIT\('X'.*: export it in um, mm",
    ),
    "a unit of itself": (
        with_unit(CONVERTED, "#90001 = LENGTH_MEASURE_WITH_UNIT(2.,#90002);", f"#90002 = {CONVERTED}"),
        "bad.step is in the length unit .*: export it in um, mm",
    ),
    "exametres": (with_unit(MILLIMETRE.replace("MILLI", "EXA")), r"bad.step is in the length unit .*\.EXA\."),
    "points": (
        with_unit(CONVERTED, f"#90001 = LENGTH_MEASURE_WITH_UNIT(1{'.' * 200},#90002);", f"#90002 = {MILLIMETRE}"),
        "bad.step is in the length unit",
    ),
    # what takes a pattern that looks ahead the square of its length
    "numbers": (with_unit(CONVERTED, "/* LENGTH_UNIT " + "#1=" * 300_000 + " */"), "bad.step is in the length unit"),
}


@pytest.mark.parametrize("name", HOSTILE)
def test_hostile_files_are_refused_in_one_line_and_at_once(tmp_path, capfd, name):
    content, message = HOSTILE[name]
    file = tmp_path / "bad.step"
    file.write_text(content)
    begin = time.process_time()
    with pytest.raises(ValueError, match=message) as caught:
        load(file)
    assert time.process_time() - begin < 3.0  # a few hundredths, but for the import of what reads
    assert "\n" not in str(caught.value) and len(str(caught.value)) < 500
    assert capfd.readouterr() == ("", "")
    assert list(tmp_path.iterdir()) == [file]


@pytest.mark.parametrize("levels", [1, 5])
def test_a_solid_several_times_in_one_place_is_one_part(tmp_path, levels):
    """Copies that a pattern or a careless paste leaves, 2^levels in one place: named, and left out."""
    file = tmp_path / "twice.step"
    file.write_text(doubled(levels))
    first = r"twice\.step: 'one of two' \(as 'shaft'\)" + f" and {2**levels - 1} more are"  # the shaft is drawn, too
    with pytest.warns(UserWarning, match=f"{first} the same solid in the same place as another part: left out"):
        (part,) = load(file).parts
    assert sum("is the same solid in the same place: left out" in note for note in part.notes) == 2**levels


@pytest.mark.long
def test_a_subassembly_without_a_name_is_called_as_its_product(tmp_path):
    """Nested four deep; readers call an occurrence without a name by its number in the file, which tells nothing."""
    file = tmp_path / "deep.step"
    text = doubled(4)
    nameless = re.sub(
        r"NEXT_ASSEMBLY_USAGE_OCCURRENCE\('(\d+)','one of two'", r"NEXT_ASSEMBLY_USAGE_OCCURRENCE('\1',''", text
    )
    file.write_text(nameless)
    paths = {part.path for part in read_step(file)[0]}
    assert {("level 3", "level 2", "level 1", "level 0"), ("level 3", "level 2#2", "level 1#2", "level 0#2")} < paths
    file.write_text(text)
    assert ("level 3", "one of two", "one of two", "one of two") in {part.path for part in read_step(file)[0]}


def test_a_part_too_far_away_for_single_precision_is_told(tmp_path, monkeypatch):
    """A part of 21 mm, 100 km away: 1e8 mm in single precision are right to 4 mm, as they come from the reader where
    the text does not have the place."""
    file = tmp_path / "far.step"
    place = re.search(r"#(\d+) = CARTESIAN_POINT\('',\(0\.,0\.,0\.\)\);", doubled(1))
    assert place
    moved = doubled(1).replace(place[0], f"#{place[1]} = CARTESIAN_POINT('',(1.E8,0.,0.));")
    file.write_text(moved)
    read_step(file)
    monkeypatch.setattr(step, "FilePlacements", lambda text: None)
    with pytest.warns(UserWarning, match=r"times its size from the origin, so that it is right to 0\.\d+ of its"):
        read_step(file)


@pytest.mark.long
def test_a_file_that_takes_for_ever_is_given_up(tmp_path, capfd, monkeypatch):
    """The kernel follows a thousand million parts; here nothing keeps it from that but the time."""
    monkeypatch.setattr(step, "placed_parts", lambda *_: {})
    file = tmp_path / "bad.step"
    file.write_text(doubled(40))
    begin = time.monotonic()
    with pytest.raises(
        ValueError, match=r"bad\.step \(0\.056 MB\) was not read within 2 seconds of a processor, or 20"
    ):
        read_step(file, seconds=2)
    assert time.monotonic() - begin < 30.0  # the machine may be busy
    assert capfd.readouterr() == ("", "")


@pytest.mark.long
def test_memory_is_bounded(tmp_path, capfd, monkeypatch):
    """Some 250 MB of address space for the program, as much again for the points: a limit between the two."""
    monkeypatch.setattr(step_convert, "STEP_MEMORY", 400 << 20)
    monkeypatch.setattr(step_convert, "MEMORY_PER_BYTE", 0)
    file = tmp_path / "bad.step"
    file.write_text(with_lines(FILLET, *(f"#{100000 + k} = CARTESIAN_POINT('',(0.,0.,0.));" for k in range(600_000))))
    with pytest.raises(ValueError, match=r"bad\.step: .* it is damaged, or asks for more than 0.391 GB of memory"):
        read_step(file)
    assert capfd.readouterr() == ("", "")


def test_a_file_of_a_gigabyte_is_refused_unread(tmp_path):
    file = tmp_path / "bad.step"
    with file.open("wb") as target:
        target.write(CAM)
        target.truncate(10**9)  # a sparse file
    with pytest.raises(ValueError, match=r"bad\.step is 1000 MB, more than 500: export it part by part"):
        read_step(file)


@pytest.mark.long
def test_a_part_that_cuts_itself_is_named_with_the_place(tmp_path):
    """Its faces are known, so it can be used. Here: the same body twice in one part."""
    assert not any("cuts itself" in note for note in load(DATA / "fillet.step").parts[0].notes)
    text = re.sub(r"(ADVANCED_BREP_SHAPE_REPRESENTATION\('',\()", r"\1#90000,", FILLET)
    shell = re.search(r"MANIFOLD_SOLID_BREP\('',#(\d+)\)", FILLET)[1]
    file = tmp_path / "twice.step"
    file.write_text(with_lines(text, f"#90000 = MANIFOLD_SOLID_BREP('',#{shell});"))
    (part,) = load(file).parts
    assert any("it cuts itself, or bodies touch or overlap in it, near" in note for note in part.notes)
