"""The XML of Simscape Multibody: placements and joints in metres, and nothing dropped in silence."""

from pathlib import Path

import numpy as np
import pytest

from jaxkin.io.simscape import read_export

FRAME = "<Transform><Rotation>1 0 0 0 1 0 0 0 1</Rotation><Translation>{}</Translation></Transform>"
TURNED = "<Transform><Rotation>0 -1 0 1 0 0 0 0 1</Rotation><Translation>{}</Translation></Transform>"


def instance(uid: str, of: str, at: str, inside: str = "", **more: str) -> str:
    said = "".join(f' {name}="{value}"' for name, value in more.items())
    return f'<Instance entityUid="{of}" name="{uid}" uid="{uid}"{said}>{at}{inside}</Instance>'


def side(tag: str, *path: str, at: str = "0 0 0") -> str:
    uids = "".join(f"<Uid>{uid}</Uid>" for uid in path)
    return f"<{tag}><InstancePath>{uids}</InstancePath>{FRAME.format(at)}</{tag}>"


def written(
    folder: Path,
    tree: str,
    joints: str = "",
    assemblies: str = "",
    unit: str = "meter",
    weighs: str = "<Mass>2</Mass>",
) -> Path:
    path = folder / "arm.xml"
    part = f'<Part name="p" uid="P"><MassProperties>{weighs}</MassProperties><GeometryFile name="p.step"/></Part>'
    path.write_text(
        f'<SimscapeMultibodyImportXML xmlns="urn:x"><DataUnits length="{unit}" mass="gram"/><RootAssembly name="arm">'
        f"<InstanceTree>{tree}</InstanceTree><Constraints/><Joints>{joints}</Joints></RootAssembly>"
        f"<Assemblies>{assemblies}</Assemblies><Parts>{part}</Parts></SimscapeMultibodyImportXML>"
    )
    return path


def test_placements_are_composed_through_assemblies_and_units(tmp_path: Path) -> None:
    inner = instance("b", "P", FRAME.format("1 0 0"))
    tree = instance("a", "A", TURNED.format("0 0 10"), inner, grounded="true")
    export = read_export(written(tmp_path, tree, assemblies='<Assembly uid="A"/>', unit="inch"))
    (part,) = export.parts
    assert (part.name, part.path, part.file, part.fixed_in) == ("a/b", ("a", "b"), "p.step", ())
    assert part.inertial is None  # the centre is not said
    np.testing.assert_allclose(part.transform[:3, 3], np.array([0, 1, 10]) * 0.0254, atol=1e-15)


def test_masses_are_in_kilograms_and_metres(tmp_path: Path) -> None:
    weighs = "<Mass>{}</Mass><CenterOfMass>1 2 3</CenterOfMass><Inertia>7 8 9 1 2 3</Inertia>"
    tree = instance("a", "P", FRAME.format("0 0 0"))
    own = read_export(written(tmp_path, tree, unit="inch", weighs=weighs.format(2))).parts[0].inertial
    assert own is not None and own.mass == pytest.approx(0.002)
    np.testing.assert_allclose(own.centre, 0.0254 * np.array([1, 2, 3]))
    np.testing.assert_allclose(own.inertia, 0.001 * 0.0254**2 * np.array([[7, 3, 2], [3, 8, 1], [2, 1, 9]]))
    export = read_export(written(tmp_path, tree, weighs=weighs.format(-2)))
    assert export.parts[0].inertial is None and "a: expected a mass from 0 on, got -2" in export.notes[0]


def test_joints_of_an_assembly_are_found_at_each_of_its_places(tmp_path: Path) -> None:
    inner = instance("b", "P", FRAME.format("0 0 0")) + instance("c", "P", FRAME.format("0 0 0"))
    tree = "".join(instance(uid, "A", FRAME.format(at), inner) for uid, at in (("one", "0 0 0"), ("two", "5 0 0")))
    joint = f'<Revolute name="hinge">{side("BaseFrame", "b", at="1 0 0")}{side("FollowerFrame", "c")}</Revolute>'
    export = read_export(written(tmp_path, tree, assemblies=f'<Assembly uid="A"><Joints>{joint}</Joints></Assembly>'))
    assert [(joint.kind, joint.name) for joint in export.joints] == [("Revolute", "hinge")] * 2
    assert [joint.sides[0].frame[0, 3] for joint in export.joints] == [1, 6]
    assert export.joints[1].sides[1].path == ("two", "c")


def test_members_of_rigid_groups_and_of_rigid_assemblies_are_one_body(tmp_path: Path) -> None:
    b, c = (instance(uid, "P", FRAME.format("0 0 0"), rigidGroup="root-1") for uid in "bc")
    d, e = (instance(uid, "P", FRAME.format("0 0 0"), rigidGroup="a-1") for uid in "de")
    inside = instance("a", "A", FRAME.format("0 0 0"), d + e, rigid="true")
    alone = instance("f", "P", FRAME.format("0 0 0"))
    export = read_export(written(tmp_path, b + c + inside + alone, assemblies='<Assembly uid="A"/>'))
    assert [part.body for part in export.parts] == [("group root-1",)] * 2 + [("a",)] * 2 + [None]


def test_mates_are_placed_with_their_instance(tmp_path: Path) -> None:
    tree = instance("b", "P", TURNED.format("1 0 0")) + instance("c", "P", FRAME.format("0 0 0"))

    def geometry(uid: str) -> str:
        path = f"<InstancePath><Uid>{uid}</Uid></InstancePath>"
        place = "<Position>2 0 0</Position><Axis>2 0 0</Axis>"
        return f'<ConstraintGeometry geomType="line">{path}{place}</ConstraintGeometry>'

    mate = f'<Concentric name="pin">{geometry("b")}{geometry("c")}</Concentric>'
    (found,) = read_export(written(tmp_path, tree, mate)).mates
    np.testing.assert_allclose(found.sides[0].point, [1, 2, 0])
    np.testing.assert_allclose(found.sides[0].axis, [0, 1, 0])
    np.testing.assert_allclose(found.sides[1].axis, [1, 0, 0])


def test_what_is_not_understood_is_named(tmp_path: Path) -> None:
    tree = instance("b", "P", FRAME.format("0 0 0")) + instance("lost", "Q", FRAME.format("0 0 0"))
    joint = f'<UnknownConstraint name="odd">{side("BaseFrame", "b")}</UnknownConstraint>'
    export = read_export(written(tmp_path, tree, joint))
    assert not export.joints
    assert any("lost" in note for note in export.notes)
    assert any("UnknownConstraint 'odd'" in note for note in export.notes)


BOMB = '<!DOCTYPE x [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><x>&b;</x>'


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (BOMB, "DOCTYPE"),
        ("<x><y></x>", "damaged"),
        ("", "damaged"),
        ("<x/>", "got <x>"),
        ("<x>" * 300 + "</x>" * 300, "nested"),
    ],
)
def test_other_files_are_refused_in_one_line(tmp_path: Path, text: str, said: str) -> None:
    path = tmp_path / "bad.xml"
    path.write_text(text)
    with pytest.raises(ValueError, match=said) as raised:
        read_export(path)
    assert "\n" not in str(raised.value)
    assert "bad.xml" in str(raised.value)


@pytest.mark.parametrize(
    ("at", "unit"), [("nan 0 0", "meter"), ("1 2", "meter"), ("0 1e200 0", "meter"), ("0 0 0", "cubit")]
)
def test_numbers_and_units_that_cannot_be_are_refused(tmp_path: Path, at: str, unit: str) -> None:
    with pytest.raises(ValueError, match=r"arm\.xml"):
        read_export(written(tmp_path, instance("b", "P", FRAME.format(at)), unit=unit))


@pytest.mark.parametrize("rotation", ["1 0 0 0 1 0 0 0 -1", "2 0 0 0 2 0 0 0 2", "1 0 0 0 1 0 0 1 0"])
def test_mirrored_and_scaled_instances_are_refused_by_name(tmp_path: Path, rotation: str) -> None:
    place = f"<Transform><Rotation>{rotation}</Rotation><Translation>0 0 0</Translation></Transform>"
    with pytest.raises(ValueError, match=r"arm\.xml: 'b': expected a rotation"):
        read_export(written(tmp_path, instance("b", "P", place)))


def with_units(folder: Path, units: str) -> Path:
    weighs = "<Mass>3</Mass><CenterOfMass>1 0 0</CenterOfMass><Inertia>1 1 1 0 0 0</Inertia>"
    path = written(folder, instance("b", "P", FRAME.format("80 0 0")), weighs=weighs)
    path.write_text(path.read_text().replace('<DataUnits length="meter" mass="gram"/>', units))
    return path


@pytest.mark.parametrize(
    ("units", "metres", "kilograms"),
    [
        ('<ModelUnits mass="kg" length="mm"/>', 0.08, 3.0),
        ('<ModelUnits mass="kg" length="mm"/><DataUnits mass="gram" length="meter"/>', 80.0, 0.003),
        ('<DataUnits mass="Pound" length="Inch"/>', 80 * 0.0254, 3 * 0.45359237),
        ('<DataUnits mass="kilograms" length="Millimetres"/>', 0.08, 3.0),
        ("", 80.0, 3.0),
    ],
)
def test_numbers_are_in_the_units_of_the_models_where_the_file_has_no_others(
    tmp_path: Path, units: str, metres: float, kilograms: float
) -> None:
    (part,) = read_export(with_units(tmp_path, units)).parts
    assert part.transform[0, 3] == pytest.approx(metres)
    assert part.inertial is not None and part.inertial.mass == pytest.approx(kilograms)


def test_an_unknown_unit_of_mass_costs_the_masses_only(tmp_path: Path) -> None:
    export = read_export(with_units(tmp_path, '<DataUnits mass="stone" length="mm"/>'))
    assert export.parts[0].inertial is None
    assert export.notes == ("unit of mass 'stone' is not known, and masses are not taken",)


def test_rotations_of_six_digits_are_made_rotations(tmp_path: Path) -> None:
    rounded = "0.260734 0.938210 0.227551 0.724896 -0.034590 -0.687989 -0.637608 0.344333 -0.689124"
    place = f"<Transform><Rotation>{rounded}</Rotation><Translation>0 0 0</Translation></Transform>"
    export = read_export(written(tmp_path, instance("b", "P", place)))
    rotation = export.parts[0].transform[:3, :3]
    np.testing.assert_allclose(rotation @ rotation.T, np.eye(3), atol=1e-15)
    np.testing.assert_allclose(rotation.ravel(), np.array(rounded.split(), float), atol=2e-6)  # six digits
    assert 1e-7 < export.rounding < 1e-5


def test_what_is_on_an_assembly_itself_is_on_it_by_its_own_identifier(tmp_path: Path) -> None:
    tree = instance("s", "A", FRAME.format("0 0 0"), instance("b", "P", FRAME.format("0 0 0")))
    joint = f'<Revolute name="hinge">{side("BaseFrame", "A")}{side("FollowerFrame", "b")}</Revolute>'
    export = read_export(written(tmp_path, tree, assemblies=f'<Assembly uid="A"><Joints>{joint}</Joints></Assembly>'))
    assert [each.path for each in export.joints[0].sides] == [("s",), ("s", "b")]


def test_the_first_version_of_the_format_is_read_and_the_first_generation_is_refused_with_a_remedy(
    tmp_path: Path,
) -> None:
    """SimMechanics Link wrote version 1.0 from 2013 on; it has another name of the outermost element."""
    path = written(tmp_path, instance("b", "P", FRAME.format("1 2 3"), grounded="true"))
    text = path.read_text().replace("urn:x", "urn:mathworks:simmechanics:import")
    path.write_text(text.replace("SimscapeMultibodyImportXML", "SimMechanicsImportXML"))
    (part,) = read_export(path).parts
    np.testing.assert_array_equal(part.transform[:3, 3], (1, 2, 3))
    path.write_text("<PhysicalModelingXMLFile><name>b</name></PhysicalModelingXMLFile>")
    with pytest.raises(ValueError, match=r"got <PhysicalModelingXMLFile>, the first generation .*, or as STEP"):
        read_export(path)


def test_identifiers_may_stand_between_spaces_and_comments(tmp_path: Path) -> None:
    tree = instance("s", "A", FRAME.format("0 0 0"), instance("b", "P", FRAME.format("0 0 0")))
    joint = f'<Revolute name="hinge">{side("BaseFrame")}{side("FollowerFrame", "s", "b")}</Revolute>'
    path = written(tmp_path, tree, joint, '<Assembly uid="A"/>')
    path.write_text(path.read_text().replace("<Uid>", "<Uid>\n  <!-- of a part -->").replace("</Uid>", "\n</Uid>"))
    (found,) = read_export(path).joints
    assert [each.path for each in found.sides] == [(), ("s", "b")]


def test_mates_of_more_than_two_features_are_told_as_such(tmp_path: Path) -> None:
    tree = instance("b", "P", FRAME.format("0 0 0"))
    feature = '<ConstraintGeometry geomType="plane"><InstancePath><Uid>b</Uid></InstancePath></ConstraintGeometry>'
    export = read_export(written(tmp_path, tree, f'<UnknownConstraint name="Width1">{3 * feature}</UnknownConstraint>'))
    assert export.notes == (
        "UnknownConstraint 'Width1': it is of 3 features, and only relations of two are kept; left out",
    )


def test_rigid_constraints_have_paths_only_and_of_one_instance_fix_it_in_its_assembly(tmp_path: Path) -> None:
    """As Creo writes them; features of the assembly itself have no path."""

    def rigid(*paths: tuple[str, ...]) -> str:
        texts = ("".join(f"<Uid>{uid}</Uid>" for uid in path) for path in paths)
        return f'<Rigid name="r">{"".join(f"<InstancePath>{text}</InstancePath>" for text in texts)}</Rigid>'

    inner = "".join(instance(uid, "P", FRAME.format("0 0 0")) for uid in "bcd")
    tree = instance("s", "A", FRAME.format("1 0 0"), inner) + instance("e", "P", FRAME.format("0 0 0"))
    sub = f'<Assembly uid="A"><Constraints>{rigid(("b",))}</Constraints></Assembly>'
    plane = '<ConstraintGeometry geomType="plane">{}<Position>0 0 0</Position><Axis>0 0 1</Axis></ConstraintGeometry>'
    top = f'<Coincident name="top">{plane.format("")}{plane.format("<InstancePath><Uid>e</Uid></InstancePath>")}'
    held = rigid(("s", "c"), ("e",)) + rigid(("s", "d")) + top + "</Coincident>"
    path = written(tmp_path, tree, held, sub)
    text = path.read_text().replace("<Constraints/><Joints>", "<Constraints>")
    path.write_text(text.replace("</Joints></RootAssembly>", "</Constraints></RootAssembly>"))
    export = read_export(path)
    assert {part.path: part.fixed_in for part in export.parts} == {
        ("s", "b"): ("s",), ("s", "c"): None, ("s", "d"): (), ("e",): None
    }  # fmt: skip
    assert [[side.path for side in mate.sides] for mate in export.mates] == [[("s", "c"), ("e",)], [(), ("e",)]]
    assert export.notes == ()
