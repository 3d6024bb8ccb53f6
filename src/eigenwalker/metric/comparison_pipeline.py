"""Captures made comparable: joints, in place, on the neutral mannequin (P2, P4)."""

from __future__ import annotations

import xarray as xr

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.gait.gaps import MAX_GAP_S, find_gaps
from eigenwalker.gait.in_place import in_place
from eigenwalker.markers.virtual_markers import virtual_markers
from eigenwalker.metric.captured_rotations import with_rotations
from eigenwalker.metric.retargeting import retarget


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
