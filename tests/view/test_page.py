import json
import re
from base64 import b64decode
from dataclasses import replace

import numpy as np
import pytest

from jaxkin.joints.pairs import revolute
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.solve.status import Status
from jaxkin.view.page import MAX_PAGE_POSES, page
from view.bars import TURN


def write(motion, folder, **options):
    """The text of the page, and the data in it."""
    page(motion, folder / "motion.html", **options)
    text = (folder / "motion.html").read_text("utf-8")
    (data,) = re.findall(r'<script id="scene" type="application/json">(.*?)</script>', text, re.DOTALL)
    return text, json.loads(data)


def floats(text, *shape):
    return np.frombuffer(b64decode(text), "<f4").reshape(-1, *shape)


def displacements(body, data):
    """The 4x4 displacements that the page holds, in the unit of the mechanism."""
    rows = floats(body["poses"], 3, 4).astype(float)
    centre, poses = np.array(data["centre"]), np.tile(np.eye(4), (len(rows), 1, 1))
    poses[:, :3, :3] = rows[:, :, :3]
    poses[:, :3, 3] = data["scale"] * rows[:, :, 3] + centre - rows[:, :, :3] @ centre
    return poses


def test_the_page_needs_nothing_from_elsewhere(four_bar, tmp_path):
    text, _ = write(four_bar, tmp_path)
    assert not re.search(r"https?:|//\w+\.|\bsrc=|\bhref=|url\(|@import|\bimport\b|fetch\(|XMLHttp|{{", text)
    assert len(text) < 2e6


def test_the_page_holds_the_motion(four_bar, tmp_path):
    _, data = write(four_bar, tmp_path)
    assert data["title"] == "Motion driven by A, 0° to 360°" and data["labels"][10] == "60°"
    assert data["cyclic"] and data["planar"] and not any(data["problems"])
    for rows in (data["parts"], data["bodies"]):
        assert [row["name"] for row in rows] == ["ground", "crank", "coupler", "rocker"]
    assert [body["fixed"] for body in data["bodies"]] == [True, False, False, False]
    assert [part["body"] for part in data["parts"]] == [0, 1, 2, 3]
    for body in data["bodies"][1:]:
        expected = np.asarray(four_bar.transforms[body["name"]])
        assert np.allclose(displacements(body, data), expected, atol=2e-5)  # float32 of about 150 mm
    assert data["bodies"][0]["poses"] == ""


def test_the_page_holds_the_solids(four_bar, plates, tmp_path):
    _, data = write(four_bar, tmp_path)
    for part, solid in zip(data["parts"], plates, strict=True):
        points = data["scale"] * floats(part["points"], 3) + data["centre"]
        corners = points[np.frombuffer(b64decode(part["triangles"]), "<u4").reshape(-1, 3)]
        assert len(corners) == len(solid.triangles)
        for side, corner in zip(solid.box, (corners.min(axis=(0, 1)), corners.max(axis=(0, 1))), strict=True):
            assert np.allclose(corner, side, rtol=0, atol=2e-5)  # float32 of about 150 mm
        normals = np.frombuffer(b64decode(part["normals"]), "i1").reshape(-1, 4)
        assert len(normals) == len(points) and np.abs(np.linalg.norm(normals[:, :3], axis=1) - 127).max() < 1.5
        assert len(floats(part["edges"], 2, 3)) == 12  # of a box


def test_the_page_holds_the_paths(four_bar, tmp_path):
    _, data = write(four_bar, tmp_path, points={"coupler": (20.0, 60.0, 0.0)})
    (path,) = data["paths"]
    expected = np.asarray(four_bar.points("coupler", np.array([20.0, 60.0, 0.0])))
    assert path["part"] == "coupler"
    assert np.allclose(data["scale"] * floats(path["points"], 3) + data["centre"], expected, atol=2e-5)


@pytest.mark.long
def test_failed_poses_are_told(partly, tmp_path):
    _, data = write(partly, tmp_path)
    closed = np.asarray(partly.closed)
    kinds = [problem.partition(":")[0] for problem in data["problems"]]
    assert kinds == ["" if code == Status.CLOSED else Status(code).name.lower() for code in np.asarray(partly.status)]
    assert {"unreachable", "jumped"} <= set(kinds)  # the loops close again where no motion leads
    for kind in set(kinds) - {""}:
        assert f"{kinds.count(kind)} {kind}" in data["subtitle"]
    for path in data["paths"]:
        assert np.array_equal(np.isfinite(floats(path["points"], 3)).all(axis=1), closed)


def hinge(part="arm", name="A"):
    joint = revolute(name, "ground", part, point=(0, 0, 0), axis=(0, 0, 1))
    other = revolute("B", part, "tip", point=(1, 0, 0), axis=(0, 0, 1))
    return Mechanism.build(fixed=["ground"], joints=[joint, other], unit="mm")


def test_long_motions_are_thinned_and_sorted(tmp_path):
    angles = np.random.default_rng(0).uniform(0, 3, 10_000)
    _, data = write(hinge().sweep({"A": angles}), tmp_path)
    shown = np.array([float(label.removesuffix("°")) for label in data["labels"]])
    assert len(shown) == MAX_PAGE_POSES and (np.diff(shown) >= 0).all()
    assert shown[0] == pytest.approx(np.rad2deg(angles.min()), abs=0.06)
    assert shown[-1] == pytest.approx(np.rad2deg(angles.max()), abs=0.06)
    assert data["subtitle"].startswith("10000 poses")


def test_one_pose_is_enough(tmp_path):
    _, data = write(hinge().sweep({"A": np.array([0.5])}), tmp_path)
    assert data["labels"] == ["28.6°"] and not data["cyclic"]


def test_names_cannot_break_the_page(tmp_path):
    name = "</script><b>\u2028\"'{{viewer}}"
    text, data = write(hinge(part=name, name="<!--").sweep({"<!--": np.array([0.0, 1.0])}), tmp_path)
    assert data["parts"][1]["name"] == name and data["labels"][0] == "0°" and "by <!--," in data["title"]
    assert text.count("</script>") == 3 and "<b>" not in text and "<!--" not in text


def test_the_page_is_the_same_in_another_unit(sticks, small, tmp_path):
    (_, one), (_, other) = write(sticks, tmp_path), write(small, tmp_path)
    assert other["scale"] == pytest.approx(1e-6 * one["scale"], rel=1e-9)
    for first, second in zip(one["bodies"], other["bodies"], strict=True):
        assert np.allclose(floats(first["poses"]), floats(second["poses"]), atol=1e-5)
    for first, second in zip(one["parts"], other["parts"], strict=True):
        assert np.allclose(floats(first["points"]), floats(second["points"]), atol=1e-6)
    assert np.allclose(one["axes"], other["axes"], atol=1e-9)
    assert one["labels"] == other["labels"] and len(one["labels"]) == len(TURN)


def test_a_unit_that_was_not_said_is_not_made_up(tmp_path):
    motion = replace(hinge(), unit="").sweep({"A": np.array([0.0, 1.0])})
    assert write(motion, tmp_path)[1]["subtitle"] == "2 poses  ·  lengths in the unit of the input"
