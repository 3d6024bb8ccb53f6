"""The 15 joints of a walker from whatever markers or skeleton were captured."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from typing import Literal, NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import check_trajectories, trajectories_at
from eigenwalker.markers.joint_centres import HIP_REGRESSIONS
from eigenwalker.markers.label_repair import repair_labels
from eigenwalker.markers.marker_sets import (
    SIDES,
    MarkerNames,
    MarkerSet,
    known_sets,
    marker_names,
    subjects,
)
from eigenwalker.markers.skin_markers import (
    WIDTH_OF_LEG,
    Measures,
    Points,
    joints_from_skin,
    midpoint,
)

MOST_WIDTH_MM = 300
_SHOWN = 60
_LONGEST = 60


class _Joints(NamedTuple):
    """Joints, which are approximate, what was rebuilt, from which markers, and by which set."""

    joints: Points
    approximate: set[str]
    name: str
    rebuilt: tuple[str, ...] = ()
    markers: frozenset[str] = frozenset()
    share: float = 1.0
    runner_up: str = ""


def virtual_markers(
    trajectories: xr.DataArray,
    *,
    joints: Literal["walker", "full"] = "walker",
    mapping: Mapping[str, str | Sequence[str]] | None = None,
    marker_set: str | None = None,
    hip_regression: str = "davis",
    widths_mm: Mapping[str, float] | None = None,
) -> xr.DataArray:
    """Return the 15 joints of a walker (J3, J4), from markers on the skin or another skeleton.

    Before that, labels that change sides are put right and samples that are elsewhere for moments
    are taken out (`repair_labels`). Known are Plug-in Gait and its kin, the 41 markers of the CMU
    collection, landmarks after van Sint Jan, OptiTrack's sets, and the usual skeletons of BVH
    files: see ``mocap/marker_sets.toml``.

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
    hip_regression : {"davis", "harrington", "bell"}
        Where hip centres are in the pelvis, for markers on the skin. Plug-in Gait takes Davis', so
        walkers agree with what laboratories see; Harrington's is nearer to images of hips.
    widths_mm : mapping of str to float, optional
        Widths ``"knee"``, ``"ankle"``, ``"elbow"`` as measured on the person, for sets
        without inner markers. If left out, those in the file count, or else shares of the leg.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        Joints in the order of ``JOINTS.markers``, then the extra points. NaN where markers were
        missing and nothing rigid beside them tells where they were. Attributes of the capture
        stay; ``attrs["repairs"]`` holds what was repaired (`repair_labels`),
        ``attrs["marker_set"]`` names the set, ``attrs["marker_set_share"]`` says for which share
        of what it asks there are markers, ``attrs["marker_set_runner_up"]`` which other set is
        nearest, ``attrs["approximate"]`` which joints rest on a regression, an assumed width or a
        stand-in, and ``attrs["rebuilt"]`` what stands for markers that were never seen.

    Raises
    ------
    ValueError
        If the set is not known, naming the joints that could not be found.

    Examples
    --------
    A capture with names of its own; its pelvis is the middle between two of its points:

    >>> walk = ew.simulate_walk(seed=1)
    >>> capture = walk.assign_coords(marker=[f"point {i}" for i in range(15)])
    >>> mapping = {joint: f"point {i}" for i, joint in enumerate(ew.JOINTS.markers)}
    >>> mapping["pelvis"] = ["point 9", "point 12"]
    >>> joints = virtual_markers(capture, mapping=mapping)
    >>> joints.attrs["marker_set"], joints.marker.values[8].item()
    ('own mapping', 'pelvis')

    """
    walk = check_trajectories(trajectories)
    with suppress(ValueError):  # where frames are not evenly spaced
        walk = repair_labels(walk)
    if joints not in ("walker", "full"):
        raise ValueError(f"joints={joints!r} is not known; give 'walker' or 'full'.")
    if hip_regression not in HIP_REGRESSIONS:
        raise ValueError(
            f"hip_regression={hip_regression!r} is not known; give one of {list(HIP_REGRESSIONS)}."
        )
    seen = _seen(walk)
    own = _mapped(walk, mapping or {})
    measures = Measures(hip_regression, _lengths(walk, widths_mm or {}))
    place = {str(name): index for index, name in enumerate(walk.marker.values)}
    points = {name: walk.values[:, place[name]] for name in seen}
    found = _best_set(points, own, measures, marker_set)
    order = [*JOINTS.markers]
    if joints == "full":
        order += [extra for extra in found.joints if extra not in order]
    values = np.stack([found.joints[joint] for joint in order], axis=1)
    result = trajectories_at(walk.time.values, values, order)
    result.attrs = walk.attrs | {
        "marker_set": found.name,
        "marker_set_share": found.share,
        "marker_set_runner_up": found.runner_up,
        "approximate": [joint for joint in order if joint in found.approximate],
        "rebuilt": list(found.rebuilt),
    }
    if joints == "walker" and found.markers and "repairs" in walk.attrs:
        result.attrs["repairs"] = tuple(
            repair
            for repair in walk.attrs["repairs"]
            if found.markers & {repair.marker, repair.partner}
        )
    return result


def _seen(walk: xr.DataArray) -> list[str]:
    """Return the names of the markers that were seen at all; refuse two people at once."""
    values = walk.values
    seen = np.isfinite(values[:1]).any(axis=(0, 2))
    if not seen.all():
        seen = ~np.isnan(values).all(axis=(0, 2))
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


def _lengths(walk: xr.DataArray, widths_mm: Mapping[str, float]) -> dict[str, float]:
    """Return measured lengths by ``left_knee_width`` and so on: those given, else the file's."""
    lengths = {
        str(key).removesuffix("_mm"): float(value)
        for key, value in walk.attrs.items()
        if str(key).endswith(("_width_mm", "_leg_length_mm", "_shoulder_offset_mm"))
    }
    for part, width in widths_mm.items():
        if part not in WIDTH_OF_LEG or not 0 < width < MOST_WIDTH_MM:
            raise ValueError(
                f"widths_mm has {part!r}: {width}; give millimetres for some of "
                f"{list(WIDTH_OF_LEG)}, up to {MOST_WIDTH_MM}."
            )
        lengths |= {f"{side}_{part}_width": float(width) for side in SIDES}
    return lengths


def _best_set(points: Points, own: Points, measures: Measures, marker_set: str | None) -> _Joints:
    """Return the joints by the first set that gives all; refuse if none does."""
    if set(JOINTS.markers) <= set(own):
        return _Joints(own, set(), "own mapping")
    sets = [known for known in known_sets() if marker_set in (None, known.name)]
    if not sets:
        raise ValueError(
            f"marker_set={marker_set!r} is not known; give one of "
            f"{[known.name for known in known_sets()]}."
        )
    names = marker_names(tuple(points))
    missing: dict[str, list[str]] = {}
    for known in sets:
        found = _joints_of(points, names, known, measures)
        joints = found.joints | own
        missing[known.name] = [joint for joint in JOINTS.markers if joint not in joints]
        if not missing[known.name]:
            name = f"{known.name}, with own mapping" if own else known.name
            return found._replace(
                joints=joints,
                approximate=found.approximate - set(own),
                name=name,
                share=known.share_found(names),
                runner_up=_runner_up(known, names),
            )
    nearest = min(missing, key=lambda name: len(missing[name]))
    raise ValueError(
        f"No known marker set gives the joints {missing[nearest]} (the nearest is {nearest!r}). "
        "Tell which markers they are: virtual_markers(..., mapping="
        f"{{{missing[nearest][0]!r}: ['marker', 'marker'], ...}}), one marker, or several whose "
        f"midpoint is the joint. The capture has {_shortened(list(points))}."
    )


def _runner_up(taken: MarkerSet, names: MarkerNames) -> str:
    """Return which other set has most of its markers in the capture, and the share it has."""
    others = [known for known in known_sets()[:-1] if known is not taken]
    nearest = max(others, key=lambda known: known.share_found(names))
    return f"{nearest.name}, {nearest.share_found(names):.0%}"


def _joints_of(points: Points, names: MarkerNames, known: MarkerSet, measures: Measures) -> _Joints:
    """Return what one marker set makes of the capture: joints as they are, others from the skin."""
    direct: Points = {}
    stand_ins: set[str] = set()
    rebuilt: list[str] = []
    used: set[str] = set()
    for joint, entry in (*known.joints.items(), *known.extras.items()):
        if hit := names.find(entry):
            direct[joint] = midpoint([points[marker] for marker in hit.markers])
            stand_ins |= {joint} if hit.stand_in else set()
            used |= set(hit.markers) if joint in known.joints else set()
            if hit.lacking:
                there, gone = " and ".join(hit.markers), " and ".join(hit.lacking)
                rebuilt.append(f"{joint}: from {there}, without {gone}")
    hits = {
        landmark: hit.markers
        for landmark, entry in known.landmarks.items()
        if (hit := names.find(entry))
    }
    if not hits:
        return _Joints(direct, stand_ins, known.name, markers=frozenset(used))
    skin = {name: midpoint([points[marker] for marker in hits[name]]) for name in hits}
    used |= {marker for markers in hits.values() for marker in markers}
    joints, approximate, mirrored = joints_from_skin(skin | direct, measures)
    return _Joints(
        joints | direct,
        (approximate - set(direct)) | stand_ins,
        known.name,
        (*rebuilt, *mirrored),
        frozenset(used),
    )


def _shortened(names: Sequence[str]) -> str:
    more = f" and {len(names) - _SHOWN} more" if len(names) > _SHOWN else ""
    return f"{[name[:_LONGEST] for name in names[:_SHOWN]]}{more}"
