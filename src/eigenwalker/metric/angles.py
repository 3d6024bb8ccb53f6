"""Joint angles as quaternions, from positions or from captured rotations (Pražák 2010, eq. 1)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple, get_args

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from eigenwalker.core.kinematics import shortest_turn
from eigenwalker.core.trajectories import check_trajectories
from eigenwalker.metric.body_frames import LEAST_MM, SIDES, body_frame
from eigenwalker.metric.groups import BONES

AngleDistance = Literal["angle", "one_minus_dot", "as_printed"]
BEND_AS_SURE_AS_REST = np.sin(np.deg2rad(15))
"""Sine of the bend of a knee or elbow at which its plane counts as much as no twist: straight
limbs have no plane, and that of nearly straight ones is noise."""


class _Bone(NamedTuple):
    """A bone: its ends, what carries it, where it points at rest, and where it bends, how."""

    start: str
    end: str
    carrier: str
    rest: tuple[float, float, float]
    next_end: str = ""
    hinge: tuple[float, float, float] = (0.0, 0.0, 0.0)


def _bones_of(side: str, outwards: float) -> dict[str, _Bone]:
    down, left = (0.0, 0.0, -1.0), (0.0, 1.0, 0.0)
    shoulder, elbow, wrist = (f"{side}_{joint}" for joint in ("shoulder", "elbow", "wrist"))
    hip, knee, ankle = (f"{side}_{joint}" for joint in ("hip", "knee", "ankle"))
    return {
        f"{side}_clavicle": _Bone("sternum", shoulder, "trunk", (0.0, outwards, 0.0)),
        f"{side}_upper_arm": _Bone(shoulder, elbow, "trunk", down, wrist, (0.0, -1.0, 0.0)),
        f"{side}_forearm": _Bone(elbow, wrist, f"{side}_upper_arm", down),
        f"{side}_hand": _Bone(wrist, f"{side}_hand", f"{side}_forearm", down),
        f"{side}_thigh": _Bone(hip, knee, "pelvis", down, ankle, left),
        f"{side}_calf": _Bone(knee, ankle, f"{side}_thigh", down),
        f"{side}_toe": _Bone(ankle, f"{side}_toe", f"{side}_calf", (1.0, 0.0, 0.0)),
    }


BONE = {
    "head": _Bone("sternum", "head", "trunk", (0.0, 0.0, 1.0)),
    **_bones_of("left", 1.0),
    **_bones_of("right", -1.0),
}
"""At rest arms, hands and legs hang, clavicles point outwards and toes forward."""


def joint_quaternions(
    clip: xr.DataArray, *, relative: bool = True, from_positions: bool = False
) -> xr.DataArray:
    """Return how each bone is turned, as unit quaternions.

    Where the clip has captured rotations they are taken, whatever posture they count from: each
    is counted anew from a posture in which arms and legs hang. Elsewhere positions tell: the swing
    of a bone is the shortest turn from rest to where it points; its twist about itself is known
    for thighs and upper arms, by the plane in which knee and elbow bend, the better the more they
    bend, and is none for other bones.

    Parameters
    ----------
    clip : DataArray of shape (time, marker, axis)
        Joints of a walker, as `virtual_markers` gives them, if with a coordinate ``rotation``
        (rotation vectors in the room) then that of the bone that begins at each joint.
    relative : bool
        Whether a bone's turn is that in its joint, seen from the bone (or trunk, or pelvis) that
        carries it, as in Lee et al. (2002); otherwise in the room.
    from_positions : bool
        Whether to leave captured rotations aside. A clip that has none is to be compared with
        others from positions too.

    Returns
    -------
    DataArray of shape (time, joint, quaternion)
        Quaternions (x, y, z, w); NaN where the joints were not seen. Bones (`BONES`) that the clip
        lacks are left out, and so are the clavicles of the mannequin (`retarget`), which are
        parts of its build.

    Raises
    ------
    ValueError
        If the joints that carry the rest are missing: pelvis, sternum, hips and shoulders.

    Examples
    --------
    The knees of a walker bend by about 60 degrees:

    >>> knee = joint_quaternions(ew.simulate_walk(seed=1)).sel(joint="left_calf")
    >>> bend = 2 * np.arccos(np.abs(knee.sel(quaternion="w")))
    >>> round(float(np.rad2deg(bend.max())), -1)
    60.0

    """
    clip = check_trajectories(clip)
    place = {str(name): clip.values[:, i] for i, name in enumerate(clip.marker.values)}
    _refuse_missing(place)
    captured = {} if from_positions else _captured(clip)
    room = {"pelvis": _carrying(place, "pelvis"), "trunk": _carrying(place, "trunk")}
    built = clip.attrs.get("retargeted", False)
    turns: dict[str, np.ndarray] = {}
    for name in BONES:
        bone = BONE[name]
        if not {bone.start, bone.end} <= set(place) or (built and "clavicle" in name):
            continue
        carrier = room[bone.carrier]
        turned = carrier.then(_swing_and_twist(place, bone, carrier))
        if name in captured:
            turned = captured[name].counted_from(turned)
        room[name] = turned
        turns[name] = (turned.seen_from(carrier) if relative else turned).quaternions()
    return xr.DataArray(
        np.stack(list(turns.values()), axis=1),
        dims=("time", "joint", "quaternion"),
        coords={"time": clip.time.values, "joint": list(turns), "quaternion": list("xyzw")},
        name="rotation",
    )


class _Turn(NamedTuple):
    """Rotations in the room, and in which frames they are known; elsewhere nothing is turned."""

    rotation: Rotation
    known: np.ndarray

    def then(self, turn: _Turn) -> _Turn:
        return _Turn(self.rotation * turn.rotation, self.known & turn.known)

    def seen_from(self, carrier: _Turn) -> _Turn:
        return _Turn(carrier.rotation.inv() * self.rotation, self.known & carrier.known)

    def counted_from(self, other: _Turn) -> _Turn:
        """The same turns from another zero, so that on the whole they are the other's."""
        both = self.known & other.known
        if not both.any():
            return other
        apart = (other.rotation.inv() * self.rotation).as_quat()
        offset = Rotation.from_quat(apart[both]).mean()
        return _Turn(self.rotation * offset.inv(), both)

    def quaternions(self) -> np.ndarray:
        return np.where(self.known[:, None], self.rotation.as_quat(), np.nan)


_CARRYING = ("pelvis", "sternum", *(f"{side}_{j}" for j in ("hip", "shoulder") for side in SIDES))


def _refuse_missing(place: Mapping[str, np.ndarray]) -> None:
    if missing := [name for name in _CARRYING if name not in place]:
        raise ValueError(
            f"Joint angles need the joints {list(_CARRYING)}; {missing} are missing. Make joints "
            "of markers first, with virtual_markers()."
        )


def _captured(clip: xr.DataArray) -> dict[str, _Turn]:
    """Return the captured turns of bones, by bone."""
    if "rotation" not in clip.coords:
        return {}
    at = {str(name): clip.rotation.values[:, i] for i, name in enumerate(clip.marker.values)}
    found = {}
    for name, bone in BONE.items():
        turns = at.get("head" if name == "head" else name if "clavicle" in name else bone.start)
        if turns is not None and (known := np.isfinite(turns).all(axis=1)).any():
            found[name] = _Turn(Rotation.from_rotvec(np.where(known[:, None], turns, 0.0)), known)
    return found


def _carrying(place: Mapping[str, np.ndarray], part: Literal["pelvis", "trunk"]) -> _Turn:
    axes = body_frame(place, part)
    known = np.isfinite(axes.sum(axis=(1, 2)))
    return _Turn(Rotation.from_matrix(np.where(known[:, None, None], axes, np.eye(3))), known)


def _swing_and_twist(place: Mapping[str, np.ndarray], bone: _Bone, carrier: _Turn) -> _Turn:
    """Return a bone's turn in its joint: the shortest from rest, then about itself."""
    way, known = _direction(place[bone.end] - place[bone.start])
    swing = shortest_turn(np.array(bone.rest), carrier.rotation.inv().apply(way))
    if not any(bone.hinge) or bone.next_end not in place:
        return _Turn(swing, known)
    onwards, _ = _direction(place[bone.next_end] - place[bone.end])
    plane = (carrier.rotation * swing).inv().apply(np.cross(way, onwards))
    hinge = np.array(bone.hinge)
    across = plane + BEND_AS_SURE_AS_REST * hinge
    rest = np.array(bone.rest)
    angle = np.arctan2(across @ np.cross(rest, hinge), across @ hinge)
    return _Turn(swing * Rotation.from_rotvec(angle[:, None] * rest), known)


def _direction(way: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return unit vectors, 0 where a bone was not seen or has no length, and where it has."""
    length = np.linalg.norm(way, axis=1)
    known = length > LEAST_MM
    unit = np.divide(way, length[:, None], out=np.zeros_like(way), where=known[:, None])
    return unit, known


def angle_between(a: ArrayLike, b: ArrayLike, *, kind: AngleDistance = "angle") -> np.ndarray:
    """Return how far rotations are from each other.

    Eq. 1 of Pražák et al. (2010) has the dot product of quaternions, which is 1 for equal ones and
    changes its sign with q and -q, that are the same rotation (A26).

    Parameters
    ----------
    a, b : array of shape (..., 4)
        Unit quaternions.
    kind : {"angle", "one_minus_dot", "as_printed"}
        The angle of the turn between them in radians, ``2 acos |a . b|``; ``1 - |a . b|``; or
        ``a . b`` itself.

    Returns
    -------
    array of shape (...)

    Examples
    --------
    >>> quarter = Rotation.from_rotvec([0, 0, np.pi / 2]).as_quat()
    >>> float(angle_between([0, 0, 0, 1], -quarter).round(4))
    1.5708

    """
    if kind not in get_args(AngleDistance):
        raise ValueError(f"kind={kind!r} is not known; give one of {get_args(AngleDistance)}.")
    dot = np.einsum("...i,...i", np.asarray(a, dtype=float), np.asarray(b, dtype=float))
    if kind == "as_printed":
        return dot
    if kind == "one_minus_dot":
        return 1 - np.minimum(np.abs(dot), 1.0)
    apart, together = (np.linalg.norm(np.subtract(a, s * np.asarray(b)), axis=-1) for s in (1, -1))
    return 4 * np.arctan2(np.minimum(apart, together), np.maximum(apart, together))
