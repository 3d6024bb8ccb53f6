"""The 15 joints of a walker from whatever markers or skeleton were captured."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Literal

import numpy as np
import xarray as xr

from eigenwalker.mocap.joint_centres import HIP_REGRESSIONS
from eigenwalker.mocap.marker_names import MarkerNames, MarkerSet, known_sets, subjects
from eigenwalker.mocap.skin import Body, joints_from_skin
from eigenwalker.skeleton import JOINTS
from eigenwalker.trajectories import check_trajectories, trajectories_at

_SHOWN = 60


def virtual_markers(
    trajectories: xr.DataArray,
    *,
    joints: Literal["walker", "full"] = "walker",
    mapping: Mapping[str, str | Sequence[str]] | None = None,
    marker_set: str | None = None,
    hip_regression: str = "harrington",
    widths_mm: Mapping[str, float] | None = None,
) -> xr.DataArray:
    """Return the 15 joints of a walker (J3, J4), from markers on the skin or another skeleton.

    Known are Plug-in Gait and its kin, the 41 markers of the CMU collection, landmarks after van Sint
    Jan, OptiTrack's sets, and the common skeletons of BVH files: see ``mocap/marker_sets.toml``.

    Parameters
    ----------
    trajectories : DataArray of shape (time, marker, axis)
        Millimetres, z up, as `read_mocap` gives them. Facing and place do not matter.
    joints : {"walker", "full"}
        Whether to keep feet, hands, clavicles and the top of the head too, where they are known.
    mapping : mapping of str to str or sequence of str, optional
        For a set of your own: for each joint the marker that is it, or the markers whose
        midpoint it is. Joints left out are looked for in the known sets.
    marker_set : str, optional
        Name of the set to take; the first that gives all joints if left out.
    hip_regression : {"harrington", "bell", "davis"}
        Where hip centres are in the pelvis, for markers on the skin.
    widths_mm : mapping of str to float, optional
        Widths ``"knee"``, ``"ankle"``, ``"elbow"`` as measured on the person, for sets
        without inner markers. If left out, those in the file count, or else shares of the leg.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        Joints in the order of ``JOINTS.markers``, then the extra points. NaN where markers were
        missing and nothing rigid beside them tells where they were. ``attrs["marker_set"]`` names the
        set, ``attrs["approximate"]`` the joints that rest on a regression, an assumed width or a stand-in.

    Raises
    ------
    ValueError
        If the set is not known, naming the joints that could not be found.

    Examples
    --------
    >>> points = np.zeros((3, 3, 3))
    >>> capture = ew.label_trajectories(points, markers=["hip", "KneeIn", "KneeOut"], rate_hz=60)
    >>> virtual_markers(capture, mapping={"left_knee": ["KneeIn", "KneeOut"], "pelvis": "hip"})
    Traceback (most recent call last):
    ...
    ValueError: No known marker set gives the joints ['head', 'sternum', 'left_shoulder', ...

    """
    walk = check_trajectories(trajectories)
    if joints not in ("walker", "full"):
        raise ValueError(f"joints={joints!r} is not known; give 'walker' or 'full'.")
    if hip_regression not in HIP_REGRESSIONS:
        raise ValueError(
            f"hip_regression={hip_regression!r} is not known; give one of {list(HIP_REGRESSIONS)}."
        )
    seen = _seen(walk)
    own = _mapped(walk, mapping or {})
    body = Body(
        points={str(name): walk.sel(marker=name).values for name in seen},
        names=MarkerNames(seen),
        hip_regression=hip_regression,
        widths_mm=_widths(walk, widths_mm),
    )
    found, approximate, name = _best_set(body, own, marker_set, seen)
    order = [*JOINTS.markers]
    if joints == "full":
        order += [extra for extra in found if extra not in order]
    result = trajectories_at(
        walk.time.values, np.stack([found[joint] for joint in order], axis=1), order
    )
    result.attrs = walk.attrs | {
        "marker_set": name,
        "approximate": [joint for joint in order if joint in approximate],
    }
    return result


def _seen(walk: xr.DataArray) -> list[str]:
    """Return the names of the markers that were seen at all; refuse two people at once."""
    seen = ~np.isnan(walk.values).all(axis=(0, 2))
    names = [str(name) for name in walk.marker.values[seen]]
    people = subjects(names)
    plain = [name.rpartition(":")[2] for name in names]
    if len(people) > 1 and len(set(plain)) < len(plain):
        raise ValueError(
            f"The capture holds markers of several people: {people}. Take one of them first, "
            f"for instance by trajectories.sel(marker=[name for name in "
            f"trajectories.marker.values if name.startswith({people[0] + ':'!r})])."
        )
    return names


def _mapped(
    walk: xr.DataArray, mapping: Mapping[str, str | Sequence[str]]
) -> dict[str, np.ndarray]:
    """Return the joints that a mapping of one's own gives."""
    present = set(walk.marker.values.tolist())
    wanted = {
        joint: [names] if isinstance(names, str) else list(names)
        for joint, names in mapping.items()
    }
    absent = sorted({name for names in wanted.values() for name in names} - present)
    empty = [joint for joint, names in wanted.items() if not names]
    if absent or empty:
        raise ValueError(
            f"The mapping names the markers {absent}, which the capture lacks"
            + (f", and none for {empty}" if empty else "")
            + f"; it has {_shortened(sorted(present))}."
        )
    return {joint: walk.sel(marker=names).values.mean(axis=1) for joint, names in wanted.items()}


def _widths(walk: xr.DataArray, widths_mm: Mapping[str, float] | None) -> dict[str, float]:
    """Return widths by ``left_knee`` and so on: those given, else those that the file holds."""
    widths: dict[str, float] = {}
    for part in ("knee", "ankle", "elbow"):
        for side in ("left", "right"):
            held = walk.attrs.get(f"{side}_{part}_width_mm")
            if held is not None:
                widths[f"{side}_{part}"] = float(held)
    for part, width in (widths_mm or {}).items():
        if part.rpartition("_")[2] not in ("knee", "ankle", "elbow") or not 0 < width < 300:
            raise ValueError(
                f"widths_mm has {part!r}: {width}; give millimetres for 'knee', 'ankle' or 'elbow'."
            )
        sides = [part] if "_" in part else [f"left_{part}", f"right_{part}"]
        widths.update(dict.fromkeys(sides, float(width)))
    return widths


def _best_set(
    body: Body, own: Mapping[str, np.ndarray], marker_set: str | None, seen: Sequence[str]
) -> tuple[dict[str, np.ndarray], set[str], str]:
    """Return joints, which of them are approximate, and the set that gives all of them."""
    if not set(JOINTS.markers) - set(own):
        return dict(own), set(), "own mapping"
    sets = [known for known in known_sets() if marker_set in (None, known.name)]
    if not sets:
        raise ValueError(
            f"marker_set={marker_set!r} is not known; give one of "
            f"{[known.name for known in known_sets()]}."
        )
    best: list[str] | None = None
    best_name = ""
    for known in sets:
        found, approximate = _joints_of(body, known)
        found |= own
        missing = [joint for joint in JOINTS.markers if joint not in found]
        if not missing:
            name = f"{known.name}, with own mapping" if own else known.name
            return found, approximate - set(own), name
        if best is None or len(missing) < len(best):
            best, best_name = missing, known.name
    raise ValueError(
        f"No known marker set gives the joints {best} (the nearest is {best_name!r}). Tell which "
        f"markers they are: virtual_markers(..., mapping={{{best[0]!r}: ['marker', 'marker'], ...}}), "
        f"one marker or several whose midpoint is the joint. The capture has {_shortened(seen)}."
    )


def _joints_of(body: Body, known: MarkerSet) -> tuple[dict[str, np.ndarray], set[str]]:
    found, approximate = joints_from_skin(body, known.landmarks)
    direct = {joint: body.midpoint(entry) for joint, entry in (known.joints | known.extras).items()}
    found |= {joint: point for joint, point in direct.items() if point is not None}
    return found, approximate


def _shortened(names: Sequence[str]) -> str:
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return f"{list(names[:_SHOWN])}{more}"
