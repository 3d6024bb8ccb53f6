"""C3D files: trajectories of markers, as most laboratories keep them."""

from __future__ import annotations

import warnings
from importlib import import_module
from pathlib import Path

import numpy as np
import xarray as xr

from eigenwalker.core.trajectories import sampling_rate

_c3d = import_module("c3d")  # which has no types
MAX_MARKERS = 255
"""Names that one list of the format holds."""
MAX_NAME_LENGTH = 127


def write_c3d(walk: xr.DataArray, unit: str, up: str, path: Path) -> None:
    """Write a C3D file of 4-byte floats, Intel.

    Frame 1 is at 0 s. The format cannot hold a start between two frames or before 0 s.
    """
    names = [str(name).encode() for name in walk.marker.values]
    width = max(map(len, names))
    if len(names) > MAX_MARKERS or width > MAX_NAME_LENGTH:
        raise ValueError(
            f"A C3D file is written with {MAX_MARKERS} markers at most, whose names have up to "
            f"{MAX_NAME_LENGTH} bytes; here are {len(names)}, with up to {width}. "
            "Take some of them, or rename them, or write .csv or .nc."
        )
    rate_hz = sampling_rate(walk)
    writer = _c3d.Writer(point_rate=round(rate_hz, 6), point_units=unit)
    writer.point_group.add_param(
        "LABELS",
        desc="Marker names",
        bytes_per_element=-1,
        dimensions=[width, len(names)],
        bytes=b"".join(name.ljust(width) for name in names),
    )
    writer.set_screen_axis("+X", f"+{up.upper()}")
    writer.set_start_frame(max(1, 1 + round(float(walk.time.values[0]) * rate_hz)))
    missing = np.asarray(np.isnan(walk.values).any(axis=2))
    points = np.zeros((*missing.shape, 5), dtype=np.float32)
    points[..., :3] = np.where(missing[..., None], 0.0, walk.values)
    points[..., 3] = np.where(missing, -1.0, 0.0)
    writer.add_frames([(frame, np.empty((0, 0))) for frame in points])
    with path.open("wb") as file, warnings.catch_warnings():
        warnings.filterwarnings("ignore", "No analog data")  # there is none, on purpose
        writer.write(file)
