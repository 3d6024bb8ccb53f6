"""``data3d`` text: 13 points of walks in the CMU collection, as some point-light software has it.

No header: for each frame a line of 13 x, one of y and one of z. Unit and frame are those of the
Acclaim skeletons (y up, inch/0.45), 120 frames a second, centred on the body. The order of points
was found from the walk 07_01: head; left shoulder, elbow, wrist; the same right; left hip, knee,
ankle; the same right.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import xarray as xr

from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.text_cells import refuse_cut_number, table_of
from eigenwalker.io.text_table import TableValues, table_trajectories
from eigenwalker.io.to_trajectories import FileFrame
from eigenwalker.io.up_axis_and_unit import UNITS, Unit

RATE_HZ = 120.0
POINTS = (
    "head",
    *(f"{side}_{joint}" for side in ("left", "right") for joint in ("shoulder", "elbow", "wrist")),
    *(f"{side}_{joint}" for side in ("left", "right") for joint in ("hip", "knee", "ankle")),
)


def looks_like_data3d(lines: Sequence[str]) -> bool:
    """Return whether each of the first lines holds 13 words between blanks."""
    return all(len(line.split()) == len(POINTS) for line in lines[:3]) and len(lines) >= 3


def read_data3d(file: CaptureFile) -> xr.DataArray:
    """Return the trajectories of the 13 points of a ``data3d`` text."""
    lines = file.lines
    table = table_of(file, lines, len(POINTS), separator=None, columns=range(len(POINTS)))
    refuse_cut_number(file, lines)
    positions = positions_of_rows(file, table)
    heights = dict(zip(POINTS, np.nanmedian(positions[..., 1], axis=0), strict=True))
    chain = ("head", "shoulder", "hip", "knee", "ankle")
    for side in ("left", "right"):
        body = [heights.get(part, heights.get(f"{side}_{part}", 0.0)) for part in chain]
        if not np.all(np.diff(body) < 0):
            raise file.error(
                f"heights that fall from head to {side} ankle, as data3d text has them",
                f"{[round(float(height), 3) for height in body]}",
                "if it is another table, put a description beside it (docs/formats.md)",
            )
    unit = Unit("asf", UNITS["asf"], "the unit of the CMU skeletons")
    reason = "as the CMU collection was recorded"
    rate_hz, assumed = file.frame_rate(None, usual_hz=RATE_HZ, reason=reason)
    return table_trajectories(
        file,
        TableValues(positions, attrs=assumed),
        POINTS,
        format_name="data3d",
        rate_hz=rate_hz,
        frame=FileFrame(None, unit, "y"),
    )


def positions_of_rows(file: CaptureFile, table: np.ndarray) -> np.ndarray:
    """Return a line of x, one of y and one of z a frame as an array (time, marker, 3)."""
    if len(table) % 3:
        raise file.error("three lines a frame", f"{len(table)}: the file is cut short")
    return table.reshape(-1, 3, table.shape[1]).transpose(0, 2, 1)
