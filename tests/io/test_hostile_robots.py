"""Robot files that somebody or something spoiled: one clear line each, or a robot of finite numbers and clean names."""

import io
import random
import re
import warnings
import zipfile
from pathlib import Path

import numpy as np
import pytest

import jaxkin as jk
from reference.freecad import slider_crank
from reference.mechanisms import planar_fourbar
from reference.tied import press

SDF = """<sdf version="1.7"><model name="m"><pose>0 0 1 0 0 0</pose><link name="AB"/><link name="BC">
<pose>0 0 0.4 0 0.3 0</pose><inertial><mass>2</mass></inertial></link><frame name="D"><pose>0.5 0 0 0 0 0</pose></frame>
<joint name="A" type="revolute"><parent>world</parent><child>AB</child><axis><xyz>0 1 0</xyz><limit><lower>-1</lower>
<upper>2</upper></limit></axis></joint><joint name="B" type="ball"><pose relative_to="D">0 0 0.5 0 0 0</pose>
<parent>AB</parent><child>BC</child></joint></model></sdf>"""

FORMATS = (".urdf", ".yaml", ".xml", ".sdf", ".asmt", ".FCStd", ".json")
OWN = (".json",)
"""Files that jaxkin itself wrote: their names are whatever their user called things."""


@pytest.fixture(scope="module")
def whole(tmp_path_factory):
    """A sound file of each format; of FreeCAD, the list of objects in it."""
    folder = tmp_path_factory.mktemp("sound")
    mechanism = planar_fourbar()
    given = {part: jk.Mass(1.0, (1, 2, 3), 1e-3) for part in mechanism.parts if part not in mechanism.fixed}
    jk.write_urdf(mechanism, folder / "m.urdf", masses=jk.masses(mechanism, given=given))
    jk.write_mjcf(press(), folder / "m.xml")
    jk.write_asmt(press(), folder / "m.asmt")
    press().save(folder / "m.json")
    (folder / "m.sdf").write_text(SDF)
    texts = {suffix: (folder / f"m{suffix}").read_bytes() for suffix in FORMATS if suffix != ".FCStd"}
    with zipfile.ZipFile(slider_crank(folder)[0]) as document:
        return texts | {".FCStd": document.read("Document.xml")}


def received(folder: Path, whole: dict[str, bytes], suffix: str, data: bytes) -> str:
    """What is wrong with how a file is received; "" where nothing is."""
    file, loops = folder / f"bad{suffix}", None
    if suffix == ".FCStd" and not data.startswith(b"PK"):
        with io.BytesIO() as packed:
            with zipfile.ZipFile(packed, "w") as document:
                document.writestr("Document.xml", data)
            data = packed.getvalue()
    file.write_bytes(data)
    if suffix in (".urdf", ".yaml"):
        file, loops = folder / "bad.urdf", folder / "bad.yaml"
        (loops if suffix == ".urdf" else file).write_bytes(whole[".yaml" if suffix == ".urdf" else ".urdf"])
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        try:
            mechanism = jk.load(file, loops=loops).mechanism()
        except (ValueError, OSError) as error:
            text = str(error)
            good = "\n" not in text and len(text) < 1000 and (file.name in text or (loops and loops.name in text))
            return "" if good else f"{type(error).__name__}: {text[:300]}"
    return "; ".join(_unsound(mechanism, suffix))


def _unsound(mechanism: jk.Mechanism, suffix: str):
    """Yield what is no number, and what no name."""
    for joint in mechanism.all_joints:
        for numbers in (joint.frames_1, joint.frames_2, joint.pitch):
            if not np.isfinite(np.asarray(numbers, float)).all():
                yield f"{joint.name} has {numbers}"
        if np.isnan(np.asarray(joint.limits, float)).any():
            yield f"{joint.name} has limits {joint.limits}"
    for part in mechanism.solids:
        if not np.isfinite(part.triangles).all():
            yield f"{part.name} has corners that are no numbers"
        own = part.inertial
        if own and not np.isfinite([own.mass, *own.centre, *own.inertia.flat]).all():
            yield f"{part.name} weighs {own}"
    if suffix not in OWN:
        for name in (*mechanism.parts, *(joint.name for joint in mechanism.all_joints)):
            if not name.isprintable() or len(name) > 200:
                yield f"the name {name[:50]!r} of {len(name)} letters"


@pytest.mark.parametrize("suffix", FORMATS)
def test_a_file_that_ends_too_soon(whole, tmp_path, suffix):
    text = whole[suffix]
    rows = random.Random(0)
    for end in (rows.randrange(len(text)) for _ in range(8)):
        assert not (wrong := received(tmp_path, whole, suffix, text[:end])), f"{end}: {wrong}"


NUMBER = re.compile(rb"(?<![\w.#])-?\d+\.?\d*(?:e-?\d+)?(?![\w.])")


@pytest.mark.parametrize("suffix", FORMATS)
def test_what_is_no_number_in_the_place_of_one(whole, tmp_path, suffix):
    text = whole[suffix]
    rows = random.Random(1)
    places = [match.span() for match in NUMBER.finditer(text)]
    for bad in (b"nan", b"-inf", b"Infinity", b"1e999", b"1e300", b"x", b""):
        for begin, end in rows.sample(places, min(len(places), 5)):
            where = text[max(0, begin - 40) : end + 10]
            spoiled = text[:begin] + bad + text[end:]
            assert not (wrong := received(tmp_path, whole, suffix, spoiled)), f"{bad} in {where}: {wrong}"


NAMES = (
    re.compile(rb'(?:name|joint|link|Name)="([^"]+)"'),
    re.compile(rb"['\"]([A-Za-z]+[A-Za-z0-9 ]*)['\"]"),
    re.compile(rb"\n\t+([A-Za-z]+)\n"),
)


@pytest.mark.parametrize("suffix", FORMATS)
def test_names_that_nobody_can_read(whole, tmp_path, suffix):
    """Of one element, and wherever the name stands."""
    text = whole[suffix]
    rows = random.Random(2)
    places = next(found for form in NAMES if (found := [match.span(1) for match in form.finditer(text)]))
    for new in (b"a\tb", b"&#10;x", b"\x07", b"\xe2\x80\xae evil", b"n" * 100_000, b"", b"\xff\xfe", b"a\x00b"):
        for begin, end in rows.sample(places, 1):
            old = text[begin:end]
            once = text[:begin] + new + text[end:]
            for spoiled in (once, text.replace(b'"' + old + b'"', b'"' + new + b'"')):
                assert not (wrong := received(tmp_path, whole, suffix, spoiled)), f"{new[:9]} for {old}: {wrong}"


SIZE = 10_000_000
GARBAGE = {
    "nothing": b"",
    "blanks": b" \n ",
    "zeros": bytes(SIZE),
    "noise": random.Random(3).randbytes(SIZE),
    "one letter": b"a" * SIZE,
    "lines": b"a: b\n" * (SIZE // 5),
    "open elements": b"<a>" * (SIZE // 3),
    "open brackets": b"[" * SIZE,
    "open braces": b'{"a":' * (SIZE // 5),
    "numbers": b"1 " * (SIZE // 2),
    "attributes": b"<robot " + b" ".join(b'a%d="1"' % k for k in range(SIZE // 15)) + b"/>",
    "text": b"<mujoco>" + b"x" * SIZE + b"</mujoco>",
    "an empty robot": b'<robot name="x"/>',
    "an empty model": b"<mujoco/>",
    "an empty world": b"<sdf/>",
    "entities": b'<!DOCTYPE r [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><robot name="&b;"/>',
}


@pytest.mark.parametrize(
    "what", [pytest.param(what, marks=pytest.mark.long) if len(GARBAGE[what]) > 1000 else what for what in GARBAGE]
)
@pytest.mark.parametrize("suffix", FORMATS)
def test_garbage(whole, tmp_path, suffix, what):
    if len(GARBAGE[what]) > 1000 and suffix == ".FCStd":
        assert not received(tmp_path, whole, suffix, b"PK" + GARBAGE[what])
    assert not received(tmp_path, whole, suffix, GARBAGE[what])
