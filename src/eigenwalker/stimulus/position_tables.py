"""Where every dot is in every frame: CSV, NPZ, MAT for Psychtoolbox, a PsychoPy script."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from eigenwalker.core.atomic_write import write_table
from eigenwalker.plotting.shades import rgb
from eigenwalker.stimulus.drawing import places_px
from eigenwalker.stimulus.stimulus import Stimulus


def positions_table(stimulus: Stimulus) -> pd.DataFrame:
    """Return one row for each dot of each frame.

    Columns: ``frame, time_s, figure, dot, visible``; ``x_mm, y_mm, z_mm`` in the scene; ``right_mm,
    up_mm`` in the picture at the walker's scale; ``x_px, y_px`` from the upper left; and, where the
    stimulus states its screen, ``right_deg, up_deg`` of visual angle from the middle.
    """
    arrays = frame_arrays(stimulus)
    n_frames, n_dots = arrays["visible"].shape
    table = {
        "frame": np.repeat(np.arange(n_frames), n_dots),
        "time_s": np.repeat(arrays["time_s"], n_dots),
        "figure": np.tile(arrays["figure"], n_frames),
        "dot": np.tile(arrays["dots"].astype(object), n_frames),
        "visible": arrays["visible"].ravel().astype(int),
    }
    columns = {"mm": "xyz", "picture_mm": ("right_mm", "up_mm"), "px": ("x_px", "y_px")}
    for name, axes in {**columns, "deg": ("right_deg", "up_deg")}.items():
        if name in arrays:
            for axis, values in zip(axes, np.moveaxis(arrays[name], -1, 0), strict=True):
                table[f"{axis}_mm" if name == "mm" else axis] = values.ravel()
    return pd.DataFrame(table)


def frame_arrays(stimulus: Stimulus) -> dict[str, np.ndarray]:
    """Return dots frame by frame as arrays.

    ``time_s`` (frame), ``dots`` and ``figure`` (dot), ``visible`` (frame, dot), ``mm`` (frame, dot,
    3) in the scene, ``picture_mm``, ``px`` and, if the screen is stated, ``deg`` (frame, dot, 2).
    """
    played = stimulus.play()
    arrays = {
        "time_s": played.time,
        "dots": np.array(played.dots),
        "figure": played.figures,
        "visible": played.visible,
        "mm": played.positions,
        "picture_mm": played.picture,
        "px": places_px(stimulus, played),
    }
    display = stimulus.display
    if display.viewing_distance_mm is not None and display.px_per_cm is not None:
        on_screen = played.picture * display.px_per_mm / display.px_per_cm * 10
        arrays["deg"] = np.rad2deg(np.arctan2(on_screen, display.viewing_distance_mm))
    return arrays


def write_csv(stimulus: Stimulus, path: Path) -> None:
    """Write `positions_table` with commas."""
    write_table(positions_table(stimulus), path, index=False, float_format="%.9g")


def write_npz(stimulus: Stimulus, path: Path) -> None:
    """Write `frame_arrays`, and the stimulus file as the text ``stimulus``."""
    with path.open("wb") as file:
        arrays: dict[str, Any] = frame_arrays(stimulus)
        np.savez_compressed(file, **arrays, stimulus=np.array(stimulus.to_json()))


def write_mat(stimulus: Stimulus, path: Path) -> None:
    """Write `frame_arrays` as MATLAB reads them.

    For Psychtoolbox there is ``xy`` (2, dot, frame), pixels right and down from the middle of the
    picture, NaN where a dot is not seen: ``Screen('DrawDots', window, xy(:,ok,frame), dot_px,
    colour, [xc yc], 1)`` draws a frame, where ``ok = ~isnan(xy(1,:,frame))``.
    """
    from scipy.io import savemat

    arrays = frame_arrays(stimulus)
    display = stimulus.display
    middle = np.array([display.width_px, display.height_px]) / 2
    about = np.where(arrays["visible"][..., None], arrays["px"] - middle, np.nan)
    content = {
        **arrays,
        "dots": arrays["dots"].astype(object),
        "figure": arrays["figure"] + 1.0,
        "visible": arrays["visible"].astype(float),
        "xy": about.transpose(2, 1, 0),
        "dot_px": display.dot_px,
        "rate_hz": stimulus.timing.rate_hz,
        "colour": np.array(rgb(display.colour), dtype=float),
        "background": np.array(rgb(display.background), dtype=float),
        "stimulus": stimulus.to_json(),
    }
    with path.open("wb") as file:
        savemat(file, content, do_compression=True)


def psychopy_script(stimulus: Stimulus, table: Path) -> str:
    """Return a script that shows a stimulus, whose positions are in an ``.npz`` beside it.

    Names stand in it as literals of ASCII only, so that none can become code.
    """
    display = stimulus.display
    script = files("eigenwalker.stimulus").joinpath("psychopy_script.txt").read_text("utf-8")
    return script.format(
        name=table.stem,
        program=stimulus.provenance.get("program", "eigenwalker"),
        table=table.name,
        width=display.width_px,
        height=display.height_px,
        background=display.background,
        colour=display.colour,
        dot_px=display.dot_px,
        duration=stimulus.timing.duration_s,
        rate=stimulus.timing.rate_hz,
    )
