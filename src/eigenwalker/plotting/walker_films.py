"""Films of walkers: point-light displays and stick figures as MP4, WebM or GIF."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Literal

import numpy as np
import xarray as xr

from eigenwalker.core.arguments import check_kind
from eigenwalker.core.skeleton import LINKS, Skeleton
from eigenwalker.core.trajectories import check_trajectories
from eigenwalker.core.walker import Walker
from eigenwalker.plotting.encoding import (
    FilmFormat,
    encode_film,
    film_format,
    frame_delays,
)
from eigenwalker.plotting.layout import DEFAULT_DURATION_S, STYLES, Style, arrange, positions_at
from eigenwalker.plotting.shades import shades_between

Background = Literal["dark", "light"]
COLOURS = {"dark": ("#000000", "#ffffff"), "light": ("#ffffff", "#191919")}
"""Of the ground and of the walker."""


def write_film(
    walks: Walker | xr.DataArray | Sequence[Walker | xr.DataArray],
    path: str | Path,
    *,
    duration_s: float | None = None,
    n_strides: int | None = None,
    azimuth_deg: float = 30.0,
    elevation_deg: float = 0.0,
    eye_distance_mm: float | None = None,
    style: Style = "dots",
    size_px: int | tuple[int, int] = 512,
    rate_hz: float | None = None,
    background: Background = "dark",
    titles: Sequence[str] = (),
    skeleton: Skeleton = LINKS,
    progress: Callable[[int, int], object] | None = None,
) -> Path:
    """Write a film of one walker, or of several side by side, and return its path.

    White dots on black, or stick figures whose left limbs are dimmer. All walkers have one scale,
    at which all of them stay in the picture.

    Parameters
    ----------
    walks : Walker, DataArray of shape (time, marker, axis), or a sequence of them
        Walkers begin where their first phase is 0, captures with their first frame, and walkers
        beside a capture at the moment of its first frame, on its clock. Missing markers are not
        drawn.
    path : path
        Ends in ``.mp4``, ``.webm`` or ``.gif``. The file appears when it is complete.
    duration_s : float, optional
        Seconds of the film; left out, 4 for walkers, and as long as the shortest capture.
    n_strides : int, optional
        Whole strides in place of a duration, so that the film repeats without a seam. Walkers of
        different frequency then keep step, at their mean frequency.
    azimuth_deg, elevation_deg, eye_distance_mm : float
        An azimuth of 0 is the frontal view, 90 in profile to the right; see `project`.
    style : {"dots", "sticks"}
        Point-light display or stick figure.
    size_px : int or (width, height)
        Height of the picture, whose width then is what the walkers need; or both. Odd numbers
        are rounded up.
    rate_hz : float, optional
        Frames a second; 60 if left out, and 50 for a GIF, which takes 50, 25 or 20.
    background : {"dark", "light"}
        White on black or black on white.
    titles : sequence of str
        One over each walker.
    skeleton : Skeleton
        Which markers the sticks join.
    progress : callable, optional
        Called after each frame with the numbers of frames written and of all.

    Returns
    -------
    Path

    Raises
    ------
    ValueError
        If an option is not known or contradicts another.
    FileNotFoundError
        If the folder does not exist.

    See Also
    --------
    eigenwalker.stimulus.write_stimulus : Films of stimuli, with transforms and mannequins.

    References
    ----------
    Troje (2002), Methods, experiment (white dots on black); Moler (2016), walkers in step.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> hop = ew.Walker(["foot"], [[0, 0, 50]], [[[0, 0, 40]]], [1], [0], 1.0)
    >>> with TemporaryDirectory() as folder:
    ...     film = write_film(hop, Path(folder) / "hop.gif", n_strides=2, size_px=64)
    ...     film.stat().st_size > 0
    True
    """
    path = Path(path)
    check_kind(walks, (Walker, xr.DataArray, list, tuple), "walkers or trajectories")
    shown = [walks] if isinstance(walks, Walker | xr.DataArray) else list(walks)
    for walk in shown:
        check_kind(walk, (Walker, xr.DataArray), "a walker or trajectories")
    form = film_format(path, rate_hz)
    _check(shown, duration_s, n_strides, style, background, titles)
    delays, seconds = _moments(shown, duration_s, n_strides, rate_hz or form.rate_hz, form)
    layout = arrange(
        [
            positions_at(walk, _start(walk, shown) + moments)
            for walk, moments in zip(shown, seconds, strict=True)
        ],
        azimuth_deg=azimuth_deg,
        elevation_deg=elevation_deg,
        eye_distance_mm=eye_distance_mm,
        style=style,
        size_px=size_px,
        titles=titles,
        skeleton=skeleton,
    )
    encode_film(
        layout.frames(),
        path,
        shape=layout.shape,
        form=form,
        delays=delays,
        shades=shades_between(*COLOURS[background]),
        progress=progress,
    )
    return path


def _check(
    shown: list[Walker | xr.DataArray],
    duration_s: float | None,
    n_strides: int | None,
    style: str,
    background: str,
    titles: Sequence[str],
) -> None:
    problems = []
    if not shown:
        problems.append("there is no walker to film")
    if duration_s is not None and n_strides is not None:
        problems.append("duration_s and n_strides are both given; give one")
    if duration_s is not None and not 0 < duration_s <= 3600:
        problems.append(f"duration_s={duration_s:g} must lie between 0 and 3600")
    captures = [check_trajectories(walk) for walk in shown if not isinstance(walk, Walker)]
    if n_strides is not None and (captures or n_strides < 1):
        problems.append(
            "n_strides must be 1 or more, and is for walkers; a capture takes duration_s"
        )
    if style not in STYLES:
        problems.append(f"style={style!r} is none of {STYLES}")
    if background not in COLOURS:
        problems.append(f"background={background!r} is none of {tuple(COLOURS)}")
    if len(titles) not in (0, len(shown)):
        problems.append(f"there are {len(titles)} titles for {len(shown)} walkers")
    if problems:
        raise ValueError("This film cannot be made: " + "; ".join(problems) + ".")


def _moments(
    shown: list[Walker | xr.DataArray],
    duration_s: float | None,
    n_strides: int | None,
    rate_hz: float,
    form: FilmFormat,
) -> tuple[list[Fraction], list[np.ndarray]]:
    """How long each frame stays, and for each walker the seconds from its beginning it shows."""
    walkers = [walk for walk in shown if isinstance(walk, Walker)]
    if n_strides is not None:
        lasts = [n_strides * walker.period_s for walker in walkers]
        duration_s = n_strides / float(np.mean([walker.frequency_hz for walker in walkers]))
    else:
        if duration_s is None:
            captured = [np.ptp(w.time.values) for w in shown if not isinstance(w, Walker)]
            duration_s = float(min(captured, default=DEFAULT_DURATION_S))
        lasts = [duration_s] * len(shown)
    delays = frame_delays(duration_s, rate_hz, form, whole=n_strides is not None)
    starts = np.concatenate([[0.0], np.cumsum([float(delay) for delay in delays[:-1]])])
    length = float(sum(delays)) if n_strides is not None else duration_s
    return delays, [starts * (last / length) for last in lasts]


def _start(walk: Walker | xr.DataArray, shown: list[Walker | xr.DataArray]) -> float:
    """The moment at which a walk begins, on its own clock."""
    if not isinstance(walk, Walker):
        return float(walk.time.values[0])
    beside = [float(other.time.values[0]) for other in shown if not isinstance(other, Walker)]
    return beside[0] if beside else walk.time_origin_s
