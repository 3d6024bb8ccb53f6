"""The joint groups of Pražák et al. (2010, fig. 5): left and right share a weight."""

from __future__ import annotations

from collections.abc import Sequence

from eigenwalker.metric.frame_metrics import By

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
"""The joint whose place stands for a bone (A37): its proximal one; after it, what stands in."""


def group_points(
    names: Sequence[str], by: By = "positions", *, mannequin: bool = False
) -> dict[str, tuple[str, ...]]:
    """Return which points stand for each joint group, among those that a clip has.

    Figure 5 of Pražák et al. (2010) names bones, their eqs. 2 and 3 take places of joints. By
    positions and velocities a bone is its proximal joint (A37), since "the most important feature
    of the arm is the elbow" and its highest weight is the forearm's: upper arm is shoulder, forearm
    elbow, hand wrist, thigh hip, calf knee. The clavicle is where it begins, or else the sternum;
    the toe is the toe, or else the ankle. By angles a bone is itself.

    Parameters
    ----------
    names : sequence of str
        Markers of a clip, or for angles the bones of `joint_quaternions`.
    by : {"positions", "velocities", "angles"}
        What is compared.
    mannequin : bool
        Whether these are points of the mannequin (`retarget`), whose shoulders sit on its sternum:
        there the sternum tells nothing of clavicles that shoulders do not, and does not stand in.

    Returns
    -------
    dict of str to tuple of str
        Points by group, in the order of `GROUPS`; groups that the clip lacks are left out. Where
        one side is missing, the other stands for both.

    Raises
    ------
    ValueError
        If there is no group at all.

    Examples
    --------
    >>> points = group_points(ew.JOINTS.markers)
    >>> points["forearm"], points["clavicle"]
    (('left_elbow', 'right_elbow'), ('sternum',))

    """
    present = set(map(str, names))
    found = {group: _members(group, present, by) for group in GROUPS}
    if mannequin and found["clavicle"] == ("sternum",):
        del found["clavicle"]
    found = {group: points for group, points in found.items() if points}
    if not found:
        raise ValueError(
            f"None of the joint groups {list(GROUPS)} can be had from {sorted(present)[:20]}; "
            "name the joints first, with virtual_markers()."
        )
    return found


def _members(group: str, present: set[str], by: By) -> tuple[str, ...]:
    patterns = ("{}_" + group, group) if by == "angles" else _POINT[group]
    for pattern in patterns:
        points = dict.fromkeys(pattern.format(side) for side in ("left", "right"))
        if kept := tuple(point for point in points if point in present):
            return kept
    return ()
