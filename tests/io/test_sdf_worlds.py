"""Worlds of SDF: joints between models, what stands beside a world, and solids given in frames of their model."""

import numpy as np
import pytest

import jaxkin as jk


def models(more=""):
    arm = '<model name="arm"><pose>1 0 0 0 0 0</pose><link name="a"/></model>'
    cart = '<model name="cart"><pose>0 2 0 0 0 0</pose><link name="c"/></model>'
    return arm + cart + more


HINGE = """<joint name="hinge" type="revolute"><pose relative_to="arm">0 0 3 0 0 0</pose><parent>{}</parent>
<child>arm::a</child><axis><xyz>0 0 1</xyz></axis></joint>"""
RAIL = """<joint name="rail" type="prismatic"><parent>world</parent><child>cart</child>
<axis><xyz>1 0 0</xyz></axis></joint>"""


def load(folder, text):
    (folder / "world.sdf").write_text(f'<sdf version="1.11">{text}</sdf>')
    return jk.load(folder / "world.sdf")


def test_joints_of_a_world_are_between_its_models(tmp_path):
    mechanism = load(tmp_path, f"<world name='w'>{models(RAIL + HINGE.format('cart::c'))}</world>").mechanism()
    assert {name: joint.parts for name, joint in mechanism.joints.items()} == {
        "rail": ("world", "cart::c"), "hinge": ("cart::c", "arm::a")
    }  # fmt: skip
    assert mechanism.fixed == ("world",) and mechanism.mobility().freedoms == 2
    np.testing.assert_allclose(mechanism.joints["hinge"].frames_1[0, :3, 3], [1, 0, 3], atol=1e-15)


def test_the_only_model_of_a_world_has_its_name_where_joints_are_beside_it(tmp_path):
    arm = '<model name="arm"><link name="a"/></model>'
    mechanism = load(tmp_path, f"<world name='w'>{arm}{HINGE.format('world')}</world>").mechanism()
    assert mechanism.joints["hinge"].parts == ("world", "arm::a")


@pytest.mark.parametrize("beside", ["<world name='two'><model name='x'><link name='y'/></model></world>",
                                    "<model name='x'><link name='y'/></model>"])  # fmt: skip
def test_what_stands_beside_a_world_is_named(tmp_path, beside):
    mechanism = load(tmp_path, f"<world name='w'>{models(RAIL + HINGE.format('cart::c'))}</world>{beside}").mechanism()
    assert any("only <world name='w'> is read" in note and "left out" in note for note in mechanism.notes)


def test_solids_may_be_given_in_another_frame_of_the_model(tmp_path):
    box = "<geometry><box><size>.2 .2 .2</size></box></geometry>"
    text = f"""<model name="m"><frame name="f"><pose>5 0 0 0 0 0</pose></frame><link name="base"/>
    <link name="b"><pose>1 0 0 0 0 1</pose>
    <visual name="v"><pose relative_to="f">0 1 0 0 0 0</pose>{box}</visual></link>
    <joint name="j" type="revolute"><parent>base</parent><child>b</child>
    <axis><xyz>0 0 1</xyz></axis></joint></model>"""
    part = next(part for part in load(tmp_path, text).parts if part.name == "b")
    np.testing.assert_allclose(part.triangles.reshape(-1, 3).min(axis=0), [4.9, 0.9, -0.1], atol=1e-12)
