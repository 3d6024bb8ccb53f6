"""Stimuli as films and pictures: MP4, WebM, GIF, frames as PNG, drawings as SVG."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from matplotlib.image import imsave

from eigenwalker.core.progress import Progress
from eigenwalker.plotting.encoding import encode_film, film_format, frame_delays
from eigenwalker.stimulus.drawing import (
    drawn_frames,
    drawn_shades,
    hulls_of,
    look_of,
    mannequins,
    places_px,
)
from eigenwalker.stimulus.outlines import svg_hulls
from eigenwalker.stimulus.stimulus import Stimulus


def write_film(stimulus: Stimulus, path: Path, progress: Progress | None = None) -> None:
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


def write_svg(stimulus: Stimulus, path: Path, time_s: float = 0.0) -> None:
    """Write one moment as a drawing: circles, lines between them, blobs and limbs as gradients."""
    path.write_text(drawing(stimulus, time_s), encoding="utf-8")


def drawing(stimulus: Stimulus, time_s: float = 0.0) -> str:
    """Return one moment as SVG, in pixels of the stimulus.

    Each circle has the name of its dot as its ``class``, and that of its figure's number; pieces of
    mannequins have the class ``wood``.

    Examples
    --------
    >>> from eigenwalker.stimulus import make_stimulus
    >>> hop = ew.Walker(["foot"], [[0, 0, 50]], [[[0, 0, 40]]], [1], [0], 1.0)
    >>> drawing(make_stimulus(hop)).count("<circle")
    1

    """
    display = stimulus.display
    played = stimulus.play([time_s])
    places = places_px(stimulus, played)[0]
    lines = [
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{display.width_px}" '
        f'height="{display.height_px}" viewBox="0 0 {display.width_px} {display.height_px}">',
        f'<rect width="100%" height="100%" fill="{display.background}"/>',
    ]
    figures = stimulus.scene
    bodies = mannequins(stimulus)
    if bodies:
        look = look_of(stimulus, (display.height_px, display.width_px))
        look = look._replace(middle_px=(display.width_px / 2, display.height_px / 2))
        lines += svg_hulls(hulls_of(stimulus, bodies, played, 0), look, display.colour)
    first = 0
    for number, figure in enumerate(figures):
        if number in bodies:
            first += len(figure.dots)
            continue
        shown = range(first, first + len(figure.dots))
        seen = played.visible[0, first : first + len(figure.dots)]
        spot = places[first : first + len(figure.dots)]
        if display.style == "sticks" and figure.blur_mm == 0:
            lines += _svg_sticks(figure.skeleton, spot, seen, display.dot_px, display.colour)
        radius, fill = display.dot_px / 2, display.colour
        if figure.blur_mm > 0:
            radius, fill = 3.6 * figure.blur_mm * display.px_per_mm, f"url(#blob{number})"
            lines.append(_svg_blob(number, display.colour))
        lines += [
            f'<circle class="figure{number} {_name(played.dots[dot])}" '
            f'cx="{places[dot, 0]:.4f}" cy="{places[dot, 1]:.4f}" r="{radius:.4f}" fill="{fill}"/>'
            for dot in shown
            if played.visible[0, dot]
        ]
        first += len(figure.dots)
    return "\n".join([*lines, "</svg>", ""])


def _svg_sticks(skeleton, places, seen, dot_px: float, colour: str) -> list[str]:
    ends = [(skeleton.index(one), skeleton.index(other)) for one, other in skeleton.segments]
    return [
        f'<line x1="{places[a, 0]:.4f}" y1="{places[a, 1]:.4f}" x2="{places[b, 0]:.4f}" '
        f'y2="{places[b, 1]:.4f}" stroke="{colour}" stroke-width="{max(0.6 * dot_px, 1):.4f}" '
        'stroke-linecap="round"/>'
        for a, b in ends
        if seen[a] and seen[b]
    ]


def _svg_blob(number: int, colour: str) -> str:
    """A gradient that falls as a Gaussian does, to 3.6 standard deviations."""
    stops = "".join(
        f'<stop offset="{share:.3f}" stop-color="{colour}" '
        f'stop-opacity="{np.exp(-((3.6 * share) ** 2) / 2):.4f}"/>'
        for share in np.linspace(0, 1, 19)
    )
    return f'<radialGradient id="blob{number}">{stops}</radialGradient>'


def _name(dot: str) -> str:
    """A dot's name as a class: letters, digits and underlines."""
    return "".join(letter if letter.isalnum() and letter.isascii() else "_" for letter in dot)
