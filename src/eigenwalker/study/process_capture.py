"""The one pipeline from a capture to a walker, each step once."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pandas as pd
import xarray as xr

from eigenwalker.core.arguments import check_kind
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import check_trajectories
from eigenwalker.core.walker import Form, Walker
from eigenwalker.decomposition.fourier import decompose_fourier
from eigenwalker.decomposition.pca import decompose_pca
from eigenwalker.gait.gaps import find_gaps
from eigenwalker.gait.heading import known_speed
from eigenwalker.gait.in_place import in_place
from eigenwalker.io.read import read_mocap
from eigenwalker.markers.label_repair import Repair
from eigenwalker.markers.mapping import MarkerMapping
from eigenwalker.markers.virtual_markers import virtual_markers
from eigenwalker.quality.assessment import CaptureRecord, judge, names_in
from eigenwalker.quality.quality import Quality

DECOMPOSE = {"eigenposture": decompose_pca, "fourier": decompose_fourier}

_WHERE = ["marker", "kind", "first_frame", "last_frame"]


@dataclass(frozen=True, eq=False)
class CaptureResult:
    """What a capture gave: its walk, its walker, and what is wrong with it.

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        The steady strides in place, facing +x (`in_place`), in millimetres.
    walker : Walker
        The 15 joints of this walk, decomposed.
    quality : Quality
        The assessment of this very walk and its capture.
    repairs : DataFrame
        Labels that were repaired, and jumps, one row each (`eigenwalker.markers.Repair`):
        ``marker``, ``kind`` ("swap", "flicker", "jump"), ``first_frame``, ``last_frame`` of the
        capture, and ``partner``, the other marker of a swap.
    gaps : DataFrame
        Frames without a joint: ``marker``, ``kind`` ("filled" among the steady strides, "unused"
        before or after them), ``first_frame``, ``last_frame``.
    left_out : DataFrame
        What the walk does not hold: ``marker``, ``kind`` ("unlabelled" points of the file, "still"
        points of the room, joints "hidden" for too long, frames "before" and "after" the steady
        strides, of all markers), ``first_frame``, ``last_frame``.
    capture : DataArray of shape (time, marker, axis)
        As it was read.

    See Also
    --------
    process_capture : makes it.
    """

    walk: xr.DataArray
    walker: Walker
    quality: Quality
    repairs: pd.DataFrame
    gaps: pd.DataFrame
    left_out: pd.DataFrame
    capture: xr.DataArray


class NoWalkError(ValueError):
    """A capture gives no walker; ``joints`` and ``quality`` are what is known of it.

    See Also
    --------
    process_capture : raises it.
    """

    def __init__(self, message: str, joints: xr.DataArray, quality: Quality) -> None:
        super().__init__(message)
        self.joints = joints
        self.quality = quality


def process_capture(
    path_or_capture: str | Path | xr.DataArray,
    *,
    form: Form = "eigenposture",
    n_harmonics: int = 2,
    joints: Literal["walker", "full"] = "walker",
    low_pass_hz: float | None = None,
    speed_mm_s: float | None = None,
    heading_deg: float | None = None,
    mapping: MarkerMapping | Mapping[str, Any] | str | Path | None = None,
    **reading: Any,
) -> CaptureResult:
    """Return the walk in place, the walker and the quality of a capture.

    The capture is read (`read_mocap`), labels are repaired and joints made of its markers
    (`virtual_markers`), steady strides are brought in place (`in_place`), decomposed
    (`decompose_pca` or `decompose_fourier`) and judged. Each step runs once.

    Parameters
    ----------
    path_or_capture : str, Path, or DataArray of shape (time, marker, axis)
        A capture of any format that `read_mocap` reads, or one that is read already.
    form : {"eigenposture", "fourier"}
        Decomposition of the walk: principal components or a Fourier series.
    n_harmonics : int
        Multiples of the stride frequency in the walker.
    joints : {"walker", "full"}
        Whether the walk holds the 15 joints, or feet, hands and captured rotations too. The walker
        and the quality are those of the 15 joints.
    low_pass_hz, speed_mm_s, heading_deg : float, optional
        Cut-off of a low-pass filter, and speed and direction of a walk on a treadmill, as
        `in_place` takes them. Left out, they are those of a walk that is in place already.
    mapping : optional
        Markers with names of your own, as `virtual_markers` takes it.
    **reading
        As `read_mocap` takes them, such as ``unit`` and ``rate_hz``.

    Returns
    -------
    CaptureResult

    Raises
    ------
    UnreadableFile
        If the file cannot be read.
    NoWalkError
        If the capture holds no steady walk, or one that cannot be decomposed.
    ValueError
        If the joints are not known.

    See Also
    --------
    fit_folder : the same for all captures of a folder.
    reasons : what speaks against a capture, in sentences.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = ew.write_mocap(ew.simulate_walk(seed=1), f"{folder}/walk.c3d")
    ...     result = process_capture(file)
    >>> result.walker
    Walker(15 markers, 4 postures in the eigenposture form, 0.86... Hz, r2 0.99...)
    >>> result.quality.verdict, result.quality.n_strides, len(result.repairs)
    ('use', 10, 0)
    """
    if isinstance(path_or_capture, xr.DataArray):
        if reading:
            raise TypeError(f"{list(reading)} are for files; this capture is read already.")
        capture = check_trajectories(path_or_capture)
    else:
        check_kind(path_or_capture, (str, Path), "a path or trajectories")
        capture = read_mocap(path_or_capture, **reading)
    if "speed_mm_s" in capture.coords:  # it is in place already
        speed = known_speed(capture)
        speed_mm_s = speed if speed_mm_s is None and np.isfinite(speed) else speed_mm_s
        heading_deg = 0.0 if heading_deg is None else heading_deg
    if joints == "full":
        from eigenwalker.metric.comparison_pipeline import full_joints

        points = full_joints(capture, mapping)
        main = points.sel(marker=list(JOINTS.markers))
    else:
        points = main = virtual_markers(capture, mapping=mapping)
    main_walk = None
    try:
        walk = in_place(
            points,
            low_pass_hz=low_pass_hz,
            speed_mm_s=speed_mm_s,
            heading_deg=heading_deg,
            repair=False,
        )
        main_walk = walk.sel(marker=list(JOINTS.markers)) if joints == "full" else walk
        walker = DECOMPOSE[form](main_walk, n_harmonics=n_harmonics)
    except ValueError as error:
        quality = judge(main, main, main_walk, CaptureRecord.of(main), str(error), labelled=capture)
        raise NoWalkError(str(error), main, quality) from error
    return CaptureResult(
        walk=walk,
        walker=walker,
        quality=judge(main, main, main_walk, CaptureRecord.of(main), labelled=capture),
        repairs=pd.DataFrame(points.attrs.get("repairs", ()), columns=Repair._fields),
        gaps=pd.DataFrame(_gaps(points, walk), columns=_WHERE),
        left_out=pd.DataFrame(_left_out(points, walk), columns=_WHERE),
        capture=capture,
    )


def _frames(points: xr.DataArray, walk: xr.DataArray) -> tuple[int, int]:
    """Return the first frame of the steady strides, and the first one after them."""
    start = int(np.searchsorted(points.time.values, walk.time.values[0]))
    return start, start + len(walk)


def _gaps(points: xr.DataArray, walk: xr.DataArray) -> Iterator[tuple[str, str, int, int]]:
    start, stop = _frames(points, walk)
    for gap in find_gaps(points.values):
        kind = "filled" if gap.start < stop and gap.stop > start else "unused"
        yield str(points.marker.values[gap.marker]), kind, gap.start, gap.stop - 1


def _left_out(points: xr.DataArray, walk: xr.DataArray) -> Iterator[tuple[str, str, int, int]]:
    start, stop = _frames(points, walk)
    last = len(points) - 1
    kinds = {"left_out": "unlabelled", "still_points": "still", "hidden_markers": "hidden"}
    for attribute, kind in kinds.items():
        for name in names_in(walk, attribute):
            yield name, kind, 0, last
    if start > 0:
        yield "", "before", 0, start - 1
    if stop <= last:
        yield "", "after", stop, last
