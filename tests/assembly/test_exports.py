"""Exports of CAD systems: joints, mates and rigid groups make the mechanism, and what they leave out is said."""

import json
import lzma
from pathlib import Path

import numpy as np
import pytest
import trimesh

import jaxkin as jk
from jaxkin import examples
from jaxkin.geometry.units import METRES
from jaxkin.joints.evidence import EvidenceKind
from reference.archives import unpack
from reference.exported import FRAME, Z, instance, joint, load, mate

DATA = Path(__file__).with_name("data")


@pytest.fixture(scope="module")
def lift_table(tmp_path_factory):
    """The export of a lift table, 14 parts (MathWorks, licence beside the data), without the files of its solids."""
    folder = tmp_path_factory.mktemp("lift table")
    unpack(DATA / "lift_table_export.tar.xz", folder, "LiftTable.xml")
    with pytest.warns(UserWarning, match="drawn as small boxes"):
        return jk.load(folder / "LiftTable.xml")


@pytest.fixture(scope="module")
def lift_table_of_solids(tmp_path_factory):
    """The same with its solids, a STEP file a part."""
    folder = tmp_path_factory.mktemp("lift table of solids")
    unpack(DATA / "lift_table_export.tar.xz", folder)
    return jk.load(folder / "LiftTable.xml")


@pytest.fixture(scope="module")
def aileron(tmp_path_factory):
    """The export of an aileron with three actuators, 175 parts, without the files of its solids."""
    file = tmp_path_factory.mktemp("aileron") / "aileron.xml"
    file.write_bytes(lzma.decompress((DATA / "aileron.xml.xz").read_bytes()))
    with pytest.warns(UserWarning, match=r"no solids for 'MountBrackets <1>.* and 172 more: drawn as small boxes"):
        return jk.load(file)


@pytest.mark.parametrize("words", [{"combine": False}, {"clearance": 0.5}])
def test_words_about_contacts_are_refused_where_the_export_says_the_joints(lift_table, words):
    with pytest.raises(ValueError, match=rf"LiftTable.xml: {next(iter(words))}.* is about contacts, .*infer=False"):
        lift_table.mechanism(**words)


def test_all_joints_of_the_export_are_there_without_a_word(lift_table):
    mechanism = lift_table.mechanism()
    truth = json.loads((DATA / "lift_table.joints.json").read_text())
    moving = {each["name"]: each for each in truth["joints"] if each["type"] != "Weld"}
    found = {each.name: each for each in mechanism.all_joints if each.freedoms}
    assert found.keys() == moving.keys()
    for name, made in found.items():
        side = moving[name]["a"]
        np.testing.assert_allclose(made.frames_1[0, :3, 2], side["axis"], atol=1e-8)  # nine digits
        np.testing.assert_allclose(made.frames_1[0, :3, 3], side["point"], atol=1e-8)
        assert made.evidence.kind == EvidenceKind.EXPORT
    assert mechanism.mobility().freedoms == 1


@pytest.mark.long
def test_its_platform_stays_level(lift_table):
    motion = lift_table.mechanism().sweep({"PrismaticCylinderPiston": np.linspace(-0.05, 0.1, 31)})
    assert np.all(motion.closed)
    # two equal parallel links: the platform keeps its orientation
    platform = np.array(motion.transforms["Platform <1>"])
    np.testing.assert_allclose(platform[:, :3, :3], np.broadcast_to(np.eye(3), (31, 3, 3)), atol=1e-8)


@pytest.mark.long
def test_the_solids_of_the_export_stand_where_its_step_file_has_them(lift_table_of_solids, tmp_path):
    file = tmp_path / "lift_table.step"
    file.write_bytes(lzma.decompress((DATA / "lift_table.step.xz").read_bytes()))
    other = {part.name: part for part in jk.load(file).parts}
    metres = {"m": 1.0, "mm": 1e-3}[jk.load(file).unit]
    assert {*lift_table_of_solids.names} == {*other}
    for part in lift_table_of_solids.parts:
        np.testing.assert_allclose(part.box, metres * other[part.name].box, atol=2e-8)  # nine digits, twice


@pytest.mark.long
def test_parts_weigh_what_the_cad_system_says(lift_table_of_solids):
    """Centre and inertia are those of the solids, for one density a part; a chord of a circle loses a thousandth."""
    metre, skew = METRES[lift_table_of_solids.unit], 0.0
    masses = jk.masses(lift_table_of_solids.mechanism())
    for name, mass, centre, inertia in zip(masses.parts, masses.mass, masses.centre, masses.inertia, strict=True):
        if mass:
            (part,) = (each for each in lift_table_of_solids.parts if each.name == name)
            solid = trimesh.Trimesh(part.triangles.reshape(-1, 3), np.arange(len(part.triangles) * 3).reshape(-1, 3))
            own = solid.moment_inertia * metre**2 * float(mass) / solid.volume
            np.testing.assert_allclose(centre, solid.center_mass, atol=1e-4 / metre)
            np.testing.assert_allclose(inertia, own, atol=2e-3 * np.abs(own).max())
            skew = max(skew, np.abs(own - np.diag(np.diag(own))).max() / np.abs(own).max())
    assert skew > 0.4  # products of inertia in another order, or of the other sign, would be seen


def test_groups_of_nested_assemblies_are_bodies(aileron):
    mechanism = aileron.mechanism()
    assert len(mechanism.bodies) == 8 and mechanism.mobility().freedoms == 1
    assert sum(joint.freedoms > 0 for joint in mechanism.all_joints) == 10
    owner = {part: body for body, parts in mechanism.bodies.items() for part in parts}
    ground = {owner[part.name] for part in aileron.parts if part.path[:1] == ("MountBrackets <1>",)}
    aileron_itself = {owner[part.name] for part in aileron.parts if part.path[:1] == ("Aileron_Att <1>",)}
    assert len(ground) == len(aileron_itself) == 1 and ground != aileron_itself


def test_a_large_export_is_told_in_a_few_lines(aileron):
    mechanism = aileron.mechanism()
    assert "4 revolute" in "".join(mechanism.notes) and len(mechanism.notes) < 5
    assert any("fixed in MountBrackets <1> is taken to be" in note for note in mechanism.notes)


@pytest.mark.long
def test_the_user_comes_before_the_export(lift_table):
    by_hand = jk.prismatic("ram", "Cylinder <1>", "RodPiston <1>", axis=(0, 0, 1))
    mechanism = lift_table.mechanism(joints=[by_hand])
    assert "ram" in mechanism.joints and "PrismaticCylinderPiston" not in mechanism.joints
    assert lift_table.mechanism(rigid=[["Cylinder <1>", "RodPiston <1>"]]).mobility().freedoms == 0
    fixed = lift_table.mechanism(fixed=["Platform*"])
    assert fixed.fixed[0] == "Platform <1>" and "Base <1>" not in fixed.fixed
    left = lift_table.mechanism(exclude=["Cylinder*", "RodPiston*"])
    assert left.mobility().freedoms == 2 and "Cylinder <1>" not in left.parts


@pytest.mark.long
def test_contacts_are_looked_at_where_they_are_asked_for(lift_table_of_solids):
    with pytest.raises(ValueError, match="touches no other part"):
        lift_table_of_solids.mechanism(fixed=["Base*", "CylBracket*"], infer=False)


def test_what_is_not_understood_is_named_and_the_rest_moves(tmp_path):
    tree = instance("base", grounded="true") + instance("wheel") + instance("pinion", (0.1, 0, 0))
    joints = joint("Revolute", "axle", "base", "wheel", (0, 0, 0)) + joint(
        "LeadScrew", "odd", "wheel", "pinion", (0, 0, 0)
    )
    gear = mate("Gear", "teeth", ("wheel", "line", (0, 0, 0), Z), ("pinion", "line", (0, 0, 0), Z))
    curve = mate("Coincident", "spline", ("wheel", "curve", (0, 0, 0), Z), ("pinion", "line", (0, 0, 0), Z))
    mechanism = load(tmp_path, tree, joints, gear + curve).mechanism()
    assert np.all(mechanism.sweep({"axle": np.linspace(0, 6, 7)}).closed)
    for said in ("LeadScrew 'odd'", "Gear 'teeth' of a line and a line", "Coincident 'spline' of a curve and a line"):
        assert any(said in note and "left out" in note for note in mechanism.notes)
    assert any("'pinion' is tied to nothing" in note for note in mechanism.notes)


def test_parts_without_joints_go_with_their_subassembly(tmp_path):
    """A lever of three parts of which only one has a joint, and a plate that touches nothing."""
    lever = instance("arm") + instance("bolt", (0.01, 0, 0)) + instance("knob", (0.2, 0, 0))
    tree = instance("base", grounded="true") + instance("lever", inside=lever, of="A") + instance("rod", (0.1, 0, 0))
    joints = joint("Revolute", "A", "base", "lever/arm", (0, 0, 0)) + joint(
        "Revolute", "B", "lever/knob", "rod", (0.1, 0, 0)
    )
    mechanism = load(tmp_path, tree, joints, assemblies='<Assembly uid="A"/>').mechanism()
    assert mechanism.bodies["arm"] == ("arm", "bolt", "knob")
    assert any("sub-assembly 'lever'" in note for note in mechanism.notes)
    assert mechanism.mobility().freedoms == 2


def test_links_kept_in_one_folder_stay_links(tmp_path):
    """A four-bar whose links are drawn in one sub-assembly, none joined to another inside of it."""
    links = instance("crank") + instance("rocker", (0.1, 0, 0))
    tree = instance("base", grounded="true") + instance("links", inside=links, of="A") + instance("coupler")
    ends = [("base", "links/crank", (0, 0, 0)), ("links/crank", "coupler", (0, 0.03, 0))]
    ends += [("coupler", "links/rocker", (0.1, 0.08, 0)), ("links/rocker", "base", (0.1, 0, 0))]
    joints = "".join(joint("Revolute", f"J{k}", *each) for k, each in enumerate(ends))
    tree = tree.replace(FRAME.format(0.1, 0, 0), FRAME.format(0, 0, 0))
    mechanism = load(tmp_path, tree, joints, assemblies='<Assembly uid="A"/>').mechanism()
    assert mechanism.mobility().freedoms == 1 and len(mechanism.bodies) == 4


def test_sides_of_a_joint_that_do_not_meet_are_told_with_their_distance(tmp_path):
    tree = instance("base", grounded="true") + instance("arm")
    apart = joint("Revolute", "A", "base", "arm", (0, 0, 0), (0.0003, 0, 0))
    assembly = load(tmp_path, tree + instance("far", (1, 0, 0), grounded="true"), apart)
    mechanism = assembly.mechanism()
    assert any("0.0003" in note and "Revolute 'A'" in note for note in mechanism.notes)
    assert dict(mechanism.joints["A"].evidence.sizes)["offset"] == pytest.approx(0.0003)


def test_names_that_come_again_are_numbered(tmp_path):
    tree = instance("base", grounded="true") + "".join(instance(f"arm{k}") for k in range(2))
    joints = "".join(joint("Revolute", "A", "base", f"arm{k}", (k, 0, 0)) for k in range(2))
    assert {*load(tmp_path, tree, joints).mechanism().joints} == {"A", "A#2"}


@pytest.mark.long
def test_solids_are_looked_for_nearby_but_not_taken_from_other_machines(lift_table_of_solids, tmp_path):
    """In a folder next to the export, if that has all of them: one that has a part of the same name is another's."""
    unpack(DATA / "lift_table_export.tar.xz", tmp_path / "geometry")
    (tmp_path / "export").mkdir()
    moved = (tmp_path / "geometry" / "LiftTable.xml").rename(tmp_path / "export" / "LiftTable.xml")
    with_solids = jk.load(moved)
    assert any("geometry" in note for note in with_solids.mechanism().notes)
    np.testing.assert_array_equal(with_solids.parts[0].box, lift_table_of_solids.parts[0].box)
    (tmp_path / "geometry" / "Base.step").unlink()
    with pytest.warns(UserWarning, match="no solids for .* and 11 more"):
        assert not any(part.faces for part in jk.load(moved).parts)


@pytest.mark.long
def test_solids_in_several_units_are_converted_and_solids_of_one_instance_are_one_body(tmp_path):
    """A four-bar linkage of four solids in millimetres, and a pin in metres."""
    unpack(DATA / "lift_table_export.tar.xz", tmp_path, "Link Pin.step")
    (tmp_path / "linkage.step").write_bytes(examples.path("fourbar").read_bytes())
    path = tmp_path / "two.xml"
    tree = instance("linkage", grounded="true") + instance("pin", (2, 0, 0), of="Q")
    files = [("P", "linkage.step"), ("Q", "Link Pin.step")]
    parts = "".join(f'<Part uid="{uid}" name="{uid}"><GeometryFile name="{name}"/></Part>' for uid, name in files)
    path.write_text(
        f"<SimscapeMultibodyImportXML><RootAssembly><InstanceTree>{tree}</InstanceTree></RootAssembly>"
        f"<Parts>{parts}</Parts></SimscapeMultibodyImportXML>"
    )
    assembly = jk.load(path)
    assert assembly.unit == "mm" and assembly.names == ("linkage", "linkage#2", "linkage#3", "linkage#4", "pin")
    assert assembly.exported.rigid == (assembly.names[:4],)
    (metres,) = jk.load(tmp_path / "Link Pin.step").parts
    pin = assembly.parts[-1]
    np.testing.assert_allclose(np.ptp(pin.box, axis=0), 1000 * np.ptp(metres.box, axis=0), rtol=1e-6)
    for face in pin.faces:  # the surfaces are scaled with their triangles
        assert np.abs(face.surface.distance(face.triangles.reshape(-1, 3))).max() < 1e-3


def test_a_part_whose_file_holds_no_solid_is_a_box(tmp_path):
    """Of a part with sketches only CAD systems write a STEP file without a shape."""
    (tmp_path / "sketch.step").write_text(
        "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('CONFIG_CONTROL_DESIGN'));\nENDSEC;\nDATA;\n"
        "#1=PRODUCT('sketch','sketch','',(#2));\n#2=PRODUCT_CONTEXT('',#3,'mechanical');\n"
        "#3=APPLICATION_CONTEXT('');\nENDSEC;\nEND-ISO-10303-21;\n"
    )
    tree = instance("sketch", grounded="true") + instance("arm")
    with pytest.warns(UserWarning, match=r"sketch.step holds no solids.*drawn as small boxes"):
        assembly = load(tmp_path, tree, joint("Revolute", "A", "sketch", "arm", (0, 0, 0)), file="sketch.step")
    assert assembly.mechanism().mobility().freedoms == 1


KINDS = [
    ("Weld", 0), ("Revolute", 1), ("Prismatic", 1), ("Cylindrical", 2), ("Planar", 3), ("Spherical", 3),
    ("Ball", 3), ("Gimbal", 3), ("PinSlot", 2), ("Bearing", 4), ("Telescoping", 4), ("Bushing", 6), ("SixDof", 6),
    ("Rectangular", 2), ("Cartesian", 3), ("Parallel", 4),
]  # fmt: skip


@pytest.mark.parametrize(("kind", "freedoms"), KINDS)
def test_each_kind_of_joint_leaves_its_freedoms(tmp_path, kind, freedoms):
    tree = instance("base", grounded="true") + instance("arm")
    mechanism = load(tmp_path, tree, joint(kind, "j", "base", "arm", (0.1, 0.2, 0.3))).mechanism()
    assert mechanism.mobility().freedoms == freedoms
    assert not any("left out" in note for note in mechanism.notes)


def test_a_universal_joint_turns_about_x_of_its_base_and_y_of_its_follower(tmp_path):
    tree = instance("base", grounded="true") + instance("shaft")
    mechanism = load(tmp_path, tree, joint("Universal", "cross", "base", "shaft", (0, 0, 0))).mechanism()
    for coordinate, axis in (("phi", (1, 0, 0)), ("theta", (0, 1, 0))):
        turned = mechanism.sweep(
            {"cross.phi": np.zeros(2), "cross.theta": np.zeros(2)} | {f"cross.{coordinate}": np.array([0, 0.3])}
        )
        rotation = np.asarray(turned.transforms["shaft"])[1, :3, :3]
        np.testing.assert_allclose(rotation @ axis, axis, atol=1e-12)  # a rotation keeps its axis
        assert np.trace(rotation) == pytest.approx(1 + 2 * np.cos(0.3))


@pytest.mark.parametrize("kind", ["LeadScrew", "Gear"])
def test_kinds_that_are_no_joints_here_are_named(tmp_path, kind):
    tree = instance("base", grounded="true") + instance("arm", (0.1, 0, 0))
    mechanism = load(tmp_path, tree, joint(kind, "odd", "base", "arm", (0, 0, 0))).mechanism()
    assert any(f"{kind} 'odd'" in note and "left out" in note for note in mechanism.notes)
    assert any("'arm' is tied to nothing" in note for note in mechanism.notes)


def test_bearing_and_telescoping_joints_slide_along_the_axis_of_one_side(tmp_path):
    """The axis is that of the base of a bearing, and that of the follower, which turns with it, of a telescope."""
    tree = instance("base", grounded="true") + instance("arm")
    for kind, parts in (("Bearing", ("base", "arm")), ("Telescoping", ("arm", "base"))):
        (found,) = load(tmp_path, tree, joint(kind, "j", "base", "arm", (0, 0, 0))).mechanism().all_joints
        assert (found.kind, found.parts) == ("contact j", parts)
