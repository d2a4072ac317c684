"""Parts of quite another size than all others are told, with what to do: they were often drawn in another unit."""

from dataclasses import replace

import pytest

import jaxkin as jk
from jaxkin.geometry.part import scaled
from jaxkin.io.odd_sizes import with_odd_sizes_noted
from reference.round_parts import block, part


def cubes(*sizes):
    return tuple(part(f"cube {k}", block((0, 0, 0), (size, size, size))) for k, size in enumerate(sizes))


def noted(parts):
    return {each.name: each.notes for each in with_odd_sizes_noted(parts) if each.notes}


@pytest.mark.parametrize("unit", [1e-3, 1.0, 25.4])
def test_a_part_a_thousand_times_too_large_is_told_in_any_unit(unit):
    found = noted(tuple(scaled(each, unit) for each in cubes(10, 12, 11000, 14)))
    assert list(found) == ["cube 2"]
    # 11000 over 14, the largest of the others, in four digits
    assert "785.7 times as large as 'cube 3'" in found["cube 2"][0]


def test_a_part_a_thousand_times_too_small_is_told():
    found = noted(cubes(10, 0.012, 11, 14))
    assert list(found) == ["cube 1"]
    # 10, the smallest of the others, over 0.012
    assert "833.3 times smaller than 'cube 0'" in found["cube 1"][0]


def test_of_many_the_fewer_are_told():
    assert list(noted(cubes(1, 2000, 2, 3000, 3))) == ["cube 1", "cube 3"]
    assert list(noted(cubes(1000, 2, 2000, 1, 3000))) == ["cube 1", "cube 3"]


def test_parts_of_every_size_between_are_no_sign():
    """A screw of 5 mm in a bed of 20 m, with all that a machine has between."""
    assert not noted(cubes(5, 200, 8000, 20000, 60))
    assert not noted(cubes(7)) and not noted(())


def test_the_advice_works_for_files(tmp_path):
    """As it is written, the wheel is told; in the unit of the other file, it is not."""
    for name, size in (("frame", 40.0), ("wheel", 0.03)):
        # an ASCII file of a cube: its triangles are all that is read
        lines = [f"solid {name}"]
        for corners in part(name, block((0, 0, 0), (size, size, size))).triangles:
            lines += ["facet normal 0 0 0", "outer loop", *("vertex {} {} {}".format(*corner) for corner in corners)]
            lines += ["endloop", "endfacet"]
        (tmp_path / f"{name}.stl").write_text("\n".join([*lines, f"endsolid {name}"]))
    files = {name: tmp_path / f"{name}.stl" for name in ("frame", "wheel")}
    wrong = jk.load(files, unit="mm")
    assert "if it was drawn in another unit, export it in theirs" in str(wrong)
    right = (scaled(replace(each, notes=()), 1000.0 if each.name == "wheel" else 1.0) for each in wrong.parts)
    assert not noted(tuple(right))
