"""Films of walkers: point-light displays and stick figures as MP4, WebM or GIF."""

from __future__ import annotations

import itertools
import math
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Literal, cast

import av
import numpy as np
import xarray as xr
from av.video.stream import VideoStream

from eigenwalker.display.links import LINKS
from eigenwalker.display.staging import STYLES, Scene, Style, positions_at, stage
from eigenwalker.skeleton import Skeleton
from eigenwalker.trajectories import check_trajectories
from eigenwalker.walker import Walker

Background = Literal["dark", "light"]
GREYS: dict[str, tuple[int, int]] = {"dark": (0, 255), "light": (255, 25)}
"""Grey of the ground and of the walker, black 0 to white 255."""
USUAL_S = 4.0
"""Seconds of a film whose duration is left open."""
CENTISECONDS = {50: 2, 25: 4, 20: 5}
"""Frame rates of a GIF, whose delays are whole hundredths of a second, and those delays."""


@dataclass(frozen=True)
class FilmFormat:
    """How a suffix is written: container, codec, the codec's options, the usual frame rate."""

    container: str
    codec: str
    pixels: str
    rate_hz: float
    options: dict[str, str] = field(default_factory=dict)
    container_options: dict[str, str] = field(default_factory=dict)


FORMATS = {
    ".mp4": FilmFormat(
        *("mp4", "libx264", "yuv420p", 60),
        options={"crf": "24", "preset": "veryfast"},
        container_options={"movflags": "+faststart"},
    ),
    ".webm": FilmFormat(
        *("webm", "libvpx-vp9", "yuv420p", 60),
        options={"crf": "30", "b": "0", "deadline": "realtime", "cpu-used": "6"},
    ),
    ".gif": FilmFormat("gif", "gif", "gray", 50, container_options={"loop": "0"}),
}


def write_film(
    walks: Walker | xr.DataArray | Sequence[Walker | xr.DataArray],
    path: str | Path,
    *,
    duration_s: float | None = None,
    n_strides: int | None = None,
    view_deg: float = 30.0,
    elevation_deg: float = 0.0,
    distance_mm: float = math.inf,
    style: Style = "dots",
    size_px: int | tuple[int, int] = 512,
    rate_hz: float | None = None,
    background: Background = "dark",
    titles: Sequence[str] = (),
    skeleton: Skeleton = LINKS,
    progress: Callable[[int, int], object] | None = None,
) -> Path:
    """Write a film of one walker, or of several side by side, and return its path.

    White dots on black as in J34, or a stick figure whose left limbs are the dimmer ones. All
    walkers have one scale, at which all of them stay in the picture.

    Parameters
    ----------
    walks : Walker, trajectories, or a sequence of them
        Walkers begin where their first phase is 0, captures with their first frame, and walkers
        beside a capture at the moment of its first frame, on its clock. Markers of a capture that
        are missing at a moment are not drawn.
    path : path
        The suffix decides: ``.mp4``, ``.webm`` or ``.gif``. The file appears when it is whole.
    duration_s : float, optional
        Seconds of the film; left open, 4 for walkers, and what the shortest capture lasts.
    n_strides : int, optional
        Whole strides in place of a duration, so that the film repeats without a seam. Walkers of
        different frequency then keep step, in the time of their mean frequency (M1).
    view_deg, elevation_deg, distance_mm : float
        0 is the frontal view, 90 in profile to the right; see `project`.
    style : {"dots", "sticks"}
        Point-light display or stick figure.
    size_px : int or (width, height)
        Height of the picture, the width being what the walkers need; or both. Odd ones get one
        more.
    rate_hz : float, optional
        Frames a second; 60, and 50 for a GIF, whose delays are whole hundredths of a second: it
        takes 50, 25 or 20.
    background : {"dark", "light"}
        White on black or black on white.
    titles : sequence of str
        Words over each walker.
    skeleton : Skeleton
        Which markers the sticks join.
    progress : callable, optional
        Called after each frame with the number of frames written and of all.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    ValueError
        If a choice is not known or does not go with another, saying what does.
    FileNotFoundError
        If the folder does not exist.

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
    shown = [walks] if isinstance(walks, Walker | xr.DataArray) else list(walks)
    form = _form_of(path, rate_hz)
    _check(shown, duration_s, n_strides, style, background, titles)
    delays, seconds = _moments(shown, duration_s, n_strides, rate_hz or form.rate_hz, form)
    scene = stage(
        [
            positions_at(walk, _start(walk, shown) + moments)
            for walk, moments in zip(shown, seconds, strict=True)
        ],
        view_deg=view_deg,
        elevation_deg=elevation_deg,
        distance_mm=distance_mm,
        style=style,
        size_px=size_px,
        titles=titles,
        skeleton=skeleton,
    )
    whole = path.with_name(f".{path.name}.part")
    try:
        _encode(scene, whole, form, delays, GREYS[background], progress)
        os.replace(whole, path)
    finally:
        whole.unlink(missing_ok=True)
    return path


def _form_of(path: Path, rate_hz: float | None) -> FilmFormat:
    if path.suffix.lower() not in FORMATS:
        raise ValueError(f"{path.name!r} must end in one of {sorted(FORMATS)} to become a film.")
    if not path.parent.is_dir():
        raise FileNotFoundError(f"The folder {str(path.parent)!r} does not exist; make it first.")
    form = FORMATS[path.suffix.lower()]
    if form.codec == "gif" and rate_hz is not None and rate_hz not in CENTISECONDS:
        raise ValueError(
            f"A GIF waits whole hundredths of a second between frames, so rate_hz={rate_hz:g} "
            f"would change the tempo of the walk; choose one of {sorted(CENTISECONDS)}, or an MP4."
        )
    if rate_hz is not None and not 1 <= rate_hz <= 240:
        raise ValueError(f"rate_hz={rate_hz:g} is no rate for a film; choose 1 to 240.")
    return form


def _check(
    shown: list[Walker | xr.DataArray],
    duration_s: float | None,
    n_strides: int | None,
    style: str,
    background: str,
    titles: Sequence[str],
) -> None:
    amiss = []
    if not shown:
        amiss.append("there is no walker to film")
    if duration_s is not None and n_strides is not None:
        amiss.append("duration_s and n_strides are both given; give one")
    if duration_s is not None and not 0 < duration_s <= 3600:
        amiss.append(f"duration_s={duration_s:g} must lie between 0 and 3600")
    captures = [check_trajectories(walk) for walk in shown if not isinstance(walk, Walker)]
    if n_strides is not None and (captures or n_strides < 1):
        amiss.append("n_strides must be 1 or more, and is for walkers; a capture takes duration_s")
    if style not in STYLES:
        amiss.append(f"style={style!r} is none of {STYLES}")
    if background not in GREYS:
        amiss.append(f"background={background!r} is none of {tuple(GREYS)}")
    if len(titles) not in (0, len(shown)):
        amiss.append(f"there are {len(titles)} titles for {len(shown)} walkers")
    if amiss:
        raise ValueError("This film cannot be made: " + "; ".join(amiss) + ".")


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
            duration_s = float(min(captured, default=USUAL_S))
        lasts = [duration_s] * len(shown)
    delays = _delays(duration_s, rate_hz, form, whole=n_strides is not None)
    starts = np.concatenate([[0.0], np.cumsum([float(delay) for delay in delays[:-1]])])
    length = float(sum(delays)) if n_strides is not None else duration_s
    return delays, [starts * (last / length) for last in lasts]


def _start(walk: Walker | xr.DataArray, shown: list[Walker | xr.DataArray]) -> float:
    """The moment at which a walk begins, on its own clock."""
    if not isinstance(walk, Walker):
        return float(walk.time.values[0])
    beside = [float(other.time.values[0]) for other in shown if not isinstance(other, Walker)]
    return beside[0] if beside else walk.time_origin_s


def _delays(duration_s: float, rate_hz: float, form: FilmFormat, *, whole: bool) -> list[Fraction]:
    """Seconds each frame stays; a film of whole strides lasts as long as they do."""
    if form.codec == "gif":
        hundredths = max(round(100 * duration_s), CENTISECONDS[int(rate_hz)])
        n_frames = hundredths // CENTISECONDS[int(rate_hz)]
        ends = [round(hundredths * frame / n_frames) for frame in range(n_frames + 1)]
        return [Fraction(b - a, 100) for a, b in itertools.pairwise(ends)]
    n_frames = max(round(duration_s * rate_hz), 1)
    delay = Fraction(duration_s / n_frames if whole else 1 / rate_hz)
    return [1 / (1 / delay).limit_denominator(1001)] * n_frames


def _encode(
    scene: Scene,
    path: Path,
    form: FilmFormat,
    delays: list[Fraction],
    greys: tuple[int, int],
    progress: Callable[[int, int], object] | None,
) -> None:
    n_rows, n_columns = scene.shape
    shades, planes, picture = _canvas(form, scene.shape, greys)
    tick = delays[0] if form.codec != "gif" else Fraction(1, 100)
    options = dict(form.container_options)
    if form.codec == "gif":  # the last frame has no next one to tell how long it stays
        options["final_delay"] = str(round(100 * delays[-1]))
    with av.open(str(path), "w", format=form.container, options=options) as film:
        stream = cast(VideoStream, film.add_stream(form.codec, rate=1 / tick, options=form.options))
        stream.width, stream.height, stream.pix_fmt = n_columns, n_rows, form.pixels
        stream.codec_context.time_base = tick
        start = Fraction(0)
        for done, (cover, delay) in enumerate(zip(scene.frames(), delays, strict=True), start=1):
            np.take(shades, cover, out=picture, mode="clip")  # else it would be buffered
            frame = av.VideoFrame.from_ndarray(planes, format=form.pixels)
            frame.time_base, frame.pts = tick, round(start / tick)
            frame.duration = round(delay / tick)
            film.mux(stream.encode(frame))
            start += delay
            if progress is not None:
                progress(done, len(delays))
        film.mux(stream.encode())


def _canvas(
    form: FilmFormat, shape: tuple[int, int], greys: tuple[int, int]
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The shade of each cover, what the encoder takes, and that part of it which is the picture.

    Greys as they are, or as luma of 16 to 235 above empty planes of colour.
    """
    shades = np.linspace(*greys, 256)
    if form.pixels == "gray":
        planes = np.zeros(shape, np.uint8)
        return np.rint(shades).astype(np.uint8), planes, planes
    n_rows, n_columns = shape
    planes = np.full((n_rows * 3 // 2, n_columns), 128, np.uint8)
    return np.rint(16 + shades * (219 / 255)).astype(np.uint8), planes, planes[:n_rows]
