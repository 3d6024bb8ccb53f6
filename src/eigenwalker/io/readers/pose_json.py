"""Points of a body in JSON, as programs for pose estimation or their users write them.

One document with all frames: a list of frames, or ``{"rate_hz": 30, "frames": [...]}``. A frame
holds points (a list, or names with points), directly or under a usual key; a point is
``[x, y, z]`` or ``{"x": ..., "y": ..., "z": ...}``. Or flat: records or columns called ``nose_x``.
"""

from __future__ import annotations

import json
import math
import re
import reprlib
import tomllib
from collections.abc import Iterable, Sequence
from contextlib import suppress
from functools import lru_cache
from importlib.resources import files
from pathlib import Path
from types import NoneType
from typing import Any, TypeGuard

import numpy as np
import xarray as xr

from eigenwalker.io.capture_file import CaptureFile, is_text
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.missing_codes import is_code
from eigenwalker.io.readers.skeleton_table import body_trajectories
from eigenwalker.io.text_cells import MAX_CLOCK, MAX_SIZE, Points, points_of, seconds_of_date
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
    **dict.fromkeys(("time", "timestamp", "t", "datetime", "utc"), None),
    **dict.fromkeys(("time_s", "timestamp_s"), "s"),
    **dict.fromkeys(("time_ms", "timestamp_ms"), "ms"),
    **dict.fromkeys(("time_us", "timestamp_us"), "us"),
}
_RATES = ("rate_hz", "fps", "frame_rate", "framerate", "sampling_rate")
MAX_MEMORY = 2**29
"""Bytes that a document may take as Python's lists, dicts and numbers."""
_MEMORY = {b"[": 88, b"{": 240, b",": 36}
"""Bytes for each list, each dict, and each of their entries."""
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
    memory = sum(file.content.count(mark) * size for mark, size in _MEMORY.items())
    if memory > MAX_MEMORY:
        expected = f"JSON that takes {MAX_MEMORY / 2**20:.0f} MiB when it is read, at most"
        got = f"one of some {memory / 2**20:.0f} MiB"
        raise file.error(expected, got, "cut it into shorter captures, or write them as CSV")
    try:
        return _trajectories(file, json.loads(file.text))
    except UnreadableFile:
        raise
    except RecursionError as error:
        raise file.error("JSON of frames and points", "lists in lists without end") from error
    except ValueError as error:
        raise file.error("JSON", str(error)[:80]) from error


def _trajectories(file: CaptureFile, data: Any) -> xr.DataArray:
    top = data if _is_dict(data) else {}
    keys = {"unit": "unit", "up": "up"} | dict.fromkeys(_RATES, "rate_hz")
    notes = {note: str(top[key])[:40] for key, note in keys.items() if key in top}
    frames = next((top[key] for key in _FRAMES if _is_list(top.get(key))), data)
    if _is_dict(frames):
        frames = _records(frames)
    if not _is_list(frames) or not frames:
        got = "a list without any" if _is_list(frames) else type(frames).__name__
        raise file.error("a list of frames", got)
    names, positions = _positions(file, frames, top)
    return body_trajectories(file, TableValues(positions, *_times(frames)), names, notes)


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
    first: list[str] = []
    rows: list[np.ndarray | None] = []
    for frame in frames:
        points = _points(file, frame)
        if points and first and list(points) != first:
            raise file.error("the same points in each frame", "others in some")
        first = first or list(points)
        rows.append(_numbers(file, points.values()) if points else None)
    names = next((top[key] for key in ("names", "keypoint_names", "markers") if key in top), None)
    if names is not None and not (
        _is_list(names) and len(names) == len(first) and all(map(str, names))
    ):
        raise file.error(f"{len(first)} names, one a point", repr(names)[:60])
    if names is None and first and all(key.isdecimal() for key in first):
        names = NAMES.get(len(first))
        if names is None:
            advice = 'add "names": ["nose", ...] at the top'
            raise file.error(f"names of the {len(first)} points", "none", advice)
    if len(first) < 3:
        raise file.error("points x, y, z in each frame", reprlib.repr(frames[0])[:60], _PICTURE)
    missing = np.full((len(first), 3), np.nan)
    positions = np.array([missing if row is None else row for row in rows])
    return [str(name) for name in (names or first)], positions


def _points(file: CaptureFile, frame: Any) -> dict[str, Any]:
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
        return {str(name): point for name, point in frame.items()}
    if not _is_list(frame):
        return {}
    if frame and all(isinstance(value, (int, float)) for value in frame) and len(frame) % 4 == 0:
        return {str(i): frame[i * 4 : i * 4 + 3] for i in range(len(frame) // 4)}
    if frame and _is_list(frame[0]) and frame[0] and isinstance(frame[0][0], (list, dict)):
        return _points(file, _one_person(file, frame))
    points: dict[str, Any] = {}
    for at, point in enumerate(frame):
        name = point.get("name", at) if _is_dict(point) else at
        points[str(name)] = point
    if len(points) < len(frame):
        raise file.error("points of different names", "a name twice")
    return points


def _one_person(file: CaptureFile, people: Any) -> Any:
    """Return the only person of a frame; nothing if there is none."""
    if not _is_list(people) or len(people) > 1:
        got = f"{len(people)}" if _is_list(people) else reprlib.repr(people)[:40]
        raise file.error("one person", got, "keep the points of one")
    return people[0] if people else {}


def _points_of_record(file: CaptureFile, record: dict[str, Any]) -> dict[str, Any]:
    """Return the points of a record: entries ``nose_x`` and so on, or entries with x, y and z."""
    flat = _flat_points(tuple(record))
    values = list(record.values())
    points = {
        name: [values[column] for column in columns]
        for name, columns in zip(flat.names, flat.columns, strict=True)
    }
    return points or {
        name: point
        for name, point in record.items()
        if _is_dict(point) and {"x", "y", "z"} <= set(point)
    }


@lru_cache(maxsize=8)
def _flat_points(names: tuple[str, ...]) -> Points:
    return points_of(names)  # the same in each frame


def _numbers(file: CaptureFile, points: Iterable[Any]) -> np.ndarray:
    """Return x, y, z of points, array (point, 3); NaN where one is null."""
    values = [value for point in points for value in _coordinates(file, point)]
    if set(map(type, values)) <= {int, float, NoneType}:
        with suppress(OverflowError):
            row = np.array(values, dtype=float)
            if not (np.abs(row) > MAX_SIZE).any():
                return row.reshape(-1, 3)
    return np.array([_number(file, value) for value in values]).reshape(-1, 3)


def _coordinates(file: CaptureFile, point: Any) -> Sequence[Any]:
    if point is None:
        return (None, None, None)
    values = [point.get(axis, math.inf) for axis in "xyz"] if _is_dict(point) else point
    if not _is_list(values) or len(values) < 3:
        raise file.error("points x, y, z", reprlib.repr(point)[:60], _PICTURE)
    return values[:3]


def _number(file: CaptureFile, value: Any) -> float:
    if value is None or value != value or (isinstance(value, float) and is_code(value)):
        return math.nan
    if isinstance(value, bool) or not isinstance(value, (int, float)) or abs(value) > MAX_SIZE:
        got = "none" if value == math.inf else f"{str(value)[:40]!r}"
        raise file.error("a finite number for each of x, y, z", got)
    return float(value)


def _times(frames: Sequence[Any]) -> tuple[np.ndarray | None, str | None]:
    """Return the times of frames and their unit, as far as they are known."""
    for key, unit in _TIMES.items():
        times = [frame.get(key) if _is_dict(frame) else None for frame in frames]
        if all(isinstance(time, (int, float)) and abs(time) < MAX_CLOCK for time in times):
            return np.array(times, dtype=float), unit
        dates = [seconds_of_date(time) if isinstance(time, str) else None for time in times]
        if None not in dates:
            return np.array(dates, dtype=float), "s"
    return None, None
