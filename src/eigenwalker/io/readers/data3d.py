"""``data3d`` text: 13 points of walks in the CMU collection, as some point-light software has it.

No header: for each frame a line of 13 x, one of y and one of z. Unit and frame are those of the
Acclaim skeletons (y up, inch/0.45), 120 frames a second, centred on the body. The order of points
was told from the walk 07_01: head; left shoulder, elbow, wrist; the same right; left hip, knee,
ankle; the same right.
"""

from __future__ import annotations

import numpy as np
import xarray as xr

from eigenwalker.io.assumed_rate import assume_rate
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.text_table import lines_of, refuse_cut_number, table_of
from eigenwalker.io.to_trajectories import as_captured
from eigenwalker.io.up_axis_and_unit import UNITS, Unit

RATE_HZ = 120.0
POINTS = (
    "head",
    *(f"{side}_{joint}" for side in ("left", "right") for joint in ("shoulder", "elbow", "wrist")),
    *(f"{side}_{joint}" for side in ("left", "right") for joint in ("hip", "knee", "ankle")),
)


def looks_like_data3d(lines: list[str]) -> bool:
    """Return whether each of the first lines holds 13 words between blanks."""
    return all(len(line.split()) == len(POINTS) for line in lines[:3]) and len(lines) >= 3


def read_data3d(
    content: bytes, *, source: str, unit: Unit | None = None, rate_hz: float | None = None
) -> xr.DataArray:
    """Return where the 13 points of a ``data3d`` text are.

    Parameters
    ----------
    content : bytes
        The whole file.
    source : str
        Its name, for messages.
    unit : Unit, optional
        Unit of its lengths, if it is not that of the CMU skeletons.
    rate_hz : float, optional
        Frames a second; 120 are assumed, with a warning.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        In millimetres, z up.

    Raises
    ------
    UnreadableFile
        If it is cut short, or its points do not stand as those of a body.

    """
    lines = lines_of(content, source)
    table = table_of(lines, len(POINTS), separator=None, source=source)
    refuse_cut_number(content, lines, source)
    if len(table) % 3:
        came = f"{len(table)}: the file is cut short"
        raise UnreadableFile(source, "three lines a frame", came)
    positions = table.reshape(-1, 3, len(POINTS)).transpose(0, 2, 1)
    heights = dict(zip(POINTS, np.nanmedian(positions[..., 1], axis=0), strict=True))
    chain = ("head", "shoulder", "hip", "knee", "ankle")
    for side in ("left", "right"):
        body = [heights.get(part, heights.get(f"{side}_{part}", 0.0)) for part in chain]
        if not np.all(np.diff(body) < 0):
            raise UnreadableFile(
                source,
                f"heights that fall from head to {side} ankle, as data3d text has them",
                f"{[round(float(height), 3) for height in body]}",
                "if it is another table, put a description beside it (docs/formats.md)",
            )
    reason = "as the CMU collection was recorded"
    assumed = {} if rate_hz else assume_rate(RATE_HZ, source=source, reason=reason)
    walk = as_captured(
        positions,
        POINTS,
        rate_hz=rate_hz or RATE_HZ,
        source=source,
        format_name="data3d",
        unit=unit,
        usual_unit=Unit("asf", UNITS["asf"], "the unit of the CMU skeletons"),
        up="y",
    )
    walk.attrs.update(assumed)
    return walk
