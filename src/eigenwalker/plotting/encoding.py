"""Frames as a film: containers, codecs, how long each frame stays, and shades as pixels."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import cast

import av
import numpy as np
from av.video.plane import VideoPlane
from av.video.stream import VideoStream

from eigenwalker.core.atomic_write import atomic_write, check_destination
from eigenwalker.core.progress import Progress, ticked

CENTISECONDS = {50: 2, 25: 4, 20: 5}
"""Frame rates of a GIF, whose delays are whole hundredths of a second, and those delays."""
LARGE_PX, FAST_OPTIONS = 1_000_000, {"preset": "ultrafast", "qp": "24"}
"""From how many pixels on H.264 is encoded twice as fast, into files several times as large."""
LUMA = np.array([0.299, 0.587, 0.114])
"""Shares of red, green and blue in brightness (ITU-R BT.601)."""


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
    ".gif": FilmFormat("gif", "gif", "pal8", 50, container_options={"loop": "0"}),
}


def film_format(path: Path, rate_hz: float | None) -> FilmFormat:
    """Return how a film of this name is written, if it can be at this rate."""
    form = FORMATS[check_destination(path, FORMATS, "to become a film")]
    if form.codec == "gif" and rate_hz is not None and rate_hz not in CENTISECONDS:
        raise ValueError(
            f"A GIF waits whole hundredths of a second between frames, so rate_hz={rate_hz:g} "
            f"would change the tempo of the walk; choose one of {sorted(CENTISECONDS)}, or an MP4."
        )
    if rate_hz is not None and not 1 <= rate_hz <= 240:
        raise ValueError(f"rate_hz={rate_hz:g} is no rate for a film; choose 1 to 240.")
    return form


def frame_delays(
    duration_s: float, rate_hz: float, form: FilmFormat, *, whole: bool
) -> list[Fraction]:
    """Seconds each frame stays; a film of whole strides lasts as long as they do."""
    if form.codec == "gif":
        hundredths = max(round(100 * duration_s), CENTISECONDS[int(rate_hz)])
        n_frames = hundredths // CENTISECONDS[int(rate_hz)]
        ends = [round(hundredths * frame / n_frames) for frame in range(n_frames + 1)]
        return [Fraction(b - a, 100) for a, b in itertools.pairwise(ends)]
    n_frames = max(round(duration_s * rate_hz), 1)
    delay = Fraction(duration_s / n_frames if whole else 1 / rate_hz)
    return [1 / (1 / delay).limit_denominator(1001)] * n_frames


def encode_film(
    frames: Iterable[np.ndarray],
    path: Path,
    *,
    shape: tuple[int, int],
    form: FilmFormat,
    delays: list[Fraction],
    shades: np.ndarray,
    progress: Progress | None = None,
) -> None:
    """Write frames as a film, which appears when it is complete.

    Frames are arrays of uint8 (row, column), both even: the number of each pixel's shade, 0 for the
    ground. `delays` are the seconds each stays; `shades` has red, green and blue of each number,
    shape (256, 3).
    """
    painted = _Gif(shades) if form.codec == "gif" else _Video(shape, shades)
    tick = delays[0] if form.codec != "gif" else Fraction(1, 100)
    options = dict(form.container_options)
    if form.codec == "gif":  # the last frame has no next one whose start ends it
        options["final_delay"] = str(round(100 * delays[-1]))
    with (
        atomic_write(path) as unfinished,
        av.open(str(unfinished), "w", format=form.container, options=options) as film,
    ):
        fast = form.codec == "libx264" and math.prod(shape) > LARGE_PX
        codec_options = FAST_OPTIONS if fast else form.options
        stream = cast(
            VideoStream, film.add_stream(form.codec, rate=1 / tick, options=codec_options)
        )
        stream.height, stream.width = shape
        stream.pix_fmt = form.pixels
        stream.codec_context.time_base = tick
        start = Fraction(0)
        timed = zip(frames, delays, strict=True)
        for cover, delay in ticked(timed, len(delays), progress):
            frame = painted.frame(cover)
            frame.time_base, frame.pts = tick, round(start / tick)
            frame.duration = round(delay / tick)
            film.mux(stream.encode(frame))
            start += delay
        film.mux(stream.encode())


class _Gif:
    """Numbers of shades as they are, and a palette of them."""

    def __init__(self, shades: np.ndarray) -> None:
        red, green, blue = np.rint(shades).astype(np.uint32).T
        argb = (255 << 24) | (red << 16) | (green << 8) | blue
        self.palette = argb.astype(">u4").view(np.uint8).reshape(256, 4)

    def frame(self, cover: np.ndarray) -> av.VideoFrame:
        return av.VideoFrame.from_ndarray((cover, self.palette), format="pal8")  # pyright: ignore[reportArgumentType] - takes a pair for pal8


class _Video:
    """Brightness of 16 to 235 and planes of colour, of which only what changes is painted.

    It is one frame over and over: both encoders copy what they are given before they return.
    """

    def __init__(self, shape: tuple[int, int], shades: np.ndarray) -> None:
        n_rows, n_columns = shape
        luma = shades @ LUMA
        blue = (shades[:, 2] - luma) / (2 - 2 * LUMA[2])
        red = (shades[:, 0] - luma) / (2 - 2 * LUMA[0])
        self.luma = np.rint(16 + luma * (219 / 255)).astype(np.uint8)
        self.chroma = np.rint(128 + np.stack([blue, red]) * (224 / 255)).astype(np.uint8)
        self.whole = av.VideoFrame(n_columns, n_rows, "yuv420p")
        self.picture, *self.colour = (_pixels(plane) for plane in self.whole.planes)
        self.grey = bool((self.chroma == self.chroma[:, :1]).all())
        self.painted = (slice(0, 0), slice(0, 0))
        for plane, shades in zip(self.colour, self.chroma, strict=True):
            plane[:] = shades[0]
        self._clear((slice(0, n_rows), slice(0, n_columns)))

    def frame(self, cover: np.ndarray) -> av.VideoFrame:
        box = _box(cover)
        self._clear(self.painted)
        self.picture[box] = self.luma.take(cover[box], mode="clip")
        if not self.grey and cover[box].size:
            half = _halved(box)
            rows, columns = (side.stop - side.start for side in half)
            for plane, shades in zip(self.colour, self.chroma, strict=True):
                corners = shades.take(cover[box]).reshape(rows, 2, columns, 2)
                plane[half] = corners.sum(axis=(1, 3), dtype=np.uint16) // 4
        self.painted = box
        return self.whole

    def _clear(self, box: tuple[slice, slice]) -> None:
        self.picture[box] = self.luma[0]
        if not self.grey:
            for plane, shades in zip(self.colour, self.chroma, strict=True):
                plane[_halved(box)] = shades[0]


def _halved(box: tuple[slice, slice]) -> tuple[slice, slice]:
    """The same part of a plane of colour, which has half the rows and columns."""
    rows, columns = (slice(side.start // 2, side.stop // 2) for side in box)
    return rows, columns


def _pixels(plane: VideoPlane) -> np.ndarray:
    """The memory of a plane as an array of shape (row, column)."""
    lines = np.frombuffer(memoryview(plane), np.uint8).reshape(-1, plane.line_size)  # pyright: ignore[reportArgumentType] - planes are buffers
    return lines[: plane.height, : plane.width]


def _box(cover: np.ndarray) -> tuple[slice, slice]:
    """Rows and columns, from even to even, outside which nothing is covered."""
    rows = np.flatnonzero(cover.max(axis=1))
    if not len(rows):
        return slice(0, 0), slice(0, 0)
    within = slice(rows[0] // 2 * 2, rows[-1] // 2 * 2 + 2)
    columns = np.flatnonzero(cover[within].max(axis=0))
    return within, slice(columns[0] // 2 * 2, columns[-1] // 2 * 2 + 2)
