"""The joint groups of Pražák et al. (2010, fig. 5), in which left and right share a weight."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import pandas as pd

By = Literal["positions", "velocities", "angles"]

GROUPS = ("head", "clavicle", "upper_arm", "forearm", "hand", "thigh", "calf", "toe")
"""The columns of figure 5, in its order."""

BONES = ("head", *(f"{side}_{group}" for side in ("left", "right") for group in GROUPS[1:]))
"""The bones whose angles are compared; each turns in the joint at its proximal end."""

_POINT = {
    "head": ("head",),
    "clavicle": ("{}_clavicle", "sternum"),
    "upper_arm": ("{}_shoulder",),
    "forearm": ("{}_elbow",),
    "hand": ("{}_wrist",),
    "thigh": ("{}_hip",),
    "calf": ("{}_knee",),
    "toe": ("{}_toe", "{}_ankle"),
}
"""The joint whose position stands for a bone: its proximal one; after it, the substitute."""


def group_points(
    names: Sequence[str], by: By = "positions", *, mannequin: bool = False
) -> dict[str, tuple[str, ...]]:
    """Return the points of each joint group, among those that a clip has.

    Figure 5 names bones, while eqs. 2 and 3 take joint positions. By positions and velocities a
    bone is its proximal joint, since "the most important feature of the arm is the elbow" and the
    forearm has the highest weight. The clavicle is its own joint, or else the sternum; the toe is
    the toe, or else the ankle. By angles a bone is itself.

    Parameters
    ----------
    names : sequence of str
        Markers of a clip, or for angles the bones of `joint_quaternions`.
    by : {"positions", "velocities", "angles"}
        What is compared.
    mannequin : bool
        Whether the clip is of the mannequin (`retarget`), whose shoulders are fixed to its
        sternum, so that the sternum does not stand for clavicles.

    Returns
    -------
    dict of str to tuple of str
        Points by group, in the order of `GROUPS`, without groups that the clip lacks. Where one
        side is missing, the other stands for both.

    See Also
    --------
    GroupMetric : Weights of the groups.

    References
    ----------
    Pražák et al. (2010), fig. 5 and section 5.

    Examples
    --------
    >>> points = group_points(ew.JOINTS.markers)
    >>> points["forearm"], points["clavicle"]
    (('left_elbow', 'right_elbow'), ('sternum',))
    """
    present = set(map(str, names))
    groups = {group: _members(group, present, by) for group in GROUPS}
    if mannequin and groups["clavicle"] == ("sternum",):
        del groups["clavicle"]
    groups = {group: points for group, points in groups.items() if points}
    if not groups:
        raise ValueError(
            f"None of the joint groups {list(GROUPS)} can be had from {sorted(present)[:20]}; "
            "name the joints first, with virtual_markers()."
        )
    return groups


def _members(group: str, present: set[str], by: By) -> tuple[str, ...]:
    patterns = ("{}_" + group, group) if by == "angles" else _POINT[group]
    for pattern in patterns:
        points = dict.fromkeys(pattern.format(side) for side in ("left", "right"))
        if members := tuple(point for point in points if point in present):
            return members
    return ()


def group_means(points: pd.DataFrame, by: By, *, mannequin: bool = False) -> pd.DataFrame:
    """Return the means of a table of pairs by points over the points of each joint group."""
    groups = group_points([str(name) for name in points.columns], by, mannequin=mannequin)
    means = {group: points[list(names)].mean(axis=1) for group, names in groups.items()}
    return pd.DataFrame(means, index=points.index)
