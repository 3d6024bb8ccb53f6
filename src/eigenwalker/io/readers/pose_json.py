"""Points of a body in JSON, as programs for pose estimation or their users write them.

One document with all frames: a list of frames, or ``{"rate_hz": 30, "frames": [...]}``. A frame
holds points (a list, or names with points), directly or under a usual key; a point is
``[x, y, z]`` or ``{"x": ..., "y": ..., "z": ...}``. Or flat: records or columns called ``nose_x``.
"""

from __future__ import annotations

import json
import math
import re
from pathlib import Path

import numpy as np
import xarray as xr

from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.readers.skeleton_table import body_trajectories
from eigenwalker.io.text_cells import MAX_SIZE, is_text, lines_of, points_of
from eigenwalker.io.text_table import TableValues

MEDIAPIPE = (
    *("nose", "left_eye_inner", "left_eye", "left_eye_outer", "right_eye_inner", "right_eye"),
    *("right_eye_outer", "left_ear", "right_ear", "mouth_left", "mouth_right"),
    *(
        f"{side}_{part}"
        for part in ("shoulder", "elbow", "wrist", "pinky", "index", "thumb")
        for side in ("left", "right")
    ),
    *(
        f"{side}_{part}"
        for part in ("hip", "knee", "ankle", "heel", "foot_index")
        for side in ("left", "right")
    ),
)
BODY_25 = (
    *("Nose", "Neck", "RShoulder", "RElbow", "RWrist", "LShoulder", "LElbow", "LWrist"),
    *("MidHip", "RHip", "RKnee", "RAnkle", "LHip", "LKnee", "LAnkle", "REye", "LEye"),
    *("REar", "LEar", "LBigToe", "LSmallToe", "LHeel", "RBigToe", "RSmallToe", "RHeel"),
)
NAMES = {len(names): names for names in (MEDIAPIPE, BODY_25)}
"""Names of points that a file only counts."""

_FRAMES = ("frames", "data", "poses", "annotations", "results")
_POINTS = (
    *("pose_world_landmarks", "world_landmarks", "keypoints3D", "keypoints_3d", "keypoints3d"),
    *("pose_keypoints_3d", "landmarks", "pose_landmarks", "keypoints", "points", "joints"),
)
_TIMES = {"time": 1.0, "time_s": 1.0, "timestamp": 1.0, "timestamp_s": 1.0, "t": 1.0}
_TIMES |= {"time_ms": 1e-3, "timestamp_ms": 1e-3}
_RATES = ("rate_hz", "fps", "frame_rate", "framerate", "sampling_rate")
_WORDS = re.compile(rb'"(frames|[^"]{0,40}(landmarks|keypoints[^"]{0,9}|_z))" *:', re.IGNORECASE)
_PICTURE = "export 3D points (world landmarks, in metres)"


def looks_like_json(content: bytes) -> bool:
    """Return whether a file begins as JSON documents do."""
    return content.lstrip(b"\xef\xbb\xbf \t\r\n")[:1] in (b"{", b"[") and is_text(content)


def holds_poses(beginning: bytes, path: Path) -> bool:
    """Return whether a JSON document is one of points, by the words in its beginning."""
    del path
    return looks_like_json(beginning) and _WORDS.search(beginning) is not None


def read_pose_json(file: CaptureFile) -> xr.DataArray:
    """Return the trajectories of the points in a JSON document, of one person."""
    try:
        data = json.loads("\n".join(lines_of(file.content, file.name)))
    except UnreadableFile:
        raise
    except (ValueError, RecursionError) as error:
        raise file.error("JSON", str(error)[:80]) from error
    top = data if isinstance(data, dict) else {}
    keys = {"unit": "unit", "up": "up"} | dict.fromkeys(_RATES, "rate_hz")
    notes = {note: str(top[key])[:40] for key, note in keys.items() if key in top}
    frames = next((top[key] for key in _FRAMES if isinstance(top.get(key), list)), data)
    if isinstance(frames, dict):
        frames = _records(frames)
    if not isinstance(frames, list) or not frames:
        raise file.error("a list of frames", f"{type(frames).__name__}")
    names, positions = _positions(file, frames, top)
    return body_trajectories(file, TableValues(positions, _times(frames)), names, notes)


def _records(columns: dict) -> list[dict]:
    """Return columns of equal length (lists, or dicts by row) as one record a frame."""
    lists = {key: list(value.values()) if isinstance(value, dict) else value
             for key, value in columns.items()}  # fmt: skip
    lists = {key: value for key, value in lists.items() if isinstance(value, list)}
    lengths = {len(value) for value in lists.values()}
    if len(lengths) != 1:
        return []
    return [dict(zip(lists, row, strict=True)) for row in zip(*lists.values(), strict=True)]


def _positions(file: CaptureFile, frames: list, top: dict) -> tuple[list[str], np.ndarray]:
    """Return names and positions of the points of all frames."""
    named = [_points(file, frame) for frame in frames]
    first = next((points for points in named if points), {})
    names = next((top[key] for key in ("names", "keypoint_names", "markers") if key in top), None)
    if names is not None and not (
        isinstance(names, list) and len(names) == len(first) and all(map(str, names))
    ):
        raise file.error(f"{len(first)} names, one a point", f"{str(names)[:60]}")
    if names is None and first and all(key.isdecimal() for key in first):
        names = NAMES.get(len(first))
        if names is None:
            raise file.error(
                f"names of the {len(first)} points",
                "none",
                'add "names": ["nose", ...] at the top',
            )
    if len(first) < 3:
        raise file.error("points x, y, z in each frame", f"{str(frames[0])[:60]}", _PICTURE)
    if any(points and list(points) != list(first) for points in named):
        raise file.error("the same points in each frame", "others in some")
    missing = [np.full(3, np.nan)] * len(first)
    positions = np.array([list(points.values()) or missing for points in named], dtype=float)
    return [str(name) for name in (names or first)], positions


def _points(file: CaptureFile, frame: object) -> dict[str, np.ndarray]:
    """Return the points of a frame by name or number; none where nobody was seen."""
    if isinstance(frame, dict):
        if "people" in frame:
            frame = _one(file, frame["people"])
        if isinstance(frame, dict):
            if "pose_keypoints_2d" in frame and not frame.get("pose_keypoints_3d"):
                raise file.error("points in space", "pose_keypoints_2d", _PICTURE)
            key = next((key for key in _POINTS if key in frame), None)
            if key is None:
                return _flat(file, frame) or _named(file, frame)
            frame = frame[key]
    if isinstance(frame, dict):
        return {str(name): _point(file, point) for name, point in frame.items()}
    if not isinstance(frame, list):
        return {}
    if frame and all(isinstance(value, (int, float)) for value in frame) and len(frame) % 4 == 0:
        return {str(i): _point(file, frame[i * 4 : i * 4 + 3]) for i in range(len(frame) // 4)}
    if frame and _is_list_of_points(frame[0]):
        return _points(file, _one(file, frame))
    points: dict[str, np.ndarray] = {}
    for at, point in enumerate(frame):
        name = point.get("name", at) if isinstance(point, dict) else at
        points[str(name)] = _point(file, point)
    if len(points) < len(frame):
        raise file.error("points of different names", "a name twice")
    return points


def _is_list_of_points(value: object) -> bool:
    return isinstance(value, list) and bool(value) and isinstance(value[0], (list, dict))


def _one(file: CaptureFile, people: object) -> object:
    """Return the only person of a frame, or nobody."""
    if not isinstance(people, list) or len(people) > 1:
        got = f"{len(people)}" if isinstance(people, list) else f"{str(people)[:40]}"
        raise file.error("one person", got, "keep the points of one")
    return people[0] if people else {}


def _flat(file: CaptureFile, frame: dict) -> dict[str, np.ndarray]:
    """Return the points of a record with entries such as ``nose_x``."""
    keys = [str(key) for key in frame]
    points = points_of(keys)
    values = list(frame.values())
    return {
        name: _point(file, [values[column] for column in columns])
        for name, columns in zip(points.names, points.columns, strict=True)
    }


def _named(file: CaptureFile, frame: dict) -> dict[str, np.ndarray]:
    """Return the points that stand in a record by name: entries that have an x, y and z."""
    points = {
        str(name): point for name, point in frame.items()
        if isinstance(point, dict) and {"x", "y", "z"} <= set(point)
    }  # fmt: skip
    return {name: _point(file, point) for name, point in points.items()}


def _point(file: CaptureFile, point: object) -> np.ndarray:
    """Return x, y, z of a point; NaN where it is null."""
    if point is None:
        return np.full(3, np.nan)
    if isinstance(point, dict):
        point = [point.get(axis, math.inf) for axis in "xyz"]
    values = list(point) if isinstance(point, list) else []
    if len(values) < 3:
        raise file.error("points x, y, z", f"{str(point)[:60]}", _PICTURE)
    return np.array([_number(file, value) for value in values[:3]])


def _number(file: CaptureFile, value: object) -> float:
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return math.nan
    if isinstance(value, bool) or not isinstance(value, (int, float)) or abs(value) > MAX_SIZE:
        got = "none" if value == math.inf else f"{str(value)[:40]!r}"
        raise file.error("a finite number for each of x, y, z", got)
    return float(value)


def _times(frames: list) -> np.ndarray | None:
    """Return the times of the frames in seconds, if each has one."""
    for key, unit in _TIMES.items():
        times = [frame.get(key) if isinstance(frame, dict) else None for frame in frames]
        if all(isinstance(t, (int, float)) and abs(t) < MAX_SIZE * 1e6 for t in times):
            time = np.array(times, dtype=float) * unit
            late = unit == 1.0 and len(time) > 1 and np.median(np.diff(time)) >= 1
            return time * 1e-3 if late else time
    return None
