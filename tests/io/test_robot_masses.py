"""Masses that robot files give, against Pinocchio's and MuJoCo's own reading of the same files.

Tolerance: rounding of a few products of poses, 1e-12 of the size.
"""

from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
import trimesh
from scipy.spatial.transform import Rotation

import jaxkin as jk
from jaxkin.io.robot_drawn import triangles_of
from jaxkin.io.robot_model import LinkShape
from reference.archives import unpack
from reference.bare_models import bare_model

ROBOTS = ("5bar_linkage", "robot_delta", "cassie_like", "digit_like")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    where = tmp_path_factory.mktemp("robots")
    unpack(Path(__file__).with_name("data") / "robots" / "robots.tar.xz", where)
    return where


def about_origin(masses: jk.Masses, parts) -> np.ndarray:
    """Mass, first moments and the inertia about the origin of the world of some parts together."""
    found = np.zeros(1 + 3 + 9)
    for name in parts:
        number = masses.parts.index(name)
        mass, c = float(masses.mass[number]), np.asarray(masses.centre[number])
        own = np.asarray(masses.inertia[number]) + mass * (c @ c * np.eye(3) - np.outer(c, c))
        found += [mass, *(mass * c), *own.ravel()]
    return found


def pinocchio_at(path, values):
    """Pinocchio, its model, data and configuration for values of the joints."""
    pinocchio = pytest.importorskip("pinocchio")
    model = pinocchio.buildModelFromUrdf(str(path))
    data, q = model.createData(), pinocchio.neutral(model)
    for name, own in zip(model.names[1:], model.joints[1:], strict=True):
        if len(np.ravel(values.get(name, ()))):
            value = float(np.ravel(values[name])[0])
            # Pinocchio has a hinge without limits as cosine and sine
            q[own.idx_q : own.idx_q + own.nq] = value if own.nq == 1 else (np.cos(value), np.sin(value))
    return pinocchio, model, data, q


@pytest.mark.parametrize("name", ROBOTS)
def test_bodies_weigh_what_pinocchio_has(folder, name):
    """Links that are fixed to each other are one body there, whose masses add up."""
    path = folder / f"gepetto__{name}.urdf"
    assembly = jk.load(path, loops=path.with_suffix(".yaml"))
    mechanism = assembly.mechanism()
    masses = jk.masses(mechanism)
    pinocchio, model, data, q = pinocchio_at(path, assembly.exported.joint_values)
    pinocchio.forwardKinematics(model, data, q)
    welds = {}  # those of the tree: the loops of these files are closed by welds, too, which Pinocchio does not know
    for joint in ElementTree.parse(path).getroot().findall("joint"):
        if joint.get("type") == "fixed":
            welds.setdefault(joint.find("parent").get("link"), []).append(joint.find("child").get("link"))
    names = {part.original_name: part.name for part in assembly.parts}
    original = {new: old for old, new in names.items()}

    def welded(link):
        return [link, *(further for child in welds.get(link, ()) for further in welded(child))]

    total = 0.0
    for number, joint in enumerate(model.names[1:], start=1):
        own = data.oMi[number].act(model.inertias[number])
        c = own.lever
        inertia = own.inertia + own.mass * (c @ c * np.eye(3) - np.outer(c, c))
        links = welded(original[mechanism.joints[joint].parts[1]])
        found = about_origin(masses, [names[link] for link in links])
        expected = np.array([own.mass, *(own.mass * c), *inertia.ravel()])
        np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-12 * np.abs(expected).max())
        total += own.mass
    moving = [part for part in mechanism.parts if part not in mechanism.fixed]
    np.testing.assert_allclose(about_origin(masses, moving)[0], total, rtol=1e-12)


@pytest.mark.long
@pytest.mark.parametrize("closed", [False, True])
def test_gravity_torques_of_a_five_bar_are_those_of_pinocchio(folder, closed):
    """Of the tree: torque of each joint. With its loop: what they do together along a change of each motor."""
    path = folder / "gepetto__5bar_linkage.urdf"
    assembly = jk.load(path, loops=path.with_suffix(".yaml") if closed else None)
    mechanism = assembly.mechanism()
    moving = [name for name, joint in mechanism.joints.items() if str(joint.kind) == "revolute"]
    motors = mechanism.motors if closed else moving
    drive = {name: 0.1 * np.sin(np.linspace(0, 3, 5) + k) for k, name in enumerate(motors)}
    motion = mechanism.sweep({name: values - values[0] * (not closed) for name, values in drive.items()})
    assert motion.closed.all()
    gravity = (1.0, -2.0, -9.0)
    found = jk.drive_forces(motion, jk.masses(mechanism), gravity=gravity).forces
    zero = {name: np.ravel(values) for name, values in assembly.exported.joint_values.items()}
    along = {
        motor: jk.velocities(motion, {each: float(each == motor) for each in motors}).coordinates for motor in motors
    }
    for pose in range(len(motion)):
        values = {
            name: zero[name] + np.asarray(motion.coordinates[name][pose]) if name in motion.coordinates else zero[name]
            for name in zero
        }
        pinocchio, model, data, q = pinocchio_at(path, values)
        model.gravity.linear = np.array(gravity)
        torques = pinocchio.computeGeneralizedGravity(model, data, q)
        for motor in motors:
            rates = np.zeros(model.nv)
            for name, own in zip(model.names[1:], model.joints[1:], strict=True):
                if name in along[motor]:
                    rates[own.idx_v] = float(along[motor][name][pose, 0])
            np.testing.assert_allclose(
                found[f"{motor}.phi"][pose], torques @ rates, rtol=1e-9, atol=1e-9 * np.abs(torques).max()
            )


def test_cassie_weighs_what_mujoco_has(folder, tmp_path):
    path = folder / "menagerie__agility_cassie_cassie.xml"
    model = bare_model(path, tmp_path)
    mechanism = jk.load(path).mechanism()
    masses = jk.masses(mechanism, given={mechanism.fixed[0]: 0})
    compared = 0
    for number, part in enumerate(masses.parts):
        if part not in mechanism.fixed and "/" not in part:
            body = model.body(part)
            np.testing.assert_allclose(masses.mass[number], body.mass[0], rtol=1e-12)
            own = np.linalg.eigvalsh(np.asarray(masses.inertia[number]))
            np.testing.assert_allclose(own, np.sort(body.inertia), rtol=1e-7)  # its file is printed to six digits
            compared += 1
    assert compared > 20


MJCF = """<mujoco><compiler angle="degree"/><worldbody><body name="arm" pos="1 2 3" euler="10 20 30">
<joint axis="0 1 0"/><inertial pos="0.1 0.2 0.3" mass="2" euler="5 10 15" diaginertia="0.3 0.4 0.5"/>
<geom size="0.1"/><body name="hand" pos="0 0 1" quat="1 0.2 0.3 0.4"><joint axis="1 0 0"/><joint axis="0 1 0"/>
<inertial pos="0 0.1 0" mass="1.5" fullinertia="0.3 0.4 0.5 0.01 -0.02 0.03"/><geom size="0.1"/>
<body name="nail"><geom size="0.1" mass="0"/></body></body></body></worldbody></mujoco>"""


def test_places_and_axes_of_inertias_are_those_of_mujoco(tmp_path):
    mujoco = pytest.importorskip("mujoco")
    model = mujoco.MjModel.from_xml_string(MJCF)
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    (tmp_path / "arm.xml").write_text(MJCF)
    masses = jk.masses(jk.load(tmp_path / "arm.xml").mechanism())
    for name in ("arm", "hand"):
        number, body = masses.parts.index(name), model.body(name).id
        turn = data.ximat[body].reshape(3, 3)
        np.testing.assert_allclose(masses.mass[number], model.body_mass[body])
        np.testing.assert_allclose(masses.centre[number], data.xipos[body], atol=1e-12)
        expected = turn @ np.diag(model.body_inertia[body]) @ turn.T
        np.testing.assert_allclose(masses.inertia[number], expected, atol=1e-12)
    assert float(masses.total) == 3.5  # the part between the two joints of the hand, and the nail, weigh nothing


SDF = """<sdf version="1.9"><model name="m"><link name="base"/><link name="arm"><pose>1 2 3 0.1 0.2 0.3</pose>
<inertial><pose>0.1 0 0.2 0.3 0.2 0.1</pose><mass>2</mass><inertia><ixx>0.3</ixx><ixy>0.01</ixy><iyy>0.4</iyy>
<izz>0.5</izz></inertia></inertial><visual><geometry><box><size>1 2 3</size></box></geometry></visual></link>
<joint name="A" type="revolute"><parent>base</parent><child>arm</child>
<axis><xyz>0 0 1</xyz></axis></joint><joint name="F" type="fixed"><parent>world</parent><child>base</child></joint>
</model></sdf>"""


def test_sdf(tmp_path):
    (tmp_path / "arm.sdf").write_text(SDF)
    mechanism = jk.load(tmp_path / "arm.sdf").mechanism()
    masses = jk.masses(mechanism)
    number = masses.parts.index("arm")
    link, own = Rotation.from_euler("xyz", (0.1, 0.2, 0.3)), Rotation.from_euler("xyz", (0.3, 0.2, 0.1))
    turn = (link * own).as_matrix()
    inertia = np.array([[0.3, 0.01, 0], [0.01, 0.4, 0], [0, 0, 0.5]])
    assert float(masses.mass[number]) == 2.0
    np.testing.assert_allclose(masses.centre[number], (1, 2, 3) + link.apply((0.1, 0, 0.2)), atol=1e-14)
    np.testing.assert_allclose(masses.inertia[number], turn @ inertia @ turn.T, atol=1e-14)
    # a density of all parts gives way to the file, and where no part takes it that is said; one of this part does not
    for density in ("steel", {"*": "steel"}):
        with pytest.warns(UserWarning, match=r"the density is that of no part: .*'arm'.*\{'arm': 'steel'\}"):
            assert float(jk.masses(mechanism, density).mass[number]) == 2.0
    assert float(jk.masses(mechanism, {"arm": "steel"}).mass[number]) == pytest.approx(6 * 7850, rel=1e-12)
    assert float(jk.masses(mechanism, given={"arm": jk.Mass(7.0, (0, 0, 0))}).mass[number]) == 7.0


def test_a_link_without_a_solid_is_not_weighed_by_the_box_that_marks_its_place(tmp_path):
    links = [f'<link name="{name}"/>' for name in "abc"]
    links[2] = '<link name="c"><visual><geometry><sphere radius="0.1"/></geometry></visual></link>'
    joints = [
        f'<joint name="{a}{b}" type="continuous"><parent link="{a}"/><child link="{b}"/></joint>'
        for a, b in ("ab", "bc")
    ]
    (tmp_path / "r.urdf").write_text(f'<robot name="r">{"".join(links + joints)}</robot>')
    mechanism = jk.load(tmp_path / "r.urdf").mechanism()
    with pytest.raises(ValueError, match="no mass of 'b': a part without a solid needs given="):
        jk.masses(mechanism, "steel")
    assert float(jk.masses(mechanism, "steel", given={"b": 0}).mass[1]) == 0.0
    motion = mechanism.sweep({"ab": [0.0, 1.0], "bc": [0.0, 0.0]})
    assert jk.clashes(motion).pairs == ()
    with pytest.raises(ValueError, match="'b' has no solid to sweep"):
        jk.swept_volume(motion, "b")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ('<inertia ixx="1"/>', "<link name='b'>: inertial: mass: expected 1 finite number, got None"),
        ('<mass value="x"/>', "inertial: mass: expected 1 finite number, got 'x'"),
    ],
)
def test_what_is_no_number_is_refused(tmp_path, given, message):
    with pytest.raises(ValueError, match=message):
        hinged(tmp_path, given)


def hinged(folder, given):
    """Load a link "b" with the given inertial on a hinge."""
    (folder / "r.urdf").write_text(
        f'<robot name="r"><link name="a"/><link name="b"><inertial>{given}</inertial></link><joint name="j" '
        'type="continuous"><parent link="a"/><child link="b"/></joint></robot>'
    )
    return jk.load(folder / "r.urdf").mechanism()


def test_a_robot_moves_whatever_its_file_says_of_masses(tmp_path):
    """Robots that others simulate have masses that no body has: what is taken in their place is said."""
    negative = hinged(tmp_path, '<mass value="-1"/>')
    assert "<link name='b'>: inertial: expected a mass from 0 on, got -1; it is not taken" in "\n".join(negative.notes)
    with pytest.raises(ValueError, match="'b'"):
        jk.masses(negative)
    turned = hinged(tmp_path, '<mass value="1"/><inertia ixx="1" iyy="1" izz="5" ixy="2"/>')
    assert "no body has the inertia [1.0, 1.0, 5.0, 2.0, 0.0, 0.0], of which one eigenvalue is -1" in turned.notes[0]
    found = jk.masses(turned)
    # of eigenvalues 3 and -1 along (1, 1) and (1, -1) the first is left
    np.testing.assert_allclose(
        found.inertia[found.parts.index("b")], [[1.5, 1.5, 0], [1.5, 1.5, 0], [0, 0, 5]], atol=1e-12
    )
    larger = hinged(tmp_path, '<mass value="1"/><inertia ixx="1" iyy="1" izz="5"/>')
    assert "principal moments of inertia of 1, 1, 5, of which the largest is above the sum" in larger.notes[0]
    found = jk.masses(larger)
    np.testing.assert_allclose(found.inertia[found.parts.index("b")], np.diag([1.0, 1.0, 5.0]))
    plate = hinged(tmp_path, '<mass value="1"/><inertia ixx="0.33" iyy="0.33" izz="0.67"/>')
    assert not any("inertia" in note for note in plate.notes)


@pytest.mark.parametrize(
    ("kind", "size"),
    [("box", (0.1, 0.2, 0.3)), ("sphere", (0.1,)), ("sphere", (0.1, 0.2, 0.3)), ("cylinder", (0.1, 0.5)),
     ("capsule", (0.1, 0.5)), ("capsule", (0.1, 0.01))],
)  # fmt: skip
def test_solids_without_a_file_weigh_what_their_formulas_say(kind, size):
    """Spheres, cylinders and boxes with moments to 1e-5, capsules to 4e-3: those of their triangles."""
    mesh = trimesh.Trimesh(*trimesh.triangles.to_kwargs(triangles_of(LinkShape(np.eye(4), kind, size))).values())
    if kind == "box":
        volume, square = np.prod(size), np.array(size) ** 2 / 12
    elif kind == "sphere":
        a = np.broadcast_to(size, 3)
        volume, square = 4 / 3 * np.pi * np.prod(a), a**2 / 5
    else:
        r, h = size
        volume, square = np.pi * r**2 * h, np.array([r**2 / 4, r**2 / 4, h**2 / 12])
    if kind == "capsule":
        ball = 4 / 3 * np.pi * r**3
        ends = np.array([r**2 / 5, r**2 / 5, r**2 / 5 + h**2 / 4 + 3 * h * r / 8])
        volume, square = volume + ball, (volume * square + ball * ends) / (volume + ball)
    np.testing.assert_allclose(mesh.volume, volume, rtol=1e-12)  # rounding of a thousand triangles
    np.testing.assert_allclose(mesh.center_mass, 0, atol=1e-12)
    moments = volume * (square.sum() - square)
    np.testing.assert_allclose(mesh.moment_inertia.diagonal(), moments, rtol=4e-3 if kind == "capsule" else 1e-5)


@pytest.mark.parametrize(("kind", "size"), [("sphere", (0.0,)), ("cylinder", (0.1, 0.0)), ("capsule", (0.0, 0.0))])
def test_solids_of_no_size_have_finite_corners(kind, size):
    assert np.isfinite(triangles_of(LinkShape(np.eye(4), kind, size))).all()
