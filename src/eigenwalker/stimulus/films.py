"""Stimuli as films and pictures: MP4, WebM, GIF, frames as PNG."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.image import imsave

from eigenwalker.core.progress import Progress
from eigenwalker.plotting.encoding import encode_film, film_format, frame_delays
from eigenwalker.stimulus.drawing import drawn_frames, drawn_shades
from eigenwalker.stimulus.stimulus import Stimulus


def write_stimulus_film(stimulus: Stimulus, path: Path, progress: Progress | None = None) -> None:
    """Write a film; the suffix decides: ``.mp4``, ``.webm`` or ``.gif``.

    Its frames are those of the stimulus' rate. A GIF, whose delays are whole hundredths of a
    second, has 50 a second where the stimulus has another rate than 50, 25 or 20, and lasts as
    long. A picture of an odd size gets one more row or column of ground.
    """
    rate_hz = stimulus.timing.rate_hz
    gif = path.suffix.lower() == ".gif"
    form = film_format(path, None if gif and rate_hz not in (50, 25, 20) else rate_hz)
    if gif and rate_hz not in (50, 25, 20):
        rate_hz = form.rate_hz
    delays = frame_delays(stimulus.timing.duration_s, rate_hz, form, whole=False)
    starts = np.cumsum([0.0, *map(float, delays[:-1])])
    display = stimulus.display
    shape = (display.height_px + display.height_px % 2, display.width_px + display.width_px % 2)
    encode_film(
        drawn_frames(stimulus, starts, shape=shape),
        path,
        shape=shape,
        form=form,
        delays=delays,
        shades=drawn_shades(stimulus),
        progress=progress,
    )


def write_frames(stimulus: Stimulus, folder: Path, progress: Progress | None = None) -> None:
    """Write every frame as a PNG into a folder: ``frame_0000.png``, ``frame_0001.png``, ..."""
    folder.mkdir(parents=True, exist_ok=True)
    times = stimulus.frame_times
    colours = np.rint(drawn_shades(stimulus)).astype(np.uint8)
    for number, shades in enumerate(drawn_frames(stimulus, times)):
        imsave(folder / f"frame_{number:04d}.png", colours[shades])
        if progress is not None:
            progress(number + 1, len(times))


def write_png(stimulus: Stimulus, path: Path, time_s: float = 0.0) -> None:
    """Write one moment as a PNG."""
    (shades,) = drawn_frames(stimulus, np.array([time_s]))
    imsave(path, np.rint(drawn_shades(stimulus)).astype(np.uint8)[shades], format="png")
