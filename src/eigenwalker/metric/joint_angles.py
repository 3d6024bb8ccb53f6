"""Joint angles as quaternions, from positions or captured rotations (Pražák et al. 2010, eq. 1)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal, NamedTuple, get_args

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.spatial.transform import Rotation

from eigenwalker.core.arguments import check_choice, check_numbers
from eigenwalker.core.kinematics import shortest_turn
from eigenwalker.metric.clips import Clip, as_trajectories
from eigenwalker.metric.joint_groups import BONES
from eigenwalker.metric.retargeting import SHORTEST_MM, SIDES, body_frame, is_mannequin

AngleDistance = Literal["angle", "one_minus_dot", "as_printed"]

HALF_TWIST_BEND = np.sin(np.deg2rad(15))
"""Sine of the bend of a knee or elbow at which the plane of the limb and the assumption of no twist
count equally: straight limbs have no plane, and that of nearly straight ones is noise."""


class _Bone(NamedTuple):
    """A bone: its ends, its carrier, its direction at rest, and the joint axis at its far end."""

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


SKELETON_BONES = {
    "head": _Bone("sternum", "head", "trunk", (0.0, 0.0, 1.0)),
    **_bones_of("left", 1.0),
    **_bones_of("right", -1.0),
}
"""At rest arms, hands and legs hang down, clavicles point outwards and toes forward."""


def joint_quaternions(
    clip: Clip, *, relative: bool = True, from_positions: bool = False
) -> xr.DataArray:
    r"""Return the orientation of each bone as a unit quaternion: the q of Pražák et al., eq. 1.

    Orientations count from a rest posture in which arms and legs hang down. From positions, a bone
    first twists about its own axis and then swings by the shortest rotation from rest to its
    direction. Thighs and upper arms twist by the angle about the bone from the axis of knee or
    elbow at rest, :math:`h`, to :math:`n + h \sin 15°`, with :math:`n` the normal of the plane of
    the limb, as long as the sine of the bend: a straight limb has no twist. Nor have other bones.

    Captured rotations are taken instead where the clip has them, multiplied for each bone by the
    constant rotation that makes their mean that of the orientations from positions: the rest
    posture of the file does not matter.

    Parameters
    ----------
    clip : DataArray of shape (time, marker, axis), Walker, Loop or PreparedClip
        Joints (`virtual_markers`). A coordinate ``rotation`` holds captured rotation vectors of
        the bone that begins at each joint, in the frame of the room.
    relative : bool
        Whether orientations are relative to the bone that carries each bone (or trunk, or pelvis),
        as in Lee et al. (2002); otherwise relative to the room.
    from_positions : bool
        Whether to ignore captured rotations. If only one of two clips has them, compare both from
        positions.

    Returns
    -------
    DataArray of shape (time, joint, quaternion)
        Quaternions (x, y, z, w); NaN where joints are missing. Bones (`BONES`) that the clip
        lacks are left out, and so are the clavicles of the mannequin (`retarget`), which are fixed
        to its trunk.

    Raises
    ------
    ValueError
        If pelvis, sternum, a hip or a shoulder is missing.

    See Also
    --------
    angle_between : The distance of two of them.

    References
    ----------
    Pražák et al. (2010), eq. 1; Lee et al. (2002), Interactive control of avatars animated with
    human motion data.

    Examples
    --------
    The knees of a walker bend by about 60 degrees:

    >>> knee = joint_quaternions(ew.simulate_walk(seed=1)).sel(joint="left_calf")
    >>> bend = 2 * np.arccos(np.abs(knee.sel(quaternion="w")))
    >>> round(float(np.rad2deg(bend.max())), -1)
    60.0
    """
    clip = as_trajectories(clip)
    place = {str(name): clip.values[:, i] for i, name in enumerate(clip.marker.values)}
    _refuse_missing(place)
    captured = {} if from_positions else _captured_rotations(clip)
    room = {"pelvis": _carrier("pelvis", place), "trunk": _carrier("trunk", place)}
    mannequin = is_mannequin(clip)
    orientations: dict[str, np.ndarray] = {}
    for name in BONES:
        bone = SKELETON_BONES[name]
        if not {bone.start, bone.end} <= set(place) or (mannequin and "clavicle" in name):
            continue
        carrier = room[bone.carrier]
        orientation = carrier.then(_swing_and_twist(place, bone, carrier))
        if name in captured:
            orientation = captured[name].aligned_to(orientation)
        room[name] = orientation
        seen = orientation.relative_to(carrier) if relative else orientation
        orientations[name] = seen.quaternions()
    return xr.DataArray(
        np.stack(list(orientations.values()), axis=1),
        dims=("time", "joint", "quaternion"),
        coords={"time": clip.time.values, "joint": list(orientations), "quaternion": list("xyzw")},
        name="rotation",
    )


class _Orientation(NamedTuple):
    """Rotations from rest, and the frames in which they are known; identity elsewhere."""

    rotation: Rotation
    known: np.ndarray

    def then(self, inner: _Orientation) -> _Orientation:
        return _Orientation(self.rotation * inner.rotation, self.known & inner.known)

    def relative_to(self, carrier: _Orientation) -> _Orientation:
        return _Orientation(carrier.rotation.inv() * self.rotation, self.known & carrier.known)

    def aligned_to(self, other: _Orientation) -> _Orientation:
        """Change the rest posture so that on average these orientations are the other's."""
        both = self.known & other.known
        if not both.any():
            return other
        difference = (other.rotation.inv() * self.rotation).as_quat()
        offset = Rotation.from_quat(difference[both]).mean()
        return _Orientation(self.rotation * offset.inv(), both)

    def quaternions(self) -> np.ndarray:
        return np.where(self.known[:, None], self.rotation.as_quat(), np.nan)


_REQUIRED = ("pelvis", "sternum", *(f"{side}_{j}" for j in ("hip", "shoulder") for side in SIDES))


def _refuse_missing(place: Mapping[str, np.ndarray]) -> None:
    if missing := [name for name in _REQUIRED if name not in place]:
        raise ValueError(
            f"Joint angles need the joints {list(_REQUIRED)}; {missing} are missing. Make joints "
            "of markers first, with virtual_markers()."
        )


def _captured_rotations(clip: xr.DataArray) -> dict[str, _Orientation]:
    if "rotation" not in clip.coords:
        return {}
    at = {str(name): clip.rotation.values[:, i] for i, name in enumerate(clip.marker.values)}
    captured = {}
    for name, bone in SKELETON_BONES.items():
        vectors = at.get("head" if name == "head" else name if "clavicle" in name else bone.start)
        if vectors is not None and (known := np.isfinite(vectors).all(axis=1)).any():
            rotation = Rotation.from_rotvec(np.where(known[:, None], vectors, 0.0))
            captured[name] = _Orientation(rotation, known)
    return captured


def _carrier(part: Literal["pelvis", "trunk"], place: Mapping[str, np.ndarray]) -> _Orientation:
    axes = body_frame(place, part)
    known = np.isfinite(axes.sum(axis=(1, 2)))
    axes = np.where(known[:, None, None], axes, np.eye(3))
    return _Orientation(Rotation.from_matrix(axes), known)


def _swing_and_twist(
    place: Mapping[str, np.ndarray], bone: _Bone, carrier: _Orientation
) -> _Orientation:
    """Return a bone's orientation relative to its carrier: swing after twist."""
    along, known = _direction(place[bone.end] - place[bone.start])
    rest, hinge = np.array(bone.rest), np.array(bone.hinge)
    swing = shortest_turn(rest, carrier.rotation.inv().apply(along))
    if not hinge.any() or bone.next_end not in place:
        return _Orientation(swing, known)
    onwards, _ = _direction(place[bone.next_end] - place[bone.end])
    normal = (carrier.rotation * swing).inv().apply(np.cross(along, onwards))
    axis = normal + HALF_TWIST_BEND * hinge
    twist = np.arctan2(axis @ np.cross(rest, hinge), axis @ hinge)
    return _Orientation(swing * Rotation.from_rotvec(twist[:, None] * rest), known)


def _direction(vectors: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return unit vectors, 0 where a vector is missing or has no length, and where it has one."""
    length = np.linalg.norm(vectors, axis=1)
    known = length > SHORTEST_MM
    unit = np.divide(vectors, length[:, None], out=np.zeros_like(vectors), where=known[:, None])
    return unit, known


def angle_between(a: ArrayLike, b: ArrayLike, *, kind: AngleDistance = "angle") -> np.ndarray:
    r"""Return the distance between orientations, :math:`2 \arccos |q_a \cdot q_b|`.

    Eq. 1 of Pražák et al. (2010) prints the dot product alone, which is 1 for equal orientations
    and changes its sign between q and -q, although both are the same rotation.

    Parameters
    ----------
    a, b : array of shape (..., 4)
        Unit quaternions.
    kind : {"angle", "one_minus_dot", "as_printed"}
        The angle of the rotation between them in radians; ``1 - |a . b|``; or ``a . b`` itself.

    Returns
    -------
    array of shape (...)

    See Also
    --------
    joint_quaternions : What it compares.
    FrameMetric : The metric of which it is d_k.

    References
    ----------
    Pražák et al. (2010), eq. 1.

    Examples
    --------
    >>> quarter = Rotation.from_rotvec([0, 0, np.pi / 2]).as_quat()
    >>> float(angle_between([0, 0, 0, 1], -quarter).round(4))
    1.5708
    """
    check_choice(kind, get_args(AngleDistance), "kind")
    a, b = (check_numbers(each, "quaternions", missing=True) for each in (a, b))
    pairs = zip(a.shape[::-1], b.shape[::-1], strict=False)
    if {*a.shape[-1:], *b.shape[-1:]} != {4} or any(m != n and 1 not in (m, n) for m, n in pairs):
        raise ValueError(f"Quaternions have four parts; got shapes {a.shape} and {b.shape}.")
    if kind == "angle":
        difference, total = np.linalg.norm(a - b, axis=-1), np.linalg.norm(a + b, axis=-1)
        return 4 * np.arctan2(np.minimum(difference, total), np.maximum(difference, total))
    dot = np.einsum("...i,...i", a, b)
    return dot if kind == "as_printed" else 1 - np.minimum(np.abs(dot), 1.0)
