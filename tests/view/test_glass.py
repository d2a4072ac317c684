"""Pictures of parts as of glass: areas in front are strong, those behind pale, and memory is bounded."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest

from jaxkin.view.glass import PALE, see_through
from jaxkin.view.illustration import SUPERSAMPLING
from reference.round_parts import block, part
from view.test_illustration import BLUE, CANVAS, RED, at, plate

GREY = (0.4, 0.4, 0.4)


def test_areas_in_front_are_strong_and_those_behind_are_seen_through():
    box = part("box", block((1, 1, 0), (11, 7, 2)))
    image = see_through(CANVAS, [box], [GREY], [plate([2, 2], [5, 6], 3.0), plate([7, 2], [10, 6], -1.0)], RED)
    glass = PALE + (1 - PALE) * np.array(GREY)
    step = 1.5 / 255  # a picture has bytes, and the mean of nine of them
    np.testing.assert_allclose(at(image, 3.5, 4), 0.2 * glass + 0.8 * np.array(RED), atol=step)
    np.testing.assert_allclose(at(image, 8.5, 4), 0.58 * glass + 0.42 * np.array(RED), atol=step)
    np.testing.assert_allclose(at(image, 6, 4), glass, atol=step)
    np.testing.assert_allclose(at(image, 0.5, 0.5), 1.0, atol=step)


@pytest.mark.long
def test_a_picture_takes_less_than_seventy_bytes_for_each_pixel_drawn():
    """Two layers of 12 bytes of colour, 4 of depth and three masks, and what blending them takes: a picture of twenty
    million pixels drawn fits into 2 GB with all else."""
    large = replace(CANVAS, scale=40.0, height=320, width=480)
    box, areas = part("box", block((1, 1, 0), (11, 7, 2))), [plate([2, 2], [10, 6], 3.0)]
    see_through(CANVAS, [box], [GREY], areas, BLUE)  # imports are no part of it
    tracemalloc.start()
    see_through(large, [box], [GREY], areas, BLUE)
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert most < 70 * large.height * large.width * SUPERSAMPLING**2
