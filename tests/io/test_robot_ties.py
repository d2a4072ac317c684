"""What ties joints of robot files: leaders that keep their zero, joints of two axes, welds of points, names in use."""

import numpy as np
import pytest

import jaxkin as jk

LINKS = "".join(f"<link name='{name}'/>" for name in "abcd")
THREE = f"""<robot name='r'>{LINKS}
<joint name='j1' type='revolute'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/>
<limit lower='-1' upper='1'/></joint>
<joint name='j2' type='revolute'><parent link='b'/><child link='c'/><origin xyz='1 0 0'/><axis xyz='0 0 1'/>
<limit lower='-3' upper='3'/><mimic joint='j1' multiplier='-2' offset='.25'/></joint>
<joint name='j3' type='revolute'><parent link='c'/><child link='d'/><origin xyz='1 0 0'/><axis xyz='0 0 1'/>
<limit lower='-9' upper='9'/><mimic joint='j2' multiplier='3' offset='-1'/></joint>
%s</robot>"""


@pytest.mark.long
@pytest.mark.parametrize("moved", ["", "<transmission name='t'><joint name='j1'/></transmission>"])
def test_a_leader_keeps_its_zero(moved, tmp_path):
    """With j1 = u: j2 = 0.25 - 2 u and j3 = 3 j2 - 1, whether the file says that j1 is moved or not."""
    (tmp_path / "arm.urdf").write_text(THREE % moved)
    assembly = jk.load(tmp_path / "arm.urdf")
    mechanism = assembly.mechanism()
    assert mechanism.joints["j1"].limits == ((-1.0, 1.0),)
    values = {name: own[0] for name, own in assembly.exported.joint_values.items()}
    np.testing.assert_allclose([values[name] for name in ("j1", "j2", "j3")], [0, 0.25, -0.25], atol=1e-12)
    u = np.linspace(-0.5, 0.5, 5)
    motion = mechanism.sweep({"j1": u}, throw=True)
    # the assembled pose has j1 + j2 + j3 = 0, from where transforms are counted
    turned = u + (0.25 - 2 * u) + (3 * (0.25 - 2 * u) - 1)
    expected = np.stack([np.cos(turned), np.sin(turned)], axis=1)
    np.testing.assert_allclose(motion.transforms["d"][:, :2, 0], expected, atol=1e-12)


def test_a_joint_may_be_called_as_a_weld_is(tmp_path):
    (tmp_path / "arm.urdf").write_text(
        f"<robot name='r'>{LINKS}<joint name='b-c' type='continuous'><parent link='a'/><child link='b'/>"
        "<axis xyz='0 0 1'/></joint><joint name='x' type='fixed'><parent link='b'/><child link='c'/></joint>"
        "<joint name='y' type='continuous'><parent link='c'/><child link='d'/><axis xyz='0 0 1'/></joint></robot>"
    )
    mechanism = jk.load(tmp_path / "arm.urdf").mechanism()
    assert {each.name: each.parts for each in mechanism.all_joints} == {
        "b-c": ("a", "b"), "y": ("c", "d"), "b-c#2": ("b", "c")
    }  # fmt: skip


def test_a_second_mimic_is_told(tmp_path):
    (tmp_path / "arm.urdf").write_text(
        (THREE % "").replace("<mimic joint='j1'", "<mimic joint='j3'/><mimic joint='j1'")
    )
    assert any("a further one is left out" in note for note in jk.load(tmp_path / "arm.urdf").mechanism().notes)


def test_a_joint_of_sdf_may_follow_the_second_axis_of_another(tmp_path):
    (tmp_path / "arm.sdf").write_text(
        "<sdf version='1.10'><model name='m'><link name='a'/><link name='b'/>"
        "<joint name='j' type='revolute2'><parent>world</parent><child>a</child><axis><xyz>0 0 1</xyz></axis>"
        "<axis2><xyz>1 0 0</xyz></axis2></joint><joint name='k' type='revolute'><parent>a</parent><child>b</child>"
        "<axis><xyz>0 0 1</xyz><mimic joint='j' axis='axis2'><multiplier>2</multiplier></mimic></axis></joint>"
        "</model></sdf>"
    )
    mechanism = jk.load(tmp_path / "arm.sdf").mechanism()
    motion = mechanism.sweep({"j 1": np.zeros(3), "j 2": np.array([0.0, 0.2, 0.4])}, throw=True)
    np.testing.assert_allclose(motion.coordinates["k"][:, 0], [0.0, 0.4, 0.8], atol=1e-12)


@pytest.mark.parametrize(("scale", "freedoms"), [("0", 1), ("1", 0)])
def test_a_weld_without_torque_holds_a_point(scale, freedoms, tmp_path):
    """Three hinges in a row and the ground: a plane loop of four hinges, or one that is welded."""
    links = "".join(
        f"<body name='{name}' pos='{x} {x} 0'><joint axis='0 0 1'/>" for name, x in (("a", 0), ("b", 1), ("c", 2))
    )
    weld = f"<weld body1='c' torquescale='{scale}'/>"
    text = f"<mujoco><worldbody>{links}{'</body>' * 3}</worldbody><equality>{weld}</equality></mujoco>"
    (tmp_path / "loop.xml").write_text(text.replace("pos='2 2 0'", "pos='1 -1 0'"))
    assert jk.load(tmp_path / "loop.xml").mechanism().mobility().freedoms == freedoms


def test_a_file_of_somebody_else_is_not_taken_away(tmp_path):
    (tmp_path / "arm.urdf").write_text(THREE % "")
    mechanism = jk.load(tmp_path / "arm.urdf").mechanism()
    other = tmp_path / "new.yaml"
    other.write_text("controller: {kp: 3}\n")
    jk.write_urdf(mechanism, tmp_path / "new.urdf")
    assert other.read_text() == "controller: {kp: 3}\n"
    pins = {"Agc": (0, 0, 0), "Bca": (1, 0, 0), "Cab": (2, 2, 0), "Dgb": (3, 0, 0)}
    hinges = [jk.revolute(key[0], key[1], key[2], point=point, axis=(0, 0, 1)) for key, point in pins.items()]
    loop = jk.Mechanism.build(fixed=["g"], unit="m", joints=hinges)
    with pytest.raises(ValueError, match=r"new\.yaml is there, and no file of loops"):
        jk.write_urdf(loop, tmp_path / "new.urdf")
    assert other.read_text() == "controller: {kp: 3}\n"
    other.unlink()
    jk.write_urdf(loop, tmp_path / "new.urdf")
    assert other.is_file()
    jk.write_urdf(mechanism, tmp_path / "new.urdf")  # a file of loops of an earlier mechanism is
    assert not other.exists()


BARS = """<mujoco><worldbody>
<body name='a'><joint name='j1' axis='0 0 1'/><geom size='.1'/>
<body name='b' pos='1 0 0'><joint name='j2' axis='0 0 1'/><geom size='.1'/></body></body></worldbody>
<equality>%s</equality></mujoco>"""


def test_joints_that_are_tied_twice_have_two_ties(tmp_path):
    (tmp_path / "bars.xml").write_text(BARS % (2 * "<joint joint1='j2' joint2='j1' polycoef='0 2'/>"))
    mechanism = jk.load(tmp_path / "bars.xml").mechanism()
    assert len(mechanism.linkage.couplings) == 2 and mechanism.mobility().freedoms == 1
    motion = mechanism.sweep({"j1": np.linspace(0, 0.5, 3)}, throw=True)
    np.testing.assert_allclose(motion.coordinates["j2"][:, 0], [0, 0.5, 1], atol=1e-12)


def test_what_follows_a_joint_that_a_weld_locks_is_told_by_name(tmp_path):
    ties = "<weld body1='b' body2='a'/><joint joint1='j1' joint2='j2'/>"
    (tmp_path / "bars.xml").write_text(BARS % ties)
    notes = jk.load(tmp_path / "bars.xml").mechanism().notes
    said = "'j1 follows j2' is left out: 'j2' moves nothing here; drive 'j1' with zeros to hold what it ties"
    assert said in notes


FLAGGED = """<mujoco><compiler angle="radian"/><option><flag {}="disable"/></option><worldbody>
<body name="a"><joint name="p" axis="0 1 0" range="-1 1"/><geom size=".1"/>
<body name="b" pos="1 0 0"><joint name="q" axis="0 1 0"/><geom size=".1"/></body></body></worldbody>
<equality><connect body1="b" anchor="1 0 0"/><joint joint1="p" joint2="q"/></equality></mujoco>"""


@pytest.mark.parametrize(
    ("flag", "couplings", "limits", "notes"),
    [
        ("contact", 1, ((-1.0, 1.0),), []),
        ("limit", 1, (), ["disables limits"]),
        ("equality", 0, ((-1.0, 1.0),), ["disables equality"]),
        ("constraint", 0, (), ["disables limits", "disables equality"]),
    ],
)
def test_what_an_option_of_mujoco_disables_does_not_hold(tmp_path, flag, couplings, limits, notes):
    """Loops were closed, and joints limited, that the model leaves open, without a word."""
    path = tmp_path / "model.xml"
    path.write_text(FLAGGED.format(flag))
    mechanism = jk.load(path).mechanism()
    assert len(mechanism.linkage.couplings) == couplings
    assert mechanism.joints["p"].limits == limits
    assert len(mechanism.joints) == 2 + couplings
    told = [note for note in mechanism.notes if "disable" in note]
    assert all(any(said in note for note in told) for said in notes) and len(told) == len(notes)


@pytest.mark.parametrize(("said", "offset", "factor"), [("0.3", 0.3, 1.0), ("0.3 2", 0.3, 2.0), ("", 0.0, 1.0)])
def test_numbers_of_a_polynomial_that_are_not_written_are_those_of_mujoco(tmp_path, said, offset, factor):
    """One number is the constant, beside a factor of one: the constraint was left out."""
    path = tmp_path / "model.xml"
    polynomial = f'polycoef="{said}"' if said else ""
    text = FLAGGED.format("contact").replace('<connect body1="b" anchor="1 0 0"/>', "")
    path.write_text(text.replace('joint2="q"', f'joint2="q" {polynomial}'))
    assembly = jk.load(path)
    (p,), (q,) = (assembly.exported.joint_values[name] for name in "pq")
    np.testing.assert_allclose(p, offset + factor * q, atol=1e-12)  # closed by Newton's method
    motion = assembly.mechanism().sweep({"q": [0.0, 0.1]})
    np.testing.assert_allclose(np.asarray(motion.coordinates["p"])[1], 0.1 * factor, atol=1e-12)


def test_what_is_written_for_mujoco_is_read_without_a_word_about_its_least_masses(tmp_path):
    joint = jk.cylindrical("c", "ground", "a", point=(0, 0, 0), axis=(0, 0, 1))
    jk.write_mjcf(jk.Mechanism.build(fixed=["ground"], joints=[joint], unit="m"), tmp_path / "model.xml")
    assert not [note for note in jk.load(tmp_path / "model.xml").mechanism().notes if "bound" in note]


HELD = f"""<robot name='r'>{LINKS}
<joint name='j1' type='continuous'><parent link='a'/><child link='b'/><axis xyz='0 0 1'/></joint>
<joint name='j2' type='%s'><parent link='b'/><child link='c'/><origin xyz='1 0 0'/><axis xyz='0 0 1'/>
<limit lower='-3' upper='3'/><mimic joint='j1' multiplier='0' offset='.25'/></joint>
<joint name='j3' type='continuous'><parent link='c'/><child link='d'/><origin xyz='1 0 0'/><axis xyz='0 0 1'/>
<mimic joint='j2' multiplier='2' offset='.5'/></joint></robot>"""


@pytest.mark.parametrize(("kind", "turned", "up"), [("revolute", 1.25, 0.0), ("prismatic", 1.0, 0.25)])
def test_what_follows_by_nothing_is_held_at_its_offset_with_what_follows_it(kind, turned, up, tmp_path):
    """j2 = 0.25 and j3 = 2 j2 + 0.5 = 1, whatever j1 is: both were freedoms of their own."""
    (tmp_path / "arm.urdf").write_text(HELD % kind)
    assembly = jk.load(tmp_path / "arm.urdf")
    mechanism = assembly.mechanism()
    assert mechanism.mobility().freedoms == 1
    middle = {part.name: part.box.mean(axis=0) for part in assembly.parts}
    angle = 0.25 if kind == "revolute" else 0.0
    np.testing.assert_allclose(middle["d"], [1 + np.cos(angle), np.sin(angle), up], atol=1e-12)
    edge = np.array(assembly.parts[assembly.names.index("d")].triangles).reshape(-1, 3) - middle["d"]
    axis = [np.cos(turned), np.sin(turned), 0]  # the box of the link stands as the link does
    np.testing.assert_allclose(np.abs(edge @ axis).max(), np.abs(edge[:, 2]).max(), rtol=1e-9)
    notes = "\n".join(mechanism.notes)
    assert "holds 'j2' at 0.25: the factor is zero" in notes and "holds 'j3' at 1: 'j2' is held, too" in notes


def test_a_joint_of_sdf_that_follows_by_nothing_is_held_too(tmp_path):
    """At its offset, whatever the reference is, which the factor multiplies."""
    (tmp_path / "arm.sdf").write_text(
        "<sdf version='1.11'><model name='m'><link name='a'/><link name='b'/>"
        "<joint name='j' type='revolute'><parent>world</parent><child>a</child><axis><xyz>0 0 1</xyz></axis></joint>"
        "<joint name='k' type='prismatic'><parent>a</parent><child>b</child><axis><xyz>0 0 1</xyz><mimic joint='j'>"
        "<multiplier>0</multiplier><offset>.5</offset><reference>3</reference></mimic></axis></joint></model></sdf>"
    )
    assembly = jk.load(tmp_path / "arm.sdf")
    assert assembly.mechanism().mobility().freedoms == 1
    assert assembly.parts[assembly.names.index("b")].box.mean(axis=0)[2] == pytest.approx(0.5, abs=1e-12)
