"""Tables of positions: CSV for any program, TRC for OpenSim."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.io.errors import printable

CSV_TITLE = "# eigenwalker trajectories"
_NUMBER = "%.9g"


def write_csv(walk: xr.DataArray, unit: str, up: str, path: Path) -> None:
    """Write a CSV file: ``time_s``, then three columns a marker, ``head_x, head_y, head_z``.

    The first line is a comment that names unit, upward axis and number of frames, so that a file
    cut short is noticed; missing samples are empty.
    """
    columns = [f"{marker}_{axis}" for marker in walk.marker.values for axis in "xyz"]
    table = pd.DataFrame(walk.values.reshape(len(walk), -1), columns=pd.Index(columns))
    table.insert(0, "time_s", walk.time.values)
    with path.open("w", encoding="utf-8", newline="") as file:
        file.write(f"{CSV_TITLE}; unit: {unit}; up: {up}; frames: {len(walk)}\n")
        table.to_csv(file, index=False, float_format=_NUMBER, lineterminator="\n")


def write_trc(walk: xr.DataArray, unit: str, up: str, path: Path) -> None:
    """Write a TRC file, as OpenSim reads it; missing samples are empty."""
    del up
    names = [str(name) for name in walk.marker.values]
    if unfit := [name for name in names if not name.isprintable()]:
        raise ValueError(f"TRC files keep names between tabs, so rename the markers {unfit}.")
    rate = f"{sampling_rate(walk):.10g}"
    n_frames, n_markers = len(walk), len(names)
    head = [
        ["PathFileType", "4", "(X/Y/Z)", printable(str(walk.name or path.name))],
        ["DataRate", "CameraRate", "NumFrames", "NumMarkers", "Units",
         "OrigDataRate", "OrigDataStartFrame", "OrigNumFrames"],
        [rate, rate, str(n_frames), str(n_markers), unit, rate, "1", str(n_frames)],
        ["Frame#", "Time", *(column for name in names for column in (name, "", ""))],
        ["", "", *(f"{axis}{number}" for number in range(1, n_markers + 1) for axis in "XYZ")],
        [],
    ]  # fmt: skip
    table = pd.DataFrame(walk.values.reshape(n_frames, -1))
    table.insert(0, "time", walk.time.values)
    table.insert(0, "frame", np.arange(1, n_frames + 1))
    with path.open("w", encoding="utf-8", newline="") as file:
        file.writelines("\t".join(line) + "\n" for line in head)
        table.to_csv(
            file, sep="\t", header=False, index=False, float_format=_NUMBER, lineterminator="\n"
        )
