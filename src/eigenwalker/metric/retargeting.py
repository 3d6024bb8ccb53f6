"""Walks shown on a neutral mannequin: movement is kept, build is not (Pražák et al. 2010)."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Literal

import numpy as np
import xarray as xr
from scipy.spatial.transform import Rotation

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import missing_markers, sampling_rate, trajectories_at
from eigenwalker.gait.filtering import low_passed
from eigenwalker.metric.clips import Clip, as_trajectories

HEIGHT_MM = 1693.0
"""Midway between the mean woman and the mean man of ANSUR II (Gordon et al. 2014)."""

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
"""Lengths as shares of height, midway between women and men. From ANSUR II: biacromial breadth,
heights of acromion, trochanter, tibiale and malleolus, acromion-radiale and radiale-stylion,
converted to joint centres as in `simulation` (Bell 1989 for the width of the hips, Harrington 2007
for their place in the pelvis); foot: ankle to ball, from foot length and heel-to-ball length.
Chosen: the hand, to the knuckles; the neck, from sternum to the centre of the head; the height of
the ball of the foot."""

SIDES = ("left", "right")

_RECOGNISED_BY = {
    ("pelvis", "sternum"): "spine",
    ("left_shoulder", "right_shoulder"): "shoulder_width",
    ("left_hip", "right_hip"): "hip_width",
    **{(f"{side}_hip", f"{side}_knee"): "thigh" for side in SIDES},
    **{(f"{side}_knee", f"{side}_ankle"): "calf" for side in SIDES},
}
_TOLERANCE = 0.01
"""Relative difference of lengths: no person has all of them so near to the mannequin's."""

LENGTHS_MM = {part: HEIGHT_MM * share for part, share in SHARES.items()}

SHORTEST_MM = 1.0
"""Vectors shorter than this have no direction."""

_LIMBS = {
    f"{side}_{joint}": (f"{side}_{carrier}", part)
    for joint, carrier, part in (
        ("elbow", "shoulder", "upper_arm"),
        ("wrist", "elbow", "forearm"),
        ("hand", "wrist", "hand"),
        ("knee", "hip", "thigh"),
        ("ankle", "knee", "calf"),
        ("toe", "ankle", "foot"),
    )
    for side in SIDES
}
"""Joints with the joint that carries them and the length between, from the trunk outwards."""

LOW_SHARE = 0.05
"""Quantile of the height of the lower ankle that counts as standing, robust against noise."""
SMOOTH_HZ = 3.0
"""Above this frequency the pelvis of the mannequin rises and falls as the walker's."""
FLAT_SHARE = 0.2
"""Share of frames in which a foot stands flat for sure: it does so for a third of the stride."""
SOFTNESS = 0.01
"""Share of the leg over which one foot replaces the other as the lower one."""


def retarget(walk: Clip) -> xr.DataArray:
    r"""Return a walk on a neutral mannequin, which moves as the walker did.

    The proportions of the mannequin (`SHARES`, `HEIGHT_MM`) are constant, midway between those of
    women and men. In each frame

    1. spine, neck, arms, hands, thighs and calves keep the walker's directions and get the
       mannequin's lengths; hips and shoulders are fixed to the frames of pelvis and trunk.
    2. feet are rotated by a constant angle, so that where they stand (ankle and toe lowest, a fifth
       of the frames) they are as flat as the mannequin's: how steep the line from ankle to toe is
       depends on build and on where the points are.
    3. the pelvis moves as the walker's, scaled by the length of the legs, at the height at which
       the lower ankle is as high above the floor as the walker's, scaled. This correction is
       low-pass filtered at 3 Hz. The lower ankle is the soft minimum
       :math:`-s \ln\left(\tfrac12 (e^{-z_l / s} + e^{-z_r / s})\right)`, s a hundredth of the leg.
    4. a foot whose toe would be below the floor is made less steep.

    Parameters
    ----------
    walk : DataArray of shape (time, marker, axis), Walker, Loop or PreparedClip
        A walk of the 15 joints in place (`virtual_markers`, `in_place`), and hands and feet. A
        coordinate ``rotation`` is kept.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        Positions in mm of the 15 joints, and of hands and toes where the walk has them; NaN from a
        missing joint outwards. z = 0 is the floor. Clavicles, heels and the top of the head belong
        to the build and are left out.

    Raises
    ------
    ValueError
        If some of the 15 joints are missing.

    See Also
    --------
    prepare_walk : From a capture to the mannequin in one step.

    References
    ----------
    Pražák et al. (2010), section 3; Gordon et al. (2014), ANSUR II, for the proportions.

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1, height_mm=1500)
    >>> bool(np.allclose(retarget(walk * 1.2), retarget(walk)))
    True
    """
    walk = as_trajectories(walk)
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
            standing[f"{side}_toe"] = _above_floor(ankle, toe)
    names = [*JOINTS.markers, *(name for name in standing if name not in JOINTS.markers)]
    positions = np.stack([standing[name] for name in names], axis=1)
    result = trajectories_at(walk.time.values, positions, names)
    result.attrs = walk.attrs | {"retargeted": True}
    return _with_rotations(result, walk)


def is_mannequin(clip: xr.DataArray) -> bool:
    """Return whether a clip is of the mannequin: trunk and legs have its lengths."""
    place = {str(name): clip.values[:, i] for i, name in enumerate(clip.marker.values)}
    ratios = []
    for (start, end), part in _RECOGNISED_BY.items():
        if start in place and end in place:
            lengths = np.linalg.norm(place[start] - place[end], axis=1)
            lengths = lengths[np.isfinite(lengths)]
            ratios.append(lengths.sum() / max(len(lengths), 1) / LENGTHS_MM[part])
    return len(ratios) >= 3 and bool((np.abs(np.array(ratios) - 1) <= _TOLERANCE).all())


def body_frame(place: Mapping[str, np.ndarray], part: Literal["pelvis", "trunk"]) -> np.ndarray:
    """Return the axes of pelvis or trunk in the room as the columns of rotation matrices.

    x is forward, y the line of the hips for the pelvis, of the shoulders for the trunk, z the
    direction from pelvis to sternum, made orthogonal to y. Positions are of shape (time, 3) by
    name, matrices of shape (time, 3, 3); NaN where joints are missing.
    """
    joint = {"pelvis": "hip", "trunk": "shoulder"}[part]
    left, right = (place[f"{side}_{joint}"] for side in SIDES)
    y, up = left - right, place["sternum"] - place["pelvis"]
    x = np.cross(y, up)
    axes = np.stack([x, y, np.cross(x, y)], axis=2)
    lengths = np.linalg.norm(axes, axis=1, keepdims=True)
    known = (lengths > SHORTEST_MM).all(axis=2, keepdims=True)
    return np.divide(axes, lengths, out=np.full_like(axes, np.nan), where=known) + 0.0


def _placed(seen: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return the mannequin's joints relative to its pelvis, from the trunk outwards."""
    pelvis, trunk = body_frame(seen, "pelvis"), body_frame(seen, "trunk")
    spine = seen["sternum"] - seen["pelvis"]
    placed = {"pelvis": np.zeros_like(spine), "sternum": _along(spine, "spine")}
    placed["head"] = placed["sternum"] + _along(seen["head"] - seen["sternum"], "neck")
    for side, outwards in (("left", 0.5), ("right", -0.5)):
        across, below = outwards * LENGTHS_MM["hip_width"], LENGTHS_MM["hip_below"]
        placed[f"{side}_hip"] = pelvis @ np.array([LENGTHS_MM["hip_before"], across, -below])
        across, below = outwards * LENGTHS_MM["shoulder_width"], LENGTHS_MM["shoulder_below"]
        placed[f"{side}_shoulder"] = placed["sternum"] + trunk @ np.array([0, across, -below])
    for joint, (carrier, part) in _LIMBS.items():
        if joint in seen:
            vector = seen[joint] - seen[carrier]
            if part == "foot":
                vector = _from_flat(vector, seen[joint][:, 2] + seen[carrier][:, 2])
            placed[joint] = placed[carrier] + _along(vector, part)
    return placed


def _from_flat(foot: np.ndarray, heights: np.ndarray) -> np.ndarray:
    """Return a foot rotated by the constant angle that makes it flat where it stands."""
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


def _along(vector: np.ndarray, part: str) -> np.ndarray:
    """Return vectors of the mannequin's length in a seen direction; NaN where there is none."""
    length = np.linalg.norm(vector, axis=1, keepdims=True)
    unit = np.divide(vector, length, out=np.full_like(vector, np.nan), where=length > 0)
    return LENGTHS_MM[part] * unit


def _root(
    seen: Mapping[str, np.ndarray], placed: Mapping[str, np.ndarray], rate_hz: float
) -> np.ndarray:
    """Return the positions of the mannequin's pelvis.

    The correction of its height is smoothed so that the body is as smooth as the walker's; ankles
    are off by some millimetres then.
    """
    scale = (LENGTHS_MM["thigh"] + LENGTHS_MM["calf"]) / _leg(seen)
    root = scale * seen["pelvis"]
    lower = scale * _lower_ankle(seen, softness=SOFTNESS * _leg(seen))
    clearance = lower - np.nanquantile(lower, LOW_SHARE)
    below_pelvis = _lower_ankle(placed, softness=SOFTNESS * scale * _leg(seen))
    correction = LENGTHS_MM["ankle_height"] + clearance - below_pelvis - root[:, 2]
    if rate_hz > 2 * SMOOTH_HZ:
        correction = low_passed(correction[:, None, None], rate_hz, SMOOTH_HZ)[:, 0, 0]
    root[:, 2] += correction
    return root


def _leg(places: Mapping[str, np.ndarray]) -> float:
    """Return the mean length of thigh and calf together."""
    bones = [
        (f"{s}_{a}", f"{s}_{b}") for s in SIDES for a, b in (("hip", "knee"), ("knee", "ankle"))
    ]
    lengths = [np.linalg.norm(places[a] - places[b], axis=1) for a, b in bones]
    return float(np.nanmean(lengths) * 2)


def _lower_ankle(places: Mapping[str, np.ndarray], *, softness: float) -> np.ndarray:
    """Return the soft minimum of both heights, smooth where the other ankle becomes the lower."""
    left, right = (-places[f"{side}_ankle"][:, 2] / softness for side in SIDES)
    return -softness * (np.logaddexp(left, right) - np.log(2))


def _above_floor(ankle: np.ndarray, toe: np.ndarray) -> np.ndarray:
    """Return toes above the floor: a foot that would go through it is made less steep."""
    length, floor = LENGTHS_MM["foot"], LENGTHS_MM["toe_height"]
    softness = SOFTNESS * (LENGTHS_MM["thigh"] + LENGTHS_MM["calf"])
    vector = toe - ankle
    with np.errstate(invalid="ignore"):  # of toes that were not seen
        height = floor + softness * np.logaddexp(0, (toe[:, 2] - floor) / softness)
    rise = np.clip(height - ankle[:, 2], -length, length)
    level = np.linalg.norm(vector[:, :2], axis=1)
    wider = np.divide(np.sqrt(length**2 - rise**2), level, out=np.ones_like(rise), where=level > 0)
    return ankle + np.column_stack([vector[:, :2] * wider[:, None], rise])


def _with_rotations(result: xr.DataArray, walk: xr.DataArray) -> xr.DataArray:
    if "rotation" not in walk.coords:
        return result
    turns = walk.rotation.drop_vars("rotation").reindex(marker=result.marker)
    return result.assign_coords(rotation=(result.dims, turns.values))
