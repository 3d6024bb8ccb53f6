"""The assessment of a capture: how tall and how rigid the body is, how steady its strides are."""

from __future__ import annotations

from typing import Any, NamedTuple, Self

import numpy as np
import xarray as xr

from eigenwalker.core.fourier import share_explained
from eigenwalker.core.skeleton import LIMBS
from eigenwalker.core.smoothing import running_mean
from eigenwalker.core.trajectories import check_trajectories, sampling_rate
from eigenwalker.gait.body_points import SIDES, thickness
from eigenwalker.gait.heading import sides_swapped
from eigenwalker.gait.in_place import in_place
from eigenwalker.gait.steady_strides import body_relative
from eigenwalker.io.up_axis_and_unit import body_height, head_and_feet
from eigenwalker.markers.label_repair import Rebuilt, Repair, records_in, repair_labels
from eigenwalker.quality.anthropometry import wrong_joints
from eigenwalker.quality.ground_contact import ground_contact
from eigenwalker.quality.marker_places import wrong_markers
from eigenwalker.quality.quality import Quality

FEWEST_POINTS = 6
"""Fewer may lie in a plane without the capture having two dimensions."""

_MOVING_SHARE = 0.3
"""Share of its usual speed (80 % quantile) above which a body moves as in walking."""
_LEAST_PROGRESS_MM = 600.0
"""Length of a stride to which a rise is compared in place, where no body should rise at all."""


def assess(trajectories: xr.DataArray) -> Quality:
    """Return what is known of a capture, however bad it is, and the verdict on it.

    Labels are repaired and the walk is brought in place first, as in `in_place`. Joints, as far as
    they were seen, are held to the proportions of people: lengths, left beside right, heights,
    breadth, places, and links that hold. Backward walking, captures in two dimensions, frames that
    are tilted or drift, and speeds at which nobody walks are flagged.

    Parameters
    ----------
    trajectories : DataArray of shape (time, marker, axis)
        As captured, in millimetres, with any markers. Most is known of joints, as
        `virtual_markers` returns them.

    Returns
    -------
    Quality
        ``.verdict`` is "use", "use with care" or "do not use", ``.findings`` names the reasons.

    Raises
    ------
    TypeError, ValueError
        If these are no trajectories, or their times are not evenly spaced.

    See Also
    --------
    eigenwalker.study.process_capture : judges the very walk that is decomposed.
    eigenwalker.study.reasons : the findings in sentences.

    References
    ----------
    Winter (2009), Biomechanics and Motor Control of Human Movement, fig. 4.1: lengths of segments.
    Alexander (1989), Physiol Rev 69, 1199-1227: the greatest speed of walking.

    Examples
    --------
    >>> feet = ew.Walker(
    ...     ["left_ankle", "right_ankle", "pelvis"],
    ...     [[0, 90, 80], [0, -90, 80], [0, 0, 900]],
    ...     [[[300, 0, 0], [-300, 0, 0], [0, 20, 0]]],
    ...     [1],
    ...     [0],
    ...     0.9,
    ... )
    >>> quality = assess(feet.trajectories(np.arange(0, 5, 0.01)))
    >>> quality.verdict, quality.n_strides, round(quality.r2, 6)
    ('use', 4, 1.0)
    """
    capture = check_trajectories(trajectories)
    repaired = repair_labels(capture)
    try:
        walk, problem = in_place(repaired, repair=False), ""
    except ValueError as error:
        walk, problem = None, str(error)
    return judge(capture, repaired, walk, CaptureRecord.of(repaired), problem)


class CaptureRecord(NamedTuple):
    """What reading and repairing a capture found, which its positions do not show.

    Fields as in `Quality`.
    """

    repairs: tuple[Repair, ...] = ()
    rebuilt: tuple[Rebuilt, ...] = ()
    repeated: tuple[str, ...] = ()
    unit: str = ""
    unit_guessed: bool = False
    n_frames_cut: int = 0

    @classmethod
    def of(cls, capture: xr.DataArray) -> Self:
        """Return what the attributes of a capture record; what anybody else wrote there is not."""
        attrs = capture.attrs
        unit, cut = attrs.get("unit"), attrs.get("n_frames_cut")
        return cls(
            repairs=records_in(capture, "repairs", Repair),
            rebuilt=records_in(capture, "rebuilt", Rebuilt),
            repeated=names_in(capture, "repeated"),
            unit=unit if isinstance(unit, str) else "",
            unit_guessed=attrs.get("unit_guessed") is True,
            n_frames_cut=int(cut) if isinstance(cut, (int, np.integer)) and cut > 0 else 0,
        )


def judge(
    capture: xr.DataArray,
    repaired: xr.DataArray,
    walk: xr.DataArray | None,
    record: CaptureRecord,
    problem: str = "",
    *,
    labelled: xr.DataArray | None = None,
) -> Quality:
    """Return what is known of a capture and of the walk that was made of it.

    The walk holds steady strides in place, or is None, and `problem` says why there are none.
    `labelled` holds the markers as captured, where joints were made of them.
    """
    names = capture.marker.values.tolist()
    missing = np.isnan(capture.values).any(axis=2).mean(axis=0)
    rate_hz = sampling_rate(capture)
    strides, steady = repaired, slice(None)
    if walk is not None:
        start = int(np.searchsorted(repaired.time.values, walk.time.values[0]))
        steady = slice(start, start + len(walk))
        strides = repaired[steady]
        if walk.sizes["marker"] < repaired.sizes["marker"]:
            strides = strides.sel(marker=walk.marker)
    height_mm, lean_deg = _height_and_lean(repaired.values, names)
    seen = strides if walk is None else walk
    points = repaired if labelled is None else labelled
    if labelled is not None and any(repair.kind == "swap" for repair in record.repairs):
        points = repair_labels(labelled)
    markers, mirrored = wrong_markers(points[steady])
    return Quality(
        rate_hz=rate_hz,
        duration_s=len(capture) / rate_hz,
        n_frames=len(capture),
        missing_share={
            name: float(share) for name, share in zip(names, missing, strict=True) if share
        },
        **record._asdict(),
        sides_swapped=mirrored or (walk is not None and sides_swapped(walk.values, names)),
        bone_length_variation=bone_length_variation(strides),
        height_mm=height_mm,
        lean_deg=lean_deg,
        extent_mm=_extent(repaired.values),
        thickness=_thickness(seen.values, points.values),
        wrong_joints=markers or wrong_joints(seen),
        problem=problem,
        **(
            {}
            if walk is None
            else _steadiness(walk, strides, repaired.values, rate_hz)
            | ground_contact(walk, rate_hz)._asdict()
        ),
    )


def names_in(capture: xr.DataArray, attribute: str) -> tuple[str, ...]:
    """Return what an attribute lists; NetCDF files hold it as one line."""
    names = capture.attrs.get(attribute, ())
    return (names,) * bool(names) if isinstance(names, str) else _texts(names)


def _texts(names: object) -> tuple[str, ...]:
    listed = names if isinstance(names, (tuple, list, np.ndarray)) else ()
    return tuple(str(name) for name in listed if isinstance(name, str))


def _height_and_lean(positions: np.ndarray, names: list[str]) -> tuple[float, float]:
    """Return the height in mm and the lean in degrees of the line from feet to head, or NaN."""
    head, feet = head_and_feet(positions, names)
    head_seen, feet_seen = (np.isfinite(points).all(axis=2) for points in (head, feet))
    seen = np.any(head_seen, axis=1) & np.any(feet_seen, axis=1)
    if not seen.any():
        return float("nan"), float("nan")
    rises = np.nanmean(head[seen], axis=1) - np.nanmean(feet[seen], axis=1)
    x, y, z = np.median(rises, axis=0)
    return body_height(positions, names), float(np.degrees(np.arctan2(np.hypot(x, y), z)))


def _thickness(*bodies: np.ndarray) -> float:
    """Return the least thickness of the points that are always seen, of joints and of markers."""
    always = [body[:, np.isfinite(body).all(axis=(0, 2))] for body in bodies]
    always = [body for body in always if body.shape[1] >= FEWEST_POINTS]
    return min(map(thickness, always), default=float("nan"))


def _extent(positions: np.ndarray) -> float:
    """Return the median diagonal of the box about a body, in mm."""
    seen = positions[np.isfinite(positions).any(axis=(1, 2))]
    if not len(seen):
        return float("nan")
    box = np.nanmax(seen, axis=1) - np.nanmin(seen, axis=1)
    return float(np.median(np.linalg.norm(box, axis=1)))


def bone_length_variation(capture: xr.DataArray) -> dict[tuple[str, str], float]:
    """Return the coefficient of variation of each limb's length."""
    place = {name: index for index, name in enumerate(capture.marker.values.tolist())}
    variation = {}
    limbs = [(f"{s}_{upper}", f"{s}_{lower}") for s in SIDES for upper, lower in LIMBS.values()]
    for upper, lower in limbs:
        if upper in place and lower in place:
            bone = capture.values[:, place[upper]] - capture.values[:, place[lower]]
            length = np.linalg.norm(bone[np.isfinite(bone).all(axis=1)], axis=1)
            if len(length) and length.mean() > 0:
                variation[upper, lower] = float(length.std() / length.mean())
    return variation


def _steadiness(
    walk: xr.DataArray, strides: xr.DataArray, positions: np.ndarray, rate_hz: float
) -> dict[str, Any]:
    """Return what `Quality` holds of steady strides: in place, in the capture, in all of it."""
    facts = walk.attrs
    same = ("n_strides", "straight_passes", "unwound_deg", "frequency_hz", "speed_mm_s")
    stride = rate_hz / facts["frequency_hz"]
    progress = 0.0 if facts["treadmill"] else abs(facts["speed_mm_s"]) / facts["frequency_hz"]
    per_stride = np.nanmax([progress, _LEAST_PROGRESS_MM])
    movement = walk.values.reshape(len(walk), -1)
    moving = max(1, _moving_frames(positions, stride))
    return {name: facts[name] for name in (*same, "climb_mm", "wander_mm", "treadmill")} | {
        "steady_share": min(1.0, len(walk) / moving),
        "climb": float(facts["climb_mm"] / (per_stride * facts["n_strides"])),
        "filled_share": float(np.isnan(strides.values).any(axis=2).mean()),
        "r2": share_explained(movement, np.arange(len(walk)) / stride),
        "periodicity": _periodicity(movement, round(stride)),
    }


def _moving_frames(positions: np.ndarray, stride: float) -> int:
    """Return the number of frames in which the body moves as in walking."""
    seen = np.isfinite(positions).all(axis=(0, 2))
    if seen.sum() < 3:
        return 0
    speed = np.linalg.norm(np.diff(body_relative(positions[:, seen]), axis=0), axis=1)
    smooth = running_mean(speed, max(1, round(stride / 2)))
    return int((smooth > _MOVING_SHARE * np.quantile(smooth, 0.8)).sum())


def _periodicity(movement: np.ndarray, stride: int) -> float:
    """Return the correlation of all columns together with themselves a stride later."""
    centred = movement - movement.mean(axis=0)
    if len(centred) < 1.5 * stride:
        return float("nan")
    early, late = centred[:-stride], centred[stride:]
    scale = np.sqrt(np.vdot(early, early) * np.vdot(late, late))
    return float(np.vdot(early, late) / scale) if scale > 0 else float("nan")
