"""How much of a walk its components hold, and how well sines fit them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr
from matplotlib.figure import Figure

from eigenwalker.core.trajectories import check_trajectories
from eigenwalker.core.walker import Walker, check_walkers
from eigenwalker.plotting.style import (
    INK,
    PALE,
    PURPLE,
    SMALL,
    TEAL,
    USUAL,
    head_line,
    new_figure,
    note,
    panel,
    panels,
)

FOUR_INKS = (TEAL, PURPLE, "#BB8800", INK)
"""Of the first four components."""


def figure_variance(walkers: Sequence[Walker], *, n_components: int = 6) -> Figure:
    """Return the share of variance of the first components, mean and SD over walkers.

    Parameters
    ----------
    walkers : sequence of Walker
        Decomposed from captures, which gives them their fit.
    n_components : int
        Bars to draw, as far as the walkers have them.

    Returns
    -------
    Figure

    Raises
    ------
    ValueError
        If no walker was decomposed from a capture.

    See Also
    --------
    figure_eigenpostures : The postures.

    References
    ----------
    Troje (2002), fig. 2.
    """
    check_walkers(walkers)
    shares = [walker.fit.variance_share for walker in walkers if walker.fit is not None]
    if not shares:
        raise ValueError("None of the walkers has a fit; decompose captures with decompose_pca().")
    n_components = min(n_components, *(len(share) for share in shares))
    percent = 100 * np.array([share[:n_components] for share in shares])
    mean = percent.mean(axis=0)
    spread = percent.std(axis=0, ddof=1) if len(percent) > 1 else None
    figure, axes = panel(3.3, 2.3)
    order = np.arange(1, n_components + 1)
    axes.bar(order, mean, width=0.62, color=TEAL)
    if spread is not None:
        axes.errorbar(
            order, mean, spread, fmt="none", ecolor=INK, elinewidth=0.8, capsize=2.5, capthick=0.8
        )
    for number, share, above in zip(
        order, mean, mean if spread is None else mean + spread, strict=True
    ):
        note(axes, f"{share:.1f}", (number, above), (0, 3), ha="center")
    axes.set(xlabel="Component", ylabel="Variance (%)", xticks=order, ylim=(0, 105))
    return figure


def figure_scores(walk: xr.DataArray, walker: Walker, *, n_frames: int = 600) -> Figure:
    """Return the scores of a walk on its eigenpostures over time, and the sines.

    Above, the scores of the capture; below, the sines that the walker has in their place. R2 is
    the coefficient of determination over the whole capture.

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        The walk in place from which the walker was decomposed.
    walker : Walker
        As `decompose_pca` returns it.
    n_frames : int
        Frames to draw: 600 are 5 s at 120 Hz.

    Returns
    -------
    Figure

    See Also
    --------
    figure_eigenpostures : The postures.

    References
    ----------
    Troje (2002), fig. 3 and eq. 8.
    """
    check_walkers([walker])
    walk = check_trajectories(walk, complete=True).sel(marker=list(walker.markers))
    scores, sines = scores_of(walk, walker)
    r2 = 1 - ((scores - sines) ** 2).sum(axis=0) / ((scores - scores.mean(axis=0)) ** 2).sum(axis=0)
    figure = new_figure(5.6, 3.6)
    above, below = (row[0] for row in panels(figure, 2, 1, sharex=True, sharey=True))
    seconds = (walk.time.values - walk.time.values[0])[:n_frames]
    for axes, curves in ((above, scores), (below, sines)):
        axes.axhline(0, color=PALE, lw=0.6, zorder=0)
        for component, curve in enumerate(curves.T):
            ink = FOUR_INKS[component % 4]
            axes.plot(
                seconds, curve[:n_frames], color=ink, lw=1.1, ls="-" if component < 4 else "--"
            )
    for component, share in enumerate(r2):
        words = f"{component + 1}   R² {share:.2f}"
        below.text(
            1.01,
            0.9 - 0.17 * component,
            words,
            transform=below.transAxes,
            fontsize=SMALL,
            color=FOUR_INKS[component % 4],
        )
    head_line(above, "Scores of the capture")
    head_line(below, "Sine fits")
    below.set_xlabel("Time (s)")
    figure.supylabel("Score (mm)", fontsize=USUAL, color=INK)
    below.set_xlim(0, seconds[-1])
    return figure


def scores_of(walk: xr.DataArray, walker: Walker) -> tuple[np.ndarray, np.ndarray]:
    """Return a walk's scores on eigenpostures, and those of the sines: (time, component), mm."""
    postures = walker.p.reshape(len(walker.p), -1)
    amplitudes = np.linalg.norm(postures, axis=1)
    moved = (walk.values - walker.p0).reshape(walk.sizes["time"], -1)
    weights = np.linalg.lstsq(postures.T, moved.T, rcond=None)[0].T
    cycle = 2 * np.pi * walker.frequency_hz * (walk.time.values[:, None] - walker.time_origin_s)
    return weights * amplitudes, amplitudes * np.sin(walker.harmonics * cycle + walker.phases)
