"""Draw what each length contributes to a deviation, and how the measure of samples is distributed."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from jaxtyping import Float

from jaxkin._files import save_figure

MAX_BARS = 15
"""Lengths that are drawn at most, those that contribute most."""


class Deviation(NamedTuple):
    """What a measure deviates, as it is drawn beside the samples."""

    nominal: float
    worst_case: float
    root_sum_of_squares: float
    wanted: tuple[float, float] | None
    within: float | None
    """Share of the samples that has a wanted measure, 0 to 1."""


def draw_tolerances(
    names: Sequence[str],
    contributions: Float[np.ndarray, " rows"],
    samples: Float[np.ndarray, " samples"],
    deviation: Deviation,
    label: str,
    path: Path,
) -> Path:
    """Draw bars of the contributions and a histogram of the samples into a picture file; returns its path."""
    from matplotlib.figure import Figure

    good = samples[~np.isnan(samples)]
    panels = 2 if len(good) else 1
    figure = Figure(figsize=(5.5 * panels, 4.6), layout="constrained")
    order = np.argsort(contributions)[-MAX_BARS:]
    bars = figure.add_subplot(1, panels, 1)
    shares = contributions[order]
    drawn = bars.barh([names[row] for row in order], shares, color="tab:blue")
    bars.bar_label(drawn, [f"{share:.1f}" for share in shares], padding=3, fontsize="small")
    bars.set(xlabel="contribution to the variance (%)", xlim=(0, 1.15 * max(shares.max(), 1e-9)))
    if panels == 2:
        axes = figure.add_subplot(1, panels, 2)
        axes.hist(good, bins=min(60, max(10, len(good) // 50)), color="tab:blue", alpha=0.6)
        for offset, style, name in (
            (deviation.worst_case, "-", "worst case"),
            (deviation.root_sum_of_squares, "--", "root sum of squares"),
        ):
            for sign in (-1, 1):
                axes.axvline(
                    deviation.nominal + sign * offset, color="black", linestyle=style, lw=1, label=name * (sign > 0)
                )
        middle, spread = deviation.nominal, deviation.worst_case
        low, high = min(good.min(), middle - spread), max(good.max(), middle + spread)
        near = [end for end in deviation.wanted or () if low - (high - low) < end < high + (high - low)]
        for number, end in enumerate(near):  # ends that are far away would press the histogram into a line
            axes.axvline(end, color="tab:red", lw=1.5, label="" if number else "wanted")
        low, high = min([low, *near]), max([high, *near])
        if high > low:
            axes.set_xlim(low - 0.05 * (high - low), high + 0.05 * (high - low))
        if deviation.within is not None:
            axes.set_title(f"yield {100 * deviation.within:.2f} %", fontsize="medium")
        axes.set(xlabel=label, ylabel="samples")
        axes.ticklabel_format(axis="x", useOffset=False)
        axes.locator_params(axis="x", nbins=6)
        figure.legend(fontsize="small", frameon=False, loc="outside lower right", ncols=3)
    return save_figure(figure, path)
