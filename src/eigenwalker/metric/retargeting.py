"""A walk shown on a neutral mannequin (P2): whose body it was cannot be seen, how it moved can."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import (
    check_trajectories,
    missing_markers,
    sampling_rate,
    trajectories_at,
)
from eigenwalker.gait.filtering import low_passed
from eigenwalker.metric.body_frames import SIDES, body_frame

HEIGHT_MM = 1693.0
"""Mid-way between the mean woman and the mean man of ANSUR II (Gordon et al. 2014)."""

SHARES: Mapping[str, float] = {
    "hip_width": 0.103,
    "hip_below": 0.049,
    "hip_before": 0.017,
    "shoulder_width": 0.2025,
    "spine": 0.240,
    "shoulder_below": 0.008,
    "neck": 0.124,
    "upper_arm": 0.173,
    "forearm": 0.1504,
    "hand": 0.058,
    "thigh": 0.2459,
    "calf": 0.2275,
    "foot": 0.100,
    "ankle_height": 0.0400,
    "toe_height": 0.0120,
}
"""Lengths as shares of height, mid-way between women and men. Of ANSUR II: biacromial breadth,
heights of acromion, trochanter, tibiale and malleolus, acromion-radiale and radiale-stylion,
brought to joint centres as `simulation` does (Bell 1989 for the hips, whose place in the pelvis is
that of Harrington 2007); foot: ankle to ball, from foot length and heel to ball. Chosen: the hand,
to the knuckles; the neck, from sternum to the centre of the head; the height of the ball."""

_LIMBS = {
    **{f"{side}_elbow": (f"{side}_shoulder", "upper_arm") for side in SIDES},
    **{f"{side}_wrist": (f"{side}_elbow", "forearm") for side in SIDES},
    **{f"{side}_hand": (f"{side}_wrist", "hand") for side in SIDES},
    **{f"{side}_knee": (f"{side}_hip", "thigh") for side in SIDES},
    **{f"{side}_ankle": (f"{side}_knee", "calf") for side in SIDES},
    **{f"{side}_toe": (f"{side}_ankle", "foot") for side in SIDES},
}
"""Joints with the joint that carries them and the length between, from the trunk outwards."""

LOW_SHARE = 0.05
"""Share of frames in which the lower ankle is lower than what counts as standing, against noise."""
SMOOTH_HZ = 3.0
"""Frequency above which the mannequin's body rises and falls as the walker's, whatever its legs."""
FLAT_SHARE = 0.2
"""Share of frames in which a foot surely stands flat: it does so for a third of the stride."""
SOFTNESS = 0.01
"""Share of the leg over which one foot takes over from the other as the lower one."""


def retarget(walk: xr.DataArray) -> xr.DataArray:
    """Return the walk of a neutral mannequin that moves as someone did.

    The mannequin's proportions are fixed, mid-way between those of women and men. The directions of
    spine, neck, arms, hands, thighs and calves are kept in every frame, as are the turns of pelvis
    and shoulders; widths, lengths, and where shoulders and hips sit, are the mannequin's. Feet turn
    as the walker's do from where they stand flat: how steep the line from ankle to toe is then, is
    a matter of build and of where the points sit; and no further than the floor lets them. What the
    body does on the whole is scaled by the length of the legs, and it is as high over the ground as
    its lower ankle asks for.

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis)
        A walk of the 15 joints (`virtual_markers`), in place (`in_place`), hands and feet if
        there are any. Positions of a capture of rotations, such as BVH, are those of turned bones,
        so the directions kept are the captured ones; a coordinate ``rotation`` stays as it is.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        The 15 joints, and hands and toes where the walk has them; NaN from where a joint
        was not seen, outwards. z = 0 is the floor. Clavicles, heels and the top of the head are
        parts of the build and left out.

    Raises
    ------
    ValueError
        If some of the 15 joints are missing.

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1, height_mm=1500)
    >>> tall, short = retarget(walk * 1.2), retarget(walk)
    >>> bool(np.allclose(tall, short))
    True

    """
    walk = check_trajectories(walk)
    if missing := missing_markers(walk, JOINTS.markers):
        raise ValueError(
            f"Retargeting needs the 15 joints; {missing} are missing. Make joints of markers "
            "first, with virtual_markers()."
        )
    seen = {str(name): walk.values[:, i] for i, name in enumerate(walk.marker.values)}
    placed = _placed(seen)
    root = _root(seen, placed, sampling_rate(walk) if walk.sizes["time"] > 1 else 0.0)
    standing = {name: place + root for name, place in placed.items()}
    for side in SIDES:
        if f"{side}_toe" in standing:
            ankle, toe = (standing[f"{side}_{joint}"] for joint in ("ankle", "toe"))
            standing[f"{side}_toe"] = _out_of_the_floor(ankle, toe)
    names = [*JOINTS.markers, *(name for name in standing if name not in JOINTS.markers)]
    positions = np.stack([standing[name] for name in names], axis=1)
    result = trajectories_at(walk.time.values, positions, names)
    result.attrs = walk.attrs | {"retargeted": True}
    return _with_rotations(result, walk)


def _length(part: str) -> float:
    return HEIGHT_MM * SHARES[part]


def _placed(seen: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return the mannequin's joints about its pelvis, from the inside outwards."""
    pelvis, trunk = body_frame(seen, "pelvis"), body_frame(seen, "trunk")
    spine = seen["sternum"] - seen["pelvis"]
    placed = {"pelvis": np.zeros_like(spine), "sternum": _along(spine, "spine")}
    placed["head"] = placed["sternum"] + _along(seen["head"] - seen["sternum"], "neck")
    for side, outwards in (("left", 0.5), ("right", -0.5)):
        hip = (_length("hip_before"), outwards * _length("hip_width"), -_length("hip_below"))
        placed[f"{side}_hip"] = pelvis @ np.array(hip)
        shoulder = np.array([0, outwards * _length("shoulder_width"), -_length("shoulder_below")])
        placed[f"{side}_shoulder"] = placed["sternum"] + trunk @ shoulder
    for joint, (carrier, part) in _LIMBS.items():
        if joint in seen:
            way = seen[joint] - seen[carrier]
            if part == "foot":
                way = _from_flat(way, seen[joint][:, 2] + seen[carrier][:, 2])
            placed[joint] = placed[carrier] + _along(way, part)
    return placed


def _from_flat(foot: np.ndarray, heights: np.ndarray) -> np.ndarray:
    """Return a foot turned by the one angle that makes it lie flat where it stands.

    It stands where ankle and toe together are low: from when the heel is down to when it lifts.
    """
    seen = np.isfinite(foot).all(axis=1) & np.isfinite(heights)
    if not seen.any():
        return foot
    standing = seen & (heights <= np.quantile(heights[seen], FLAT_SHARE))
    forward, flat = foot[seen, :2].mean(axis=0), foot[standing].mean(axis=0)
    length = np.linalg.norm(forward)
    if not length > 0:
        return foot
    down = np.arctan2(-flat[2], np.linalg.norm(flat[:2]))
    wanted = np.arcsin((SHARES["ankle_height"] - SHARES["toe_height"]) / SHARES["foot"])
    across = np.array([-forward[1], forward[0], 0.0]) / length
    return foot @ Rotation.from_rotvec((wanted - down) * across).as_matrix().T


def _along(way: np.ndarray, part: str) -> np.ndarray:
    """Return a part of the mannequin's length that points as it was seen; NaN where it was not."""
    length = np.linalg.norm(way, axis=1, keepdims=True)
    return _length(part) * np.divide(way, length, out=np.full_like(way, np.nan), where=length > 0)


def _root(
    seen: Mapping[str, np.ndarray], placed: Mapping[str, np.ndarray], rate_hz: float
) -> np.ndarray:
    """Return where the mannequin's pelvis is: it moves as the walker's, on legs of its own.

    What these ask for beside the walker's own rise and fall is smoothed: its body is no less smooth
    than the walker's, and its feet give way by some millimetres.
    """
    scale = (_length("thigh") + _length("calf")) / _leg(seen)
    root = scale * seen["pelvis"]
    lower = scale * _lower_ankle(seen, softness=SOFTNESS * _leg(seen))
    lifted = lower - np.nanquantile(lower, LOW_SHARE)
    over_ankle = _lower_ankle(placed, softness=SOFTNESS * scale * _leg(seen))
    higher = _length("ankle_height") + lifted - over_ankle - root[:, 2]
    if rate_hz > 2 * SMOOTH_HZ:
        higher = low_passed(higher[:, None, None], rate_hz, SMOOTH_HZ)[:, 0, 0]
    root[:, 2] += higher
    return root


def _leg(places: Mapping[str, np.ndarray]) -> float:
    """Return the mean length of thigh and calf together."""
    bones = [
        (f"{s}_{a}", f"{s}_{b}") for s in SIDES for a, b in (("hip", "knee"), ("knee", "ankle"))
    ]
    lengths = [np.linalg.norm(places[a] - places[b], axis=1) for a, b in bones]
    return float(np.nanmean(lengths) * 2)


def _lower_ankle(places: Mapping[str, np.ndarray], *, softness: float) -> np.ndarray:
    """Return the height of the lower ankle, with no kink where the other becomes the lower one."""
    left, right = (-places[f"{side}_ankle"][:, 2] / softness for side in SIDES)
    return -softness * (np.logaddexp(left, right) - np.log(2))


def _out_of_the_floor(ankle: np.ndarray, toe: np.ndarray) -> np.ndarray:
    """Return a toe that the floor holds: a foot that would go through it is less steep instead."""
    length, floor = _length("foot"), _length("toe_height")
    softness = SOFTNESS * (_length("thigh") + _length("calf"))
    way = toe - ankle
    with np.errstate(invalid="ignore"):  # of toes that were not seen
        height = floor + softness * np.logaddexp(0, (toe[:, 2] - floor) / softness)
    rise = np.clip(height - ankle[:, 2], -length, length)
    level = np.linalg.norm(way[:, :2], axis=1)
    wider = np.divide(np.sqrt(length**2 - rise**2), level, out=np.ones_like(rise), where=level > 0)
    return ankle + np.column_stack([way[:, :2] * wider[:, None], rise])


def _with_rotations(result: xr.DataArray, walk: xr.DataArray) -> xr.DataArray:
    if "rotation" not in walk.coords:
        return result
    turns = walk.rotation.drop_vars("rotation").reindex(marker=result.marker)
    return result.assign_coords(rotation=(result.dims, turns.values))
