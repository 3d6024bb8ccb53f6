"""Writing a stimulus as a file; the suffix decides the format."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING

import numpy as np

from eigenwalker.core.atomic_write import atomic_write, check_destination
from eigenwalker.core.progress import Progress, ticked
from eigenwalker.stimulus.html_page import stand_alone_page
from eigenwalker.stimulus.rig_choices import RigChoices
from eigenwalker.stimulus.stimulus import Stimulus
from eigenwalker.stimulus.targets import check_target

if TYPE_CHECKING:
    from eigenwalker.stimulus.animation import Animation


def write_stimulus(
    stimulus: Stimulus,
    path: str | os.PathLike[str],
    *,
    progress: Progress | None = None,
    rig: RigChoices | None = None,
) -> Path:
    """Write a stimulus as a file, which appears when it is complete, and return its path.

    ======================== ==========================================================
    suffix                   what it is
    ======================== ==========================================================
    .json                    the stimulus file
    .mp4, .webm, .gif        a film
    .png, .svg               its first moment; for a folder (no suffix) all frames as PNG
    .csv, .npz, .mat         where each dot is in each frame: mm, pixels, degrees
    .py                      a PsychoPy script, and an .npz beside it
    .html                    a page that plays it in a browser
    .bvh, .glb               its first figure as a skeleton with constant bones that walks
    ======================== ==========================================================

    Parameters
    ----------
    stimulus : Stimulus
    path : path
        File to write, or to replace, or the folder of frames.
    progress : callable, optional
        Called with the number of frames done and of all, where frames are drawn.
    rig : RigChoices, optional
        Skeleton, pose at rest, place, unit and axes of .bvh and .glb.

    Returns
    -------
    Path

    Raises
    ------
    ValueError
        If the suffix is not known, or cannot hold this stimulus. What tables and skeletons leave
        out is warned of; ``docs/stimuli.md`` has a table of it.
    FileNotFoundError
        If the folder does not exist.

    See Also
    --------
    make_stimulus : Makes the stimulus.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> hop = ew.Walker(["foot"], [[0, 0, 50]], [[[0, 0, 40]]], [1], [0], 1.0)
    >>> with TemporaryDirectory() as folder:
    ...     path = ew.write_stimulus(ew.make_stimulus(hop), Path(folder) / "hop.svg")
    ...     path.read_text().startswith("<svg")
    True
    """
    path = Path(path)
    suffix = check_suffix(path)
    check_target(stimulus, path)
    if not suffix:
        _write_frames(stimulus, path, progress)
        return path
    with atomic_write(path) as unfinished:
        if suffix in FILMS:
            _write_film(stimulus, unfinished, progress)
        elif suffix == ".py":
            from eigenwalker.stimulus.position_tables import psychopy_script

            table = path.with_suffix(".npz")
            _write_text(psychopy_script(stimulus, table), unfinished)
            write_stimulus(stimulus, table)
        elif suffix in RIGS:
            from eigenwalker.stimulus.animation import animated

            choices = rig or RigChoices()
            figure = animated(stimulus, choices=choices, closed=suffix == ".glb")
            about = {**stimulus.provenance, "feet": str(figure.slide)}
            rate_hz = stimulus.timing.rate_hz
            write_animation(
                {"walker": figure}, unfinished, rate_hz=rate_hz, choices=choices, about=about
            )
        else:
            WRITERS[suffix](stimulus, unfinished)
    return path


def check_suffix(path: Path) -> str:
    """Return the suffix of a file that can be written; refuse others."""
    return check_destination(path, SUFFIXES if path.suffix else (), "to hold a stimulus")


def _write_film(stimulus: Stimulus, path: Path, progress: Progress | None) -> None:
    """Write a film; the suffix decides: ``.mp4``, ``.webm`` or ``.gif``.

    Its frames are those of the stimulus' rate. A GIF, whose delays are whole hundredths of a
    second, has 50 a second where the stimulus has another rate than 50, 25 or 20, and lasts as
    long. A picture of an odd size gets one more row or column of ground.
    """
    from eigenwalker.plotting.encoding import encode_film, film_format, frame_delays
    from eigenwalker.stimulus.drawing import drawn_frames, drawn_shades

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


def _write_frames(stimulus: Stimulus, folder: Path, progress: Progress | None) -> None:
    """Write every frame as a PNG into a folder: ``frame_0000.png``, ``frame_0001.png``, ...

    They appear once all are drawn.
    """
    from matplotlib.image import imsave

    from eigenwalker.stimulus.drawing import drawn_frames, drawn_shades

    times = stimulus.frame_times
    colours = np.rint(drawn_shades(stimulus)).astype(np.uint8)
    frames = drawn_frames(stimulus, times)
    folder.mkdir(parents=True, exist_ok=True)
    with TemporaryDirectory(prefix=".frames-", dir=folder) as unfinished:
        for number, shades in enumerate(ticked(frames, len(times), progress)):
            imsave(Path(unfinished, f"frame_{number:04d}.png"), colours[shades])
        for frame in sorted(Path(unfinished).iterdir()):
            frame.replace(folder / frame.name)


def _write_png(stimulus: Stimulus, path: Path) -> None:
    """Write the first moment as a PNG."""
    from matplotlib.image import imsave

    from eigenwalker.stimulus.drawing import drawn_frames, drawn_shades

    (shades,) = drawn_frames(stimulus, np.zeros(1))
    imsave(path, np.rint(drawn_shades(stimulus)).astype(np.uint8)[shades], format="png")


def _write_text(text: str, path: Path) -> None:
    path.write_text(text, encoding="utf-8")


def _write_svg(stimulus: Stimulus, path: Path) -> None:
    from eigenwalker.stimulus.svg import svg_drawing

    _write_text(svg_drawing(stimulus), path)


def _write_table(stimulus: Stimulus, path: Path) -> None:
    from eigenwalker.stimulus import position_tables

    write = {".csv": "write_csv", ".npz": "write_npz", ".mat": "write_mat"}[path.suffix.lower()]
    getattr(position_tables, write)(stimulus, path)


def write_animation(
    animations: Mapping[str, Animation],
    path: Path,
    *,
    rate_hz: float,
    choices: RigChoices,
    about: Mapping[str, str] | None = None,
) -> None:
    """Write figures that walk as rigs: one in a BVH, one or several, by name, in a GLB."""
    from eigenwalker.io.writers.bvh import write_rig
    from eigenwalker.stimulus.gltf import write_glb

    first = next(iter(animations.values()))
    if path.suffix.lower() == ".bvh":
        write_rig(first.rig, path, rate_hz=rate_hz, unit=choices.unit or "cm", up=choices.up)
        return
    if choices.up != "y":
        raise ValueError(f"up={choices.up!r}: a .glb has y up, by its standard; write .bvh.")
    rigs = {name: animation.rig for name, animation in animations.items()}
    unit = choices.unit or "m"
    write_glb(rigs, path, rate_hz=rate_hz, unit=unit, about=about)


FILMS = (".mp4", ".webm", ".gif")
WRITERS: dict[str, Callable[[Stimulus, Path], object]] = {
    ".json": lambda stimulus, path: _write_text(stimulus.to_json(), path),
    ".png": _write_png,
    ".svg": _write_svg,
    ".csv": _write_table,
    ".npz": _write_table,
    ".mat": _write_table,
    ".html": lambda stimulus, path: _write_text(stand_alone_page(stimulus), path),
}
RIGS = (".bvh", ".glb")
SUFFIXES = [*FILMS, *WRITERS, *RIGS, ".py"]
