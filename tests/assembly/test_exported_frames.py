"""What stands still of an export: what is held or fixed in the assembly, in one inside of it, or by a mate with it."""

import pytest

import jaxkin as jk
from reference.exported import X, Y, Z, instance, joint, load, mate


def test_joints_to_the_world_are_joints_to_what_is_held(tmp_path):
    tree = instance("base", grounded="true") + instance("arm")
    assert load(tmp_path, tree, joint("Revolute", "A", "", "arm", (0, 0, 0))).mechanism().mobility().freedoms == 1


def arm_of_servos(**of_servo):
    """A base, and on its hinge a servo of two parts that are fixed in it, with a horn on a hinge of the servo."""
    servo = instance("case", grounded="true") + instance("screw", (0.01, 0, 0), grounded="true")
    tree = instance("base") + instance("servo", (0.1, 0, 0), servo, of="A", **of_servo) + instance("horn")
    axle = joint("Revolute", "horn", "servo", "horn", (0, 0, 0), (0.1, 0, 0))
    return tree, joint("Revolute", "arm", "base", "servo/case", (0, 0, 0), (-0.1, 0, 0)) + axle


def test_what_is_fixed_in_an_assembly_moves_with_it(tmp_path):
    """Servos come with all of their parts fixed in them; a joint on the servo itself is one on these."""
    tree, joints = arm_of_servos()
    tree = tree.replace('uid="base"', 'uid="base" grounded="true"')
    mechanism = load(tmp_path, tree, joints, assemblies='<Assembly uid="A"/>').mechanism()
    assert mechanism.bodies == {"base": ("base",), "case": ("case", "screw"), "horn": ("horn",)}
    assert mechanism.fixed == ("base",) and mechanism.mobility().freedoms == 2
    assert mechanism.joints["horn"].parts == ("case", "horn")


def test_what_is_fixed_in_the_only_frame_stands_still_where_nothing_else_does(tmp_path):
    tree, joints = arm_of_servos()
    mechanism = load(tmp_path, tree, joints, assemblies='<Assembly uid="A"/>').mechanism()
    assert mechanism.fixed == ("case", "screw") and any("fixed in servo is taken" in note for note in mechanism.notes)


def test_of_several_frames_none_is_chosen(tmp_path):
    tree, joints = arm_of_servos()
    second = instance("stand", inside=instance("foot", grounded="true"), of="A")
    assembly = load(tmp_path, tree + second, joints, assemblies='<Assembly uid="A"/>')
    with pytest.raises(ValueError, match="holds no part"):
        assembly.mechanism()
    assert any("only in servo, stand" in note for note in assembly.mechanism(fixed=["base"]).notes)


WELD = joint("Weld", "origin", "", "base", (0, 0, 0))
PLANES = [
    mate("Coincident", f"plane {axis}", ("machine", "plane", (0, 0, 0), axis), ("base", "plane", (0, 0, 0), axis))
    for axis in (X, Y, Z)
]


@pytest.mark.parametrize(("weld", "mates"), [(WELD, ""), ("", "".join(PLANES))])
def test_a_part_that_is_held_by_the_assembly_itself_stands_still(tmp_path, weld, mates):
    tree, joints = arm_of_servos()
    mechanism = load(tmp_path, tree, joints + weld, mates, assemblies='<Assembly uid="A"/>').mechanism()
    assert mechanism.fixed == ("base",) and mechanism.mobility().freedoms == 2
    assert not any("left out" in note for note in mechanism.notes)


def test_a_part_that_the_assembly_itself_does_not_hold_is_named(tmp_path):
    assembly = load(
        tmp_path, instance("base") + instance("arm"), joint("Revolute", "A", "base", "arm", (0, 0, 0)), PLANES[0]
    )
    said = assembly.mechanism(fixed=["base"]).notes
    assert any("holds 'base' in the assembly itself, in which nothing is fixed; left out" in note for note in said)


@pytest.mark.parametrize(("inner", "freedoms"), [("", 0), (joint("Revolute", "pin", "case", "screw", (0, 0, 0)), 1)])
def test_in_an_assembly_that_is_fixed_joints_move_what_is_not(tmp_path, inner, freedoms):
    """Without joints of its own all of it is fixed; of a hinge in it the side that is fixed is."""
    inside = instance("case", **({"grounded": "true"} if inner else {})) + instance("screw")
    tree = instance("stand", inside=inside, of="A", grounded="true") + instance("arm")
    joints = joint("Revolute", "arm", "stand/case", "arm", (0, 0, 0))
    assembly = load(tmp_path, tree, joints, assemblies=f'<Assembly uid="A"><Joints>{inner}</Joints></Assembly>')
    assert assembly.mechanism().mobility().freedoms == 1 + freedoms


def test_a_part_that_is_held_twice_under_one_identifier_stands_still(tmp_path):
    tree = 2 * instance("base", grounded="true") + instance("arm")
    mechanism = load(tmp_path, tree, joint("Revolute", "A", "base", "arm", (0, 0, 0))).mechanism()
    assert mechanism.mobility().freedoms == 1
    assert any("taken for one body" in note for note in mechanism.notes)


def test_an_export_that_holds_no_part_asks_for_one(tmp_path):
    assembly = load(tmp_path, instance("base") + instance("arm"), joint("Revolute", "A", "base", "arm", (0, 0, 0)))
    with pytest.raises(ValueError, match=r"machine.xml: its CAD system holds no part; .*fixed=\['base'\]"):
        assembly.mechanism()
    assert assembly.mechanism(fixed=["base"]).mobility().freedoms == 1
    assert assembly.proposals()[0].freedoms == 1


def rigid(*paths):
    """A constraint of one or two instances without features, as Creo writes it."""
    ends = ("".join(f"<Uid>{uid}</Uid>" for uid in path.split("/")) for path in paths)
    return f'<Rigid name="r">{"".join(f"<InstancePath>{end}</InstancePath>" for end in ends)}</Rigid>'


def test_rigid_constraints_of_one_instance_hold_it_and_of_two_make_them_one_body(tmp_path):
    """The base of an arm stands in a sub-assembly that stands in the world; a cover belongs to the arm."""
    tree = instance("frame", (0, 0, 1), instance("base"), of="A") + instance("arm") + instance("cover", (0.2, 0, 0))
    sub = f'<Assembly uid="A"><Constraints>{rigid("base")}</Constraints></Assembly>'
    mates = rigid("frame") + rigid("arm", "cover")
    mates += mate("Coincident", "face", ("arm", "plane", (0, 0, 0), Z), ("frame", "plane", (0, 0, -1), Z))
    mates += mate("Coincident", "axis", ("arm", "line", (0, 0, 0), Z), ("frame", "line", (0, 0, 0), (0, 0, -30)))
    mechanism = load(tmp_path, tree, mates=mates, assemblies=sub).mechanism()
    assert mechanism.fixed == ("base",) and mechanism.bodies["arm"] == ("arm", "cover")
    assert [found.kind for found in mechanism.all_joints if found.freedoms] == ["revolute"]
    assert not any("left out" in note or "apart" in note for note in mechanism.notes)


@pytest.mark.parametrize(("marked", "freedoms"), [("true", 3), ("false", 1)])
def test_sub_assemblies_that_are_not_rigid_are_not_where_others_are_said_to_be(tmp_path, marked, freedoms):
    """Two links of a chain are in one folder; without a word of what is rigid that is taken for one part."""
    links = instance("one") + instance("three", (1, 0, 0))
    tools = instance("tools", (3, 0, 0), instance("spare") + instance("knob"), of="B", rigid=marked)
    tree = instance("base", grounded="true") + instance("links", inside=links, of="A") + instance("two") + tools
    ends = ("base", "links/one", "two", "links/three")
    joints = "".join(
        joint("Revolute", f"j{k}", ends[k], ends[k + 1], (0.1 * k, 0, 0), None if k < 2 else (0.1 * k - 1, 0, 0))
        for k in range(3)
    )
    assemblies = '<Assembly uid="A"/><Assembly uid="B"/>'
    mechanism = load(tmp_path, tree, joints, assemblies=assemblies).mechanism()
    assert mechanism.mobility().freedoms == freedoms
    path = tmp_path / "machine.xml"
    created = '<Created using="Simscape Multibody Link Version 6.1" from="SolidWorks 29.0.0"/><RootAssembly'
    path.write_text(path.read_text().replace("<RootAssembly", created))
    with pytest.warns(UserWarning, match="no solids"):
        assert jk.load(path).mechanism().mobility().freedoms == 3  # this exporter marks those that are rigid
