"""Included models of SDF with the poses that they may have, merged and nested: both are the same, by other names."""

import numpy as np
import pytest

from jaxkin.io.sdf import read_sdf
from jaxkin.io.xml_tree import read_xml

QUARTER = 1.5707963267948966
ARM = f"""<sdf version="1.9"><model name="inner"><pose>9 9 9 0 0 0</pose><link name="l1"><pose>1 0 0 0 0 0</pose></link>
<frame name="f" attached_to="l1"><pose>0 2 0 0 0 {QUARTER}</pose></frame>
<model name="hand"><pose relative_to="__model__">0 0 1 {QUARTER} 0 0</pose><link name="palm"><pose>0 1 0 0 0 0</pose>
</link><frame name="g"><pose relative_to="__model__">0 0 3 0 0 0</pose></frame></model>
<link name="l2"><pose relative_to="hand::g">0 0 1 0 0 0</pose></link></model></sdf>"""
OUTER = """<sdf version="1.9"><model name="outer"><link name="base"><pose>5 0 0 0 0 0</pose></link>
<include merge="{merge}"><uri>arm.sdf</uri><name>arm</name>{place}</include></model></sdf>"""
PLACES = {
    "in the model around": f'<pose relative_to="__model__">0 0 2 0 0 {QUARTER}</pose>',
    "on a link": f'<pose relative_to="base">0 0 2 0 0 {QUARTER}</pose>',
    "by a frame in it": '<placement_frame>f</placement_frame><pose relative_to="base">0 0 2 0 0 0</pose>',
    "its own": "",
}


def links(folder, text):
    (folder / "robot.sdf").write_text(text)
    return {each.name: each.pose for each in read_sdf(folder / "robot.sdf", read_xml(folder / "robot.sdf")).links}


@pytest.mark.parametrize("place", PLACES.values(), ids=PLACES)
def test_a_model_with_a_model_in_it_is_merged_where_it_is_nested(tmp_path, place):
    """A pose that is relative to `__model__` means the frame of the file that it is written in."""
    (tmp_path / "arm.sdf").write_text(ARM)
    merged, nested = (links(tmp_path, OUTER.format(merge=merge, place=place)) for merge in ("true", "false"))
    assert {*merged} == {"base", "l1", "l2", "hand::palm"}
    for name, pose in merged.items():
        np.testing.assert_allclose(pose, nested[name if name == "base" else f"arm::{name}"], atol=1e-14)


def test_a_frame_of_a_merged_model_is_placed_by_the_numbers_of_its_include(tmp_path):
    (tmp_path / "arm.sdf").write_text(ARM)
    found = links(tmp_path, OUTER.format(merge="true", place=PLACES["by a frame in it"]))
    # f, which is turned by a quarter about z at (1, 2, 0), is at (5, 0, 2) and not turned
    np.testing.assert_allclose(found["l1"][:3, 3], [5 - 2, 0, 2], atol=1e-14)
    np.testing.assert_allclose(found["l1"][:3, :3], [[0, 1, 0], [-1, 0, 0], [0, 0, 1]], atol=1e-14)


def test_a_merged_model_may_have_its_links_in_models_of_its_own(tmp_path):
    (tmp_path / "arm.sdf").write_text(
        '<sdf version="1.9"><model name="m"><model name="n"><link name="l"><pose>1 0 0 0 0 0</pose></link></model>'
        "</model></sdf>"
    )
    found = links(tmp_path, OUTER.format(merge="true", place="<pose>0 3 0 0 0 0</pose>"))
    np.testing.assert_allclose(found["n::l"][:3, 3], [1, 3, 0], atol=1e-14)


def test_a_folder_of_a_model_says_in_its_config_which_file_is_the_model(tmp_path):
    """Folders of Gazebo have a file for each version of the format; the newest is taken."""
    arm = tmp_path / "arm"
    arm.mkdir()
    arm.joinpath("model.config").write_text(
        "<model><sdf version='1.6'>old.sdf</sdf><sdf version='1.10'>new.sdf</sdf><sdf version='1.9'>mid.sdf</sdf>"
        "</model>"
    )
    for name in ("old", "mid"):
        arm.joinpath(f"{name}.sdf").write_text("<sdf version='1.6'><model name='x'/></sdf>")
    arm.joinpath("new.sdf").write_text(ARM)
    found = links(tmp_path, OUTER.format(merge="false", place="").replace("arm.sdf", "model://arm"))
    assert "arm::l1" in found
