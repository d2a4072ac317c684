import sys
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.image import imread

from jaxkin.joints.pairs import revolute
from jaxkin.mechanism.mechanism import Mechanism
from jaxkin.view.sheet import CAPTION, GAP, HEAD, MARGIN
from jaxkin.view.storyboard import WIDTHS, storyboard
from reference.planar import fourbar
from view.bars import COLORS, TURN, box


def draw(motion, folder, **options):
    """The picture (height, width, 3) in 0..1."""
    storyboard(motion, folder / "motion.png", **options)
    return imread(folder / "motion.png")[..., :3]


def where(image, color):
    """Pixels of a colour."""
    return np.argwhere(np.abs(image - color).max(axis=-1) < 0.012)


@pytest.mark.long
def test_six_panels_in_two_rows_with_every_part_in_its_colour(four_bar, tmp_path):
    image = draw(four_bar, tmp_path)
    assert np.array_equal(image, draw(four_bar, tmp_path, poses=[0, 10, 20, 30, 40, 50]))  # 360 is 0
    width = 2 * MARGIN + 3 * WIDTHS[3] + 2 * GAP
    assert image.shape[1] == width and 600 < image.shape[0] < width
    assert (image[[0, -1]] == 1).all() and (image[:, [0, -1]] == 1).all()  # a white margin
    for color in COLORS.values():
        found = where(image[:-100], color)  # without the legend
        for panel in range(3):
            left = MARGIN + panel * (WIDTHS[3] + GAP)
            assert np.sum((found[:, 1] >= left) & (found[:, 1] < left + WIDTHS[3])) > 200
        assert len(where(image[-100:], color)) > 100  # and with it
    assert "matplotlib.pyplot" not in sys.modules or not sys.modules["matplotlib.pyplot"].get_fignums()


@pytest.mark.long
def test_parts_are_where_the_closed_form_has_them(four_bar, tmp_path):
    """The middle of the rocker in three panels side by side: it turns about its base pin as it should."""
    poses = [0, 10, 25]
    found = where(draw(four_bar, tmp_path, poses=poses, points={})[HEAD + CAPTION : -120], COLORS["rocker"])
    panel, rest = np.divmod(found[:, 1] - MARGIN, WIDTHS[3] + GAP)
    middles = [np.array([rest[panel == i].mean(), -found[panel == i, 0].mean()]) for i in range(3)]
    at = fourbar(1.0 + TURN[poses])
    steps, wanted = np.diff(middles, axis=0), np.diff((at.rocker_pin + [100.0, 0.0]) / 2, axis=0)
    scale = (steps * wanted).sum() / (wanted**2).sum()
    # The coupler covers one end of the rocker, more or less of it by the angle between them: some hundredths.
    assert np.abs(steps / scale - wanted).max() < 0.04 * 80
    assert np.abs(wanted).max() > 20


@pytest.mark.long
@pytest.mark.parametrize(("count", "columns", "rows"), [(1, 1, 1), (2, 2, 1), (4, 2, 2)])
def test_panels_fill_rows_of_at_most_three(four_bar, tmp_path, count, columns, rows):
    image = draw(four_bar, tmp_path, poses=np.arange(count))
    assert image.shape[1] == 2 * MARGIN + columns * WIDTHS[columns] + (columns - 1) * GAP
    captions = np.flatnonzero((image[:, MARGIN : MARGIN + 40] < 0.5).any(axis=(1, 2)))
    for row in range(rows):
        panel = (image.shape[0] - HEAD - 98 - (rows - 1) * GAP) / rows  # 98: a legend of one line; two are 34 more
        top = HEAD + row * (panel + GAP)
        assert ((captions > top - 40) & (captions < top + 40)).any()


@pytest.mark.long
def test_failed_poses_are_not_drawn(partly, nowhere, plates, tmp_path):
    for motion, some in ((partly, True), (nowhere, False)):
        solid = replace(motion, mechanism=replace(motion.mechanism, solids=plates))
        image = draw(solid, tmp_path)[HEAD:-120]
        for color in COLORS.values():
            assert (len(where(image, color)) > 200) == some


@pytest.mark.long
def test_poses_that_fail_or_do_not_exist_are_refused(partly, tmp_path):
    failed = int(np.flatnonzero(~np.asarray(partly.closed))[0])
    with pytest.raises(ValueError, match=f"pose {failed} is not closed"):
        storyboard(partly, tmp_path / "motion.png", poses=[failed])
    with pytest.raises(ValueError, match="holds 61, but the motion has poses 0 to 60"):
        storyboard(partly, tmp_path / "motion.png", poses=[61])
    assert not (tmp_path / "motion.png").exists()


@pytest.mark.long
def test_the_picture_is_the_same_in_another_unit(sticks, small, tmp_path):
    one, other = (draw(motion, tmp_path, poses=[0, 17, 40]) for motion in (sticks, small))
    assert one.shape == other.shape
    differ = np.abs(one - other).max(axis=-1)[:-120] > 0.02  # without the length beside the scale
    assert differ.mean() < 1e-3


@pytest.mark.long
def test_a_motion_in_space_is_drawn_too(crane, tmp_path):
    image = draw(crane, tmp_path)
    assert 0.02 < (image[HEAD:] < 0.9).any(axis=-1).mean() < 0.6


@pytest.mark.long
def test_any_name_of_a_part_is_drawn(tmp_path):
    names = ["_hidden", "a $ b $ c", "x" * 200, "\u30af\u30e9\u30f3\u30af"]  # the last: a crank, in katakana
    colors = [(0.8, 0.2, 0.2), (0.2, 0.2, 0.8), (0.2, 0.6, 0.2), (0.7, 0.2, 0.7)]
    joints = [revolute(name, "ground", name, point=(0, 0, 0), axis=(0, 0, 1)) for name in names]
    solids = [box("ground", [-5, -5, -5], [5, 5, 0])]
    solids += [box(name, [-1, -1, i], [9, 1, i + 1], colors[i]) for i, name in enumerate(names)]
    mechanism = replace(Mechanism.build(fixed=["ground"], joints=joints), solids=tuple(solids))
    legend = draw(mechanism.sweep({name: np.array([0.3]) for name in names}), tmp_path)[-200:]
    for color in colors:
        swatch = where(legend, color)
        middle, right = int(swatch[:, 0].mean()), swatch[:, 1].max()
        assert len(swatch) > 100
        assert (legend[middle - 8 : middle + 8, right + 12 : right + 60] < 0.6).any()  # letters beside it
