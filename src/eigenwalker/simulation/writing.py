"""Simulated captures as files, with a table of who is who: a whole study to rehearse."""

from __future__ import annotations

import warnings
from collections.abc import Iterable
from pathlib import Path
from typing import Literal

import c3d
import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.simulation.traits import TRAITS
from eigenwalker.trajectories import sampling_rate

_TRC_KEYS = (
    "DataRate CameraRate NumFrames NumMarkers Units OrigDataRate OrigDataStartFrame OrigNumFrames"
)


def write_captures(
    captures: Iterable[tuple[xr.DataArray, pd.Series]],
    folder: str | Path,
    *,
    format: Literal["c3d", "trc", "csv"] = "c3d",
) -> Path:
    """Write captures into a folder, with a table of the traits and one of the truth.

    Captures are written as they come, so that no more than one is in memory.

    Parameters
    ----------
    captures : iterable of capture and person
        Such as `simulate_captures` yields, best with ``markers="skin"``.
    folder : path
        Made if need be.
    format : {"c3d", "trc", "csv"}
        C3D or TRC as motion capture systems write them, or a table with a column for each
        coordinate, in millimetres.

    Returns
    -------
    Path
        Of ``traits.csv``, whose column ``file`` names each capture; ``truth.csv`` beside it holds
        all parameters of each person.

    Raises
    ------
    ValueError
        If the format is unknown.

    Examples
    --------
    >>> import tempfile
    >>> from eigenwalker.simulation import simulate_captures
    >>> folder = Path(tempfile.mkdtemp())
    >>> write_captures(simulate_captures(1, 1, duration_s=2), folder, format="csv").name
    'traits.csv'
    >>> sorted(path.name for path in folder.iterdir())
    ['traits.csv', 'truth.csv', 'walker_0001.csv', 'walker_0002.csv']

    """
    writers = {"c3d": _write_c3d, "trc": _write_trc, "csv": _write_csv}
    if format not in writers:
        raise ValueError(f"format={format!r} is not known; give one of {sorted(writers)}.")
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    people = []
    for number, (walk, person) in enumerate(captures, start=1):
        file = f"walker_{number:04}.{format}"
        writers[format](walk, folder / file)
        people.append({"file": file, **person.to_dict()})
    table = pd.DataFrame(people)
    table[["file", *TRAITS]].to_csv(folder / "traits.csv", index=False)
    table.to_csv(folder / "truth.csv", index=False)
    return folder / "traits.csv"


def _write_csv(walk: xr.DataArray, path: Path) -> None:
    columns = [f"{marker}_{axis}" for marker in walk.marker.values for axis in walk.axis.values]
    table = pd.DataFrame(walk.values.reshape(len(walk), -1), columns=columns)
    table.insert(0, "time_s", walk.time.values)
    table.round(5).to_csv(path, index=False)


def _write_trc(walk: xr.DataArray, path: Path) -> None:
    rate, names = f"{sampling_rate(walk):g}", [str(name) for name in walk.marker.values]
    n_frames = str(len(walk))
    lines = [
        ["PathFileType", "4", "(X/Y/Z)", path.name],
        _TRC_KEYS.split(),
        [rate, rate, n_frames, str(len(names)), "mm", rate, "1", n_frames],
        ["Frame#", "Time", *(cell for name in names for cell in (name, "", ""))],
        ["", "", *(f"{axis}{n}" for n in range(1, len(names) + 1) for axis in "XYZ")],
        [],
    ]
    table = walk.values.reshape(len(walk), -1)
    for number, (time, row) in enumerate(zip(walk.time.values, table, strict=True), start=1):
        seen = ["" if np.isnan(value) else f"{value:.5f}" for value in row]
        lines.append([str(number), f"{time:.6f}", *seen])
    path.write_text("\n".join("\t".join(line) for line in lines) + "\n", encoding="utf-8")


def _write_c3d(walk: xr.DataArray, path: Path) -> None:
    writer = c3d.Writer(point_rate=round(sampling_rate(walk), 6), point_units="mm")
    writer.set_point_labels([str(name) for name in walk.marker.values])
    writer.set_screen_axis("+X", "+Z")
    missing = np.asarray(np.isnan(walk.values).any(axis=2))
    points = np.zeros((*missing.shape, 5), dtype=np.float32)
    points[..., :3] = np.where(missing[..., None], 0.0, walk.values)
    points[..., 3] = np.where(missing, -1.0, 0.0)
    writer.add_frames([(frame, np.empty((0, 0))) for frame in points])
    with path.open("wb") as stream, warnings.catch_warnings():
        warnings.filterwarnings("ignore", "No analog data")  # there is none, on purpose
        writer.write(stream)
