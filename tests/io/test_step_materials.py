"""Materials of STEP files: their densities are those of the parts where the user gives none."""

import re

import numpy as np
import pytest

import jaxkin as jk
from jaxkin.examples import path

TEXT = path("fourbar").read_text()
PRODUCTS = dict(
    (name, definition)
    for definition, formation in re.findall(r"#(\d+) = PRODUCT_DEFINITION\('[^']*','[^']*',#(\d+)", TEXT)
    for product in re.findall(rf"#{formation} = PRODUCT_DEFINITION_FORMATION\w*\('[^']*','[^']*',#(\d+)", TEXT)
    for name in re.findall(rf"#{product} = PRODUCT\('([^']*)'", TEXT)
)
CONTEXT = re.findall(r"ADVANCED_BREP_SHAPE_REPRESENTATION\([^;]*,#(\d+)\);", TEXT)[0]
GRAM, KILOGRAM = "$,.GRAM.", ".KILO.,.GRAM."
CENTIMETRE, METRE = ".CENTI.,.METRE.", "$,.METRE."
CUBIC, KERNEL = ("1.", "-3."), ("3.", "2.")
"""Powers of mass and length in a unit of density, and as a common kernel writes them."""


def material(number, part, value, mass=GRAM, length=CENTIMETRE, powers=CUBIC, name="Steel"):
    return (
        f"#{number}0=PROPERTY_DEFINITION('material property','material name',#{PRODUCTS[part]});"
        f"#{number}1=PROPERTY_DEFINITION_REPRESENTATION(#{number}0,#{number}2);"
        f"#{number}2=REPRESENTATION('material name',(#{number}3),#{CONTEXT});"
        f"#{number}3=DESCRIPTIVE_REPRESENTATION_ITEM('{name}','');"
        f"#{number}4=PROPERTY_DEFINITION('material property','density',#{PRODUCTS[part]});"
        f"#{number}5=PROPERTY_DEFINITION_REPRESENTATION(#{number}4,#{number}6);"
        f"#{number}6=REPRESENTATION('density',(#{number}7),#{CONTEXT});"
        f"#{number}7=MEASURE_REPRESENTATION_ITEM('density measure',\n  POSITIVE_RATIO_MEASURE({value}),#{number}8);"
        f"#{number}8=DERIVED_UNIT((#{number}9,#{number}91));"
        f"#{number}9=DERIVED_UNIT_ELEMENT(#{number}92,{powers[0]});#{number}91=DERIVED_UNIT_ELEMENT(#{number}93,{powers[1]});"
        f"#{number}92=(MASS_UNIT() NAMED_UNIT(*) SI_UNIT({mass}));"
        f"#{number}93=(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT({length}));"
    )


def loaded(folder, *lines, text=TEXT):
    file = folder / "made.step"
    file.write_text(text.replace("ENDSEC;\nEND-ISO", "".join(lines) + "\nENDSEC;\nEND-ISO"))
    return jk.load(file)


@pytest.mark.parametrize(
    ("value", "units"),
    [
        ("7.85", (GRAM, CENTIMETRE, CUBIC)),
        ("7.85", (GRAM, CENTIMETRE, KERNEL)),
        ("7.85E3", (KILOGRAM, METRE, CUBIC)),
        ("7.85E-3", (GRAM, ".MILLI.,.METRE.", CUBIC)),
    ],
)
def test_a_density_is_that_of_the_part_in_any_unit(tmp_path, value, units):
    assembly = loaded(tmp_path, material(9000, "crank", value, *units))
    densities = {part.name: part.density for part in assembly.parts}
    assert densities == {"ground": None, "crank": pytest.approx(7850), "coupler": None, "rocker": None}
    mechanism = assembly.mechanism(fixed=["ground"])
    assert any(note.startswith("crank: its file says the density 7850 kg/m^3 of 'Steel'") for note in mechanism.notes)


def test_masses_take_it_where_they_are_given_no_other(tmp_path):
    lines = [material(9000 + k, part, "2.7") for k, part in enumerate(("crank", "coupler", "rocker"))]
    mechanism = loaded(tmp_path, *lines).mechanism(fixed=["ground"])
    expected = jk.masses(mechanism, 2700)
    found = jk.masses(mechanism)
    np.testing.assert_allclose(found.mass, expected.mass, rtol=1e-9)
    np.testing.assert_allclose(found.inertia, expected.inertia, rtol=1e-9)
    for given in (1000, {"*": 1000}, {"crank": 1000, "coupler": 1000, "rocker": 1000}):
        np.testing.assert_allclose(jk.masses(mechanism, given).mass, expected.mass / 2.7, rtol=1e-9)
    partly = jk.masses(mechanism, {"crank": 1000})
    np.testing.assert_allclose(partly.mass / expected.mass.clip(1e-9), [0, 1 / 2.7, 1, 1], rtol=1e-9)
    bare = loaded(tmp_path, lines[0]).mechanism(fixed=["ground"])
    with pytest.raises(ValueError, match="no density of 'coupler', 'rocker'"):
        jk.masses(bare)


def test_what_is_not_sure_is_not_taken(tmp_path):
    """A number in another unit than it says, a unit of something else, and two products of one name."""
    for doubtful in (
        material(9000, "crank", "7850."),
        material(9000, "crank", "7.85", powers=("1.", "-2.")),
        material(9000, "crank", "0."),
    ):
        assert all(part.density is None for part in loaded(tmp_path, doubtful).parts)
    twice = TEXT.replace("PRODUCT('rocker','rocker'", "PRODUCT('crank','crank'")
    assert twice != TEXT
    assert all(part.density is None for part in loaded(tmp_path, material(9000, "crank", "7.85"), text=twice).parts)
