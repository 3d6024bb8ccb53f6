"""One function for all formats: the suffix of the file decides which writer takes it."""

from __future__ import annotations

import os
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Literal, NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.arguments import check_choice
from eigenwalker.core.atomic_write import atomic_write, check_destination
from eigenwalker.core.trajectories import MILLIMETRES, check_trajectories, sampling_rate
from eigenwalker.core.walker import Walker
from eigenwalker.io.to_trajectories import with_coordinate
from eigenwalker.io.up_axis_and_unit import turn_upright
from eigenwalker.io.writers.bvh import write_bvh
from eigenwalker.io.writers.c3d import write_c3d
from eigenwalker.io.writers.csv_trc import write_csv, write_trc
from eigenwalker.io.writers.netcdf import write_netcdf

Up = Literal["y", "z"]
RATE_HZ = 120.0
"""Frames a second if none are named: those of the captures in Troje (2002)."""
N_STRIDES = 4
MAX_FRAMES = 10_000_000


class Format(NamedTuple):
    """A format that is written: its usual unit and upward axis, and its writer."""

    unit: str
    up: Up
    write: Callable[[xr.DataArray, str, Up, Path], None]


FORMATS = {
    ".bvh": Format("cm", "y", write_bvh),
    ".c3d": Format("mm", "z", write_c3d),
    ".csv": Format("mm", "z", write_csv),
    ".nc": Format("mm", "z", write_netcdf),
    ".trc": Format("mm", "y", write_trc),
}
"""Every format that is written, by suffix.

A writer takes positions in the unit and frame of the file, the unit, the upward axis, and the path.
"""


def write_mocap(
    trajectories: xr.DataArray | Walker,
    path: str | os.PathLike[str],
    *,
    n_strides: int | None = None,
    duration_s: float | None = None,
    rate_hz: float | None = None,
    overground: bool = False,
    unit: str | None = None,
    up: Up | None = None,
    skeleton: str = "plain",
    rest_pose: str = "t",
) -> Path:
    """Write trajectories, or a walker that walks, as a file of motion capture.

    ======= ==== == ========================================================================
    suffix  unit up content
    ======= ==== == ========================================================================
    .bvh    cm   y  a skeleton with constant bones, from the 15 joints (see `constant_bones`)
    .c3d    mm   z  the markers, as 4-byte floats
    .csv    mm   z  ``time_s``, then ``head_x, head_y, head_z, ...``; a first line names unit and up
    .nc     mm   z  NetCDF 3: the trajectories as they are, to be opened with xarray
    .trc    mm   y  the markers, as OpenSim reads them
    ======= ==== == ========================================================================

    With y up, the body faces z and has x to its left. The file appears whole or not at all.

    Parameters
    ----------
    trajectories : DataArray of shape (time, marker, axis), or Walker
        Positions in millimetres; NaN is missing, which BVH cannot hold.
    path : str or path
        File to write, or to replace.
    n_strides : int, optional
        Length of a walker's walk in strides; 4 if neither this nor `duration_s` is given.
    duration_s : float, optional
        Its length in seconds.
    rate_hz : float, optional
        Frames a second of a walker; 120 if left out.
    overground : bool
        Whether to put forward progress back, from the walker's ``speed_mm_s`` (of trajectories that
        walk in place, ``attrs["speed_mm_s"]``).
    unit : {"um", "mm", "cm", "dm", "m", "in", "ft"}, optional
        Unit of length in the file.
    up : {"y", "z"}, optional
        Axis that points up in the file.
    skeleton : {"plain", "mixamo", "unreal", "unity"}
        Names and hierarchy of the bones of a BVH file; plain ones are called as the joints.
    rest_pose : {"t", "a"}
        Pose of its arms at rest.

    Returns
    -------
    Path
        The file written.

    Raises
    ------
    ValueError
        If the suffix or a choice is not known, or the format cannot hold these trajectories.
    FileNotFoundError
        If the folder does not exist.

    See Also
    --------
    read_mocap : Reads these files back.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> hop = ew.Walker(["foot"], [[0, 0, 50]], [[[0, 0, 40]]], [1], [0], 1.0)
    >>> with TemporaryDirectory() as folder:
    ...     path = write_mocap(hop, Path(folder) / "hop.csv", n_strides=1, rate_hz=4)
    ...     print(path.read_text())
    # eigenwalker trajectories; unit: mm; up: z; frames: 4
    time_s,foot_x,foot_y,foot_z
    0,0,0,50
    0.25,0,0,90
    0.5,0,0,50
    0.75,0,0,10
    <BLANKLINE>
    """
    path = Path(path)
    form = _format_of(path)
    unit, up = unit or form.unit, up or form.up
    check_choice(unit, sorted(MILLIMETRES), "unit")
    check_choice(up, ("y", "z"), "up")
    write = form.write
    if path.suffix.lower() == ".bvh":
        write = partial(write_bvh, skeleton=skeleton, rest_pose=rest_pose)
    elif (skeleton, rest_pose) != ("plain", "t"):
        typed = f"skeleton={skeleton!r}" if skeleton != "plain" else f"rest_pose={rest_pose!r}"
        raise ValueError(f"{typed} is for .bvh; {path.name!r} has no bones.")
    if isinstance(trajectories, Walker):
        walk = _sampled_walk(trajectories, n_strides, duration_s, rate_hz or RATE_HZ)
    elif (n_strides, duration_s, rate_hz) != (None, None, None):
        raise ValueError(
            "n_strides, duration_s and rate_hz are for walkers; these are trajectories, which are "
            "written as they are."
        )
    else:
        walk = check_trajectories(trajectories)
    if overground:
        walk = _with_progress(walk)
    sampling_rate(walk)  # which refuses uneven times
    turned = walk.copy(data=walk.values @ turn_upright(up) / MILLIMETRES[unit]).rename(path.name)
    with atomic_write(path) as unfinished:
        write(turned, unit, up, unfinished)
    return path


def _format_of(path: Path) -> Format:
    return FORMATS[check_destination(path, FORMATS, "to hold a capture")]


def _sampled_walk(
    walker: Walker, n_strides: int | None, duration_s: float | None, rate_hz: float
) -> xr.DataArray:
    """Return a walker's trajectories in place; its clock starts when its first phase is 0."""
    if n_strides is not None and duration_s is not None:
        raise ValueError("n_strides and duration_s are both given; give one.")
    if duration_s is None:
        duration_s = (N_STRIDES if n_strides is None else n_strides) * walker.period_s
    if not duration_s > 0 or not rate_hz > 0 or not 2 <= duration_s * rate_hz <= MAX_FRAMES:
        raise ValueError(
            f"{duration_s:g} s at {rate_hz:g} Hz are {duration_s * rate_hz:g} frames; "
            f"choose 2 to {MAX_FRAMES} of them."
        )
    time = np.arange(round(duration_s * rate_hz)) / rate_hz
    walk = with_coordinate(walker.trajectories(walker.time_origin_s + time), "time", time)
    return walk.assign_attrs(speed_mm_s=walker.speed_mm_s)


def _with_progress(walk: xr.DataArray) -> xr.DataArray:
    speed = float(walk.attrs.get("speed_mm_s", np.nan))
    if not np.isfinite(speed):
        raise ValueError(
            "overground=True puts forward progress back, but the speed of this walk is not known; "
            "give a Walker its speed_mm_s, or trajectories attrs['speed_mm_s']."
        )
    values = walk.values.copy()
    values[..., 0] += speed * (walk.time.values - walk.time.values[0])[:, None]
    return walk.copy(data=values)
