"""Assemblies whose parts are in other STEP files: the four-bar in pieces is the one in one file."""

import re

import numpy as np
import pytest

from jaxkin.examples import path
from jaxkin.io.load import load

TEXT = path("fourbar").read_text()
HEADER, _, REST = TEXT.partition("DATA;")
STATEMENTS = dict(re.findall(r"#(\d+)\s*=\s*([^;]*);", REST))
END = "ENDSEC;\nEND-ISO-10303-21;\n"
NAMES = ("ground", "crank", "coupler", "rocker")


def of_kind(kind):
    return [number for number, body in STATEMENTS.items() if kind in body]


def named(number):
    return re.findall(r"#(\d+)", STATEMENTS[number])


def closure(*numbers, without=()):
    """The statements that some name, and those that these name, with what takes the place of some."""
    own, todo, found = dict(without), [*numbers], {}
    while todo:
        number = todo.pop()
        if number not in found:
            found[number] = own.get(number, STATEMENTS[number])
            todo += re.findall(r"#(\d+)", found[number])
    return "".join(f"#{number}={body};\n" for number, body in found.items())


def shapes():
    """Of each product its name, its shape definition, its definition and its representation."""
    found = {}
    for number in of_kind("SHAPE_DEFINITION_REPRESENTATION("):
        shape, representation = named(number)
        definition = named(shape)[0]
        product = STATEMENTS[named(named(definition)[0])[0]]
        found[re.findall(r"'([^']*)'", product)[0]] = number, definition, representation
    return found


SHAPES = shapes()


def part(name):
    return f"{HEADER}DATA;\n{closure(SHAPES[name][0])}{END}"


def document(number, file, definition, how="itself"):
    """A document that has a product: by its own name, by that of its source, or as a product of its own."""
    first = f"#{number}1=DOCUMENT_TYPE('geometry');"
    reference = f"#{number}9=APPLIED_DOCUMENT_REFERENCE(#{number}2,'',(#{definition}));"
    if how == "itself":
        return f"{first}#{number}2=DOCUMENT_FILE('{file}','','',#{number}1,'',$);{reference}"
    if how == "its source":
        return (
            f"{first}#{number}2=DOCUMENT_FILE('D{number}','a part','',#{number}1,'',$);"
            f"#{number}3=EXTERNAL_SOURCE(IDENTIFIER('C:\\\\parts\\\\{file.upper()}'));#{number}4=IDENTIFICATION_ROLE('',$);"
            f"#{number}5=APPLIED_EXTERNAL_IDENTIFICATION_ASSIGNMENT('',#{number}4,#{number}3,(#{number}2));{reference}"
        )
    product, formation = (STATEMENTS[each] for each in (named(named(definition)[0])[0], named(definition)[0]))
    return (
        f"{first}#{number}2=DOCUMENT('D{number}','a part','',#{number}1);#{number}3={product};"
        f"#{number}4={re.sub(r'#[0-9]+', f'#{number}3', formation)};"
        f"#{number}5=DOCUMENT_FILE('{file}','','',#{number}1,'',$);"
        f"#{number}6=PRODUCT_DEFINITION_WITH_ASSOCIATED_DOCUMENTS('','',#{number}4,#{named(definition)[1]},(#{number}5));"
        f"#{number}7=DOCUMENT_PRODUCT_EQUIVALENCE('equivalence','',#{number}2,#{number}4);{reference}"
    )


def assembly(elsewhere, how="itself"):
    """The four-bar with some of its parts in files of their own."""
    empty, documents = {}, ""
    for count, name in enumerate(elsewhere):
        _, definition, representation = SHAPES[name]
        context = named(representation)[-1]
        empty[representation] = f"SHAPE_REPRESENTATION('',(#{named(representation)[0]}),#{context})"
        documents += document(f"9000{count}", f"{name}.stp", definition, how)
    tops = [*of_kind("CONTEXT_DEPENDENT_SHAPE_REPRESENTATION"), *of_kind("NEXT_ASSEMBLY_USAGE_OCCURRENCE")]
    return f"{HEADER}DATA;\n{closure(*tops, *(each[0] for each in SHAPES.values()), without=empty)}{documents}{END}"


@pytest.mark.parametrize("how", ["itself", "its source", "a product of its own"])
@pytest.mark.parametrize("elsewhere", [NAMES, ("crank", "rocker")])
def test_parts_in_files_beside_it_are_where_the_assembly_places_them(elsewhere, how, tmp_path):
    for name in elsewhere:
        (tmp_path / f"{name}.stp").write_text(part(name))
    (tmp_path / "fourbar.step").write_text(assembly(elsewhere, how))
    found = load(tmp_path / "fourbar.step")
    assert sorted(each.name for each in found.parts) == sorted(NAMES)
    expected = {each.name: each for each in load(path("fourbar")).parts}
    for each in found.parts:
        np.testing.assert_allclose(each.box, expected[each.name].box, atol=1e-9)
        assert len(each.faces) == len(expected[each.name].faces)
    if elsewhere == NAMES:
        assert found.mechanism(fixed=["ground"]).mobility().freedoms == 1


def test_files_may_have_their_parts_in_files(tmp_path):
    """A product that is an assembly in its file; the files have the same numbers for their statements."""
    (tmp_path / "inner.stp").write_text(assembly(("crank",)))
    (tmp_path / "crank.stp").write_text(part("crank"))
    (tmp_path / "outer.step").write_text(assembly(("rocker",)).replace("rocker.stp", "inner.stp"))
    found = load(tmp_path / "outer.step")
    assert len(found.parts) == 3 + 4
    drawn = load(path("fourbar"))
    ground = next(each for each in found.parts if each.name == "ground#2")
    np.testing.assert_allclose(ground.box, next(each for each in drawn.parts if each.name == "ground").box, atol=1e-9)


def test_units_are_those_of_each_file(tmp_path):
    inches = part("crank").replace("SI_UNIT(.MILLI.,.METRE.)", "SI_UNIT(.CENTI.,.METRE.)")
    assert inches != part("crank")
    (tmp_path / "crank.stp").write_text(inches)
    (tmp_path / "fourbar.step").write_text(assembly(("crank",)))
    found = load(tmp_path / "fourbar.step")
    sizes = [np.ptp(next(e for e in a.parts if e.name == "crank").box, axis=0) for a in (found, load(path("fourbar")))]
    np.testing.assert_allclose(sizes[0], 10 * sizes[1], rtol=1e-6)


def test_a_file_that_is_not_there_is_named_alone(tmp_path):
    (tmp_path / "crank.stp").write_text(part("crank"))
    (tmp_path / "fourbar.step").write_text(assembly(("crank", "rocker")))
    with pytest.warns(
        UserWarning, match=r"places 'rocker' without a solid, .* files that are not beside it, rocker.stp:"
    ):
        assert len(load(tmp_path / "fourbar.step").parts) == 3


def test_files_in_a_circle_and_of_several_products_are_refused(tmp_path):
    (tmp_path / "fourbar.step").write_text(assembly(("crank",)))
    (tmp_path / "crank.stp").write_text(assembly(("rocker",)).replace("rocker.stp", "fourbar.step"))
    with pytest.raises(ValueError, match=r"crank.stp is damaged: it has its parts in fourbar.step"):
        load(tmp_path / "fourbar.step")
    both = closure(SHAPES["crank"][0], SHAPES["rocker"][0])
    (tmp_path / "crank.stp").write_text(f"{HEADER}DATA;\n{both}{END}")
    with pytest.raises(ValueError, match=r"crank.stp, which holds 2 products side by side: export that part as one"):
        load(tmp_path / "fourbar.step")
