"""Points of a body in JSON, as programs for pose estimation or their users write them.

One document with all frames: a list of frames, or ``{"rate_hz": 30, "frames": [...]}``. A frame
holds points (a list, or names with points), directly or under a usual key; a point is
``[x, y, z]`` or ``{"x": ..., "y": ..., "z": ...}``. Or flat: records or columns called ``nose_x``.
"""

from __future__ import annotations

import json
import math
import re
import tomllib
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any, TypeGuard

import numpy as np
import xarray as xr

from eigenwalker.io.capture_file import CaptureFile, is_text
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.readers.skeleton_table import body_trajectories
from eigenwalker.io.text_cells import MAX_SIZE, points_of
from eigenwalker.io.text_table import TableValues

_TOML = files("eigenwalker.io.readers").joinpath("point_names.toml").read_text(encoding="utf-8")
MEDIAPIPE, BODY_25 = (tuple(map(str, names)) for names in tomllib.loads(_TOML).values())
NAMES = {len(names): names for names in (MEDIAPIPE, BODY_25)}
"""Names of points that a file only counts."""

_FRAMES = ("frames", "data", "poses", "annotations", "results")
_POINTS = (
    *("pose_world_landmarks", "world_landmarks", "keypoints3D", "keypoints_3d", "keypoints3d"),
    *("pose_keypoints_3d", "landmarks", "pose_landmarks", "keypoints", "points", "joints"),
)
_TIMES = {
    **dict.fromkeys(("time", "time_s", "timestamp", "timestamp_s", "t"), 1.0),
    **dict.fromkeys(("time_ms", "timestamp_ms"), 1e-3),
}
_RATES = ("rate_hz", "fps", "frame_rate", "framerate", "sampling_rate")
_WORDS = re.compile(rb'"(frames|[^"]{0,40}(landmarks|keypoints[^"]{0,9}|_z))" *:', re.IGNORECASE)
_PICTURE = "export 3D points (world landmarks, in metres)"


def looks_like_json(content: bytes) -> bool:
    """Return whether a file begins as JSON documents do."""
    return content.lstrip(b"\xef\xbb\xbf \t\r\n")[:1] in (b"{", b"[") and is_text(content)


def holds_poses(beginning: bytes, _path: Path) -> bool:
    """Return whether a JSON document is one of points, by the words in its beginning."""
    return looks_like_json(beginning) and _WORDS.search(beginning) is not None


def read_pose_json(file: CaptureFile) -> xr.DataArray:
    """Return the trajectories of the points in a JSON document, of one person."""
    try:
        data: Any = json.loads("\n".join(file.lines))
    except UnreadableFile:
        raise
    except (ValueError, RecursionError) as error:
        raise file.error("JSON", str(error)[:80]) from error
    top = data if _is_dict(data) else {}
    keys = {"unit": "unit", "up": "up"} | dict.fromkeys(_RATES, "rate_hz")
    notes = {note: str(top[key])[:40] for key, note in keys.items() if key in top}
    frames = next((top[key] for key in _FRAMES if _is_list(top.get(key))), data)
    if _is_dict(frames):
        frames = _records(frames)
    if not _is_list(frames) or not frames:
        raise file.error("a list of frames", f"{type(frames).__name__}")
    names, positions = _positions(file, frames, top)
    return body_trajectories(file, TableValues(positions, _times(frames)), names, notes)


def _is_dict(value: object) -> TypeGuard[dict[str, Any]]:
    return isinstance(value, dict)


def _is_list(value: object) -> TypeGuard[list[Any]]:
    return isinstance(value, list)


def _records(columns: dict[str, Any]) -> list[dict[str, Any]]:
    """Return columns of equal length (lists, or dicts by row) as one record a frame."""
    lists: dict[str, list[Any]] = {}
    for key, value in columns.items():
        if _is_dict(value):
            lists[key] = list(value.values())
        elif _is_list(value):
            lists[key] = value
    if len({len(value) for value in lists.values()}) != 1:
        return []
    return [dict(zip(lists, row, strict=True)) for row in zip(*lists.values(), strict=True)]


def _positions(
    file: CaptureFile, frames: Sequence[Any], top: dict[str, Any]
) -> tuple[list[str], np.ndarray]:
    points_by_frame = [_points(file, frame) for frame in frames]
    first = next((points for points in points_by_frame if points), points_by_frame[0])
    names = next((top[key] for key in ("names", "keypoint_names", "markers") if key in top), None)
    if names is not None and not (
        _is_list(names) and len(names) == len(first) and all(map(str, names))
    ):
        raise file.error(f"{len(first)} names, one a point", f"{str(names)[:60]}")
    if names is None and first and all(key.isdecimal() for key in first):
        names = NAMES.get(len(first))
        if names is None:
            advice = 'add "names": ["nose", ...] at the top'
            raise file.error(f"names of the {len(first)} points", "none", advice)
    if len(first) < 3:
        raise file.error("points x, y, z in each frame", f"{str(frames[0])[:60]}", _PICTURE)
    if any(points and list(points) != list(first) for points in points_by_frame):
        raise file.error("the same points in each frame", "others in some")
    missing = [np.full(3, np.nan)] * len(first)
    positions = [list(points.values()) or missing for points in points_by_frame]
    return [str(name) for name in (names or first)], np.array(positions, dtype=float)


def _points(file: CaptureFile, frame: Any) -> dict[str, np.ndarray]:
    """Return the points of a frame by name or number; none where no person was seen."""
    if _is_dict(frame) and "people" in frame:
        frame = _one_person(file, frame["people"])
    if _is_dict(frame):
        if "pose_keypoints_2d" in frame and not frame.get("pose_keypoints_3d"):
            raise file.error("points in space", "pose_keypoints_2d", _PICTURE)
        key = next((key for key in _POINTS if key in frame), None)
        if key is None:
            return _points_of_record(file, frame)
        frame = frame[key]
    if _is_dict(frame):
        return {str(name): _point(file, point) for name, point in frame.items()}
    if not _is_list(frame):
        return {}
    if frame and all(isinstance(value, (int, float)) for value in frame) and len(frame) % 4 == 0:
        return {str(i): _point(file, frame[i * 4 : i * 4 + 3]) for i in range(len(frame) // 4)}
    if frame and _is_list(frame[0]) and frame[0] and isinstance(frame[0][0], (list, dict)):
        return _points(file, _one_person(file, frame))
    points: dict[str, np.ndarray] = {}
    for at, point in enumerate(frame):
        name = point.get("name", at) if _is_dict(point) else at
        points[str(name)] = _point(file, point)
    if len(points) < len(frame):
        raise file.error("points of different names", "a name twice")
    return points


def _one_person(file: CaptureFile, people: Any) -> Any:
    """Return the only person of a frame; nothing if there is none."""
    if not _is_list(people) or len(people) > 1:
        got = f"{len(people)}" if _is_list(people) else f"{str(people)[:40]}"
        raise file.error("one person", got, "keep the points of one")
    return people[0] if people else {}


def _points_of_record(file: CaptureFile, record: dict[str, Any]) -> dict[str, np.ndarray]:
    """Return the points of a record: entries ``nose_x`` and so on, or entries with x, y and z."""
    flat = points_of(list(record))
    values = list(record.values())
    points = {
        name: _point(file, [values[column] for column in columns])
        for name, columns in zip(flat.names, flat.columns, strict=True)
    }
    return points or {
        name: _point(file, point)
        for name, point in record.items()
        if _is_dict(point) and {"x", "y", "z"} <= set(point)
    }


def _point(file: CaptureFile, point: Any) -> np.ndarray:
    if point is None:
        return np.full(3, np.nan)
    values = [point.get(axis, math.inf) for axis in "xyz"] if _is_dict(point) else point
    if not _is_list(values) or len(values) < 3:
        raise file.error("points x, y, z", f"{str(point)[:60]}", _PICTURE)
    return np.array([_number(file, value) for value in values[:3]])


def _number(file: CaptureFile, value: Any) -> float:
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return math.nan
    if isinstance(value, bool) or not isinstance(value, (int, float)) or abs(value) > MAX_SIZE:
        got = "none" if value == math.inf else f"{str(value)[:40]!r}"
        raise file.error("a finite number for each of x, y, z", got)
    return float(value)


def _times(frames: Sequence[Any]) -> np.ndarray | None:
    for key, unit in _TIMES.items():
        times = [frame.get(key) if _is_dict(frame) else None for frame in frames]
        if all(isinstance(t, (int, float)) and abs(t) < MAX_SIZE * 1e6 for t in times):
            time = np.array(times, dtype=float) * unit
            in_ms = unit == 1.0 and len(time) > 1 and np.median(np.diff(time)) >= 1
            return time * 1e-3 if in_ms else time
    return None
