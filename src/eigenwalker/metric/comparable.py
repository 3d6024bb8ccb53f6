"""Captures made comparable: joints, in place, on the neutral mannequin (P2, P4)."""

from __future__ import annotations

import pandas as pd
import xarray as xr

from eigenwalker.gait import in_place
from eigenwalker.gait.gaps import MAX_GAP_S, find_gaps
from eigenwalker.metric.captured_rotations import with_rotations
from eigenwalker.metric.frame_metrics import By
from eigenwalker.metric.groups import group_points
from eigenwalker.metric.retargeting import retarget
from eigenwalker.mocap import virtual_markers
from eigenwalker.skeleton import JOINTS
from eigenwalker.trajectories import sampling_rate


def comparable_walk(capture: xr.DataArray, *, mannequin: bool = True) -> xr.DataArray:
    """Return the steady strides of a capture as a walk that can be compared with others.

    Joints are made of markers, feet, hands and captured rotations kept where there are any; the
    walk is brought in place, facing +x; and shown on the neutral mannequin, so that what differs
    is how people move and not how they are built.

    Parameters
    ----------
    capture : DataArray of shape (time, marker, axis)
        As `read_mocap` gives it, or joints.
    mannequin : bool
        Whether to show the walk on the mannequin (`retarget`), rather than on its own body.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        ``attrs["left_out"]`` names hands, feet and the like that were hidden for too long.

    Raises
    ------
    ValueError
        As `virtual_markers` and `in_place` do.

    Examples
    --------
    >>> walk = comparable_walk(ew.simulate_walk(seed=1, markers="skin"))
    >>> walk.attrs["retargeted"], "left_toe" in walk.marker
    (True, True)

    """
    joints = with_rotations(virtual_markers(capture, joints="full"), capture)
    hidden = _hidden(joints)
    walk = in_place(joints.drop_sel(marker=hidden)).assign_attrs(left_out=hidden)
    return retarget(walk) if mannequin else walk


def _hidden(joints: xr.DataArray) -> list[str]:
    """Return hands, feet and the like that were not seen for longer than can be filled."""
    longest = MAX_GAP_S * sampling_rate(joints)
    gaps = [gap for gap in find_gaps(joints.values) if gap.stop - gap.start > longest]
    names = {str(joints.marker.values[gap.marker]) for gap in gaps}
    return sorted(names - set(JOINTS.markers))


def by_group(points: pd.DataFrame, by: By) -> pd.DataFrame:
    """Return a table of joint groups from one of points: the columns that `PerceptualMetric` takes.

    Parameters
    ----------
    points : DataFrame of pairs by points
        Mean F(d) of each point, as `pair_components` gives it.
    by : {"positions", "velocities", "angles"}
        What was compared.

    Returns
    -------
    DataFrame of pairs by groups
        Means over the points that stand for a group, both sides alike; groups that the points
        cannot tell are left out.

    Examples
    --------
    >>> points = pd.DataFrame({"left_knee": [10.0], "right_knee": [20.0], "head": [5.0]})
    >>> by_group(points, "positions").to_dict("records")
    [{'head': 5.0, 'calf': 15.0}]

    """
    groups = group_points([str(name) for name in points.columns], by)
    means = {group: points[list(names)].mean(axis=1) for group, names in groups.items()}
    return pd.DataFrame(means, index=points.index)
