"""The 15 joints of a walker from whatever markers or skeleton were captured."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any, Literal, NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.arguments import check_choice
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import check_trajectories, trajectories_at
from eigenwalker.markers.joint_centres import HIP_REGRESSIONS
from eigenwalker.markers.label_repair import Rebuilt, Repair, records_in, repair_labels
from eigenwalker.markers.mapping import MarkerMapping, as_mapping, targets
from eigenwalker.markers.marker_sets import (
    MEASURED,
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

MAX_WIDTH_MM = 300
_MAX_NAMES = 60
_MAX_LENGTH = 60


class _Joints(NamedTuple):
    """Joints, which are approximate, what was rebuilt, from which markers, and by which set."""

    joints: Points
    approximate: set[str]
    name: str
    rebuilt: tuple[Rebuilt, ...] = ()
    markers: frozenset[str] = frozenset()
    share: float = 1.0
    runner_up: str = ""


def virtual_markers(
    trajectories: xr.DataArray,
    *,
    joints: Literal["walker", "full"] = "walker",
    mapping: MarkerMapping | Mapping[str, Any] | str | Path | None = None,
    marker_set: str | None = None,
    hip_regression: str = "davis",
    widths_mm: Mapping[str, float] | None = None,
) -> xr.DataArray:
    """Return the 15 joints of a walker, from markers on the skin or another skeleton.

    Before that, labels that change sides are exchanged, and samples that are elsewhere for moments
    are taken out (`repair_labels`). Known are Plug-in Gait and its kin, the 41 markers of the CMU
    collection, landmarks after van Sint Jan, OptiTrack's sets, and the usual skeletons of BVH
    files (``markers/marker_sets.toml``).

    Parameters
    ----------
    trajectories : DataArray of shape (time, marker, axis)
        Millimetres, z up, as `read_mocap` gives them. Heading and place do not matter.
    joints : {"walker", "full"}
        Whether to keep feet, hands, clavicles and the top of the head too, where they are known.
    mapping : mapping of str to str or sequence of str, or path of a TOML file, optional
        For a set of your own: for each joint the marker that is it, or the markers whose midpoint
        it is. Joints left out are taken from the known sets. With ``{"joints": ..., "skin": ...}``,
        or a file that has these tables, landmarks on the skin may be named too, from which the
        centres of joints are computed (``eigenwalker info FILE --write-mapping`` begins such a
        file).
    marker_set : str, optional
        Name of the set; the first that gives all joints if left out.
    hip_regression : {"davis", "harrington", "bell"}
        Regression for the hip centres, for markers on the skin. Plug-in Gait uses Davis', so
        walkers agree with what laboratories see; Harrington's is nearer to images of hips.
    widths_mm : mapping of str to float, optional
        Widths ``"knee"``, ``"ankle"``, ``"elbow"`` as measured on the person, for sets without
        inner markers. If left out, the coordinates such as ``left_knee_width_mm`` are used, which
        `read_mocap` gives a capture whose file states them, or else shares of the leg.

    Returns
    -------
    DataArray of shape (time, marker, axis)
        Joints in the order of ``JOINTS.markers``, then the extra points; NaN where markers were
        missing and no other marker of the same rigid part was seen. To the attributes of the
        capture are added ``repairs`` (as `repair_labels` gives them), ``marker_set`` (name of the
        set), ``marker_set_share`` (share of its points for which there are markers),
        ``marker_set_runner_up`` (the next best set), ``approximate`` (joints that rest on a
        regression, an assumed width or a stand-in), and ``rebuilt`` (a tuple of `Rebuilt`).

    Raises
    ------
    ValueError
        If no known set gives all joints; the message names those that are missing.

    See Also
    --------
    eigenwalker.io.read_mocap : Reads captures.
    eigenwalker.gait.in_place : Takes the joints to a walk in place.

    References
    ----------
    Troje (2002), J Vision 2:371, Methods: the virtual markers.
    Davis et al. (1991), Hum Mov Sci 10:575; Harrington et al. (2007), J Biomech 40:595, table 4;
    Bell, Brand and Pedersen (1990), J Biomech 23:617: the hip centres.

    Examples
    --------
    A capture with names of its own, whose pelvis is the midpoint of two of its points:

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
    check_choice(joints, ("walker", "full"), "joints")
    check_choice(hip_regression, HIP_REGRESSIONS, "hip_regression")
    mapped = as_mapping(mapping)
    own, own_skin = _mapped_points(walk, mapped)
    on_skin = targets()["skin"]
    own_skin |= {name: own[name] for name in own if name not in on_skin} if own_skin else {}
    measures = Measures(hip_regression, _lengths(walk, widths_mm or {}))
    best = _best_set(_points_seen(walk), own, own_skin, measures, marker_set)
    order = [*JOINTS.markers]
    if joints == "full":
        order += [extra for extra in best.joints if extra not in order]
    values = np.stack([best.joints[joint] for joint in order], axis=1)
    result = trajectories_at(walk.time.values, values, order)
    scalars = {name: value for name, value in walk.coords.items() if not value.dims}
    result = result.assign_coords(scalars)
    result.attrs = walk.attrs | {
        "marker_set": best.name,
        "marker_set_share": best.share,
        "marker_set_runner_up": best.runner_up,
        "approximate": [joint for joint in order if joint in best.approximate],
        "rebuilt": best.rebuilt,
    }
    if joints == "walker" and best.markers and (repairs := records_in(walk, "repairs", Repair)):
        result.attrs["repairs"] = tuple(
            repair for repair in repairs if best.markers & {repair.marker, repair.partner}
        )
    return result


def _points_seen(walk: xr.DataArray) -> Points:
    """Return the markers that were seen at all, by name; refuse two people at once."""
    values = walk.values
    seen = np.isfinite(values[:1]).any(axis=(0, 2))
    if not seen.all():
        seen = ~np.isnan(values).all(axis=(0, 2))
    points = {str(walk.marker.values[i]): values[:, i] for i in np.flatnonzero(seen)}
    names = list(points)
    people = subjects(names)
    plain = [name.rpartition(":")[2] for name in names]
    if len(people) > 1 and len(set(plain)) < len(plain):
        raise ValueError(
            f"The capture holds markers of several people: {people}. Take one of them: "
            f"read_mocap(..., subject={people[0]!r})."
        )
    return points


def _mapped_points(walk: xr.DataArray, mapping: MarkerMapping) -> tuple[Points, Points]:
    """Return the joints, and the landmarks on the skin, that the user's mapping gives."""
    present = {str(name) for name in walk.marker.values}
    for target, markers in (*mapping.joints.items(), *mapping.skin.items()):
        if absent := [marker for marker in markers if marker not in present]:
            raise ValueError(
                f"The mapping names the markers {absent} for {target}{mapping.where(target)}, "
                f"which the capture lacks; it has {_shortened(sorted(present))}."
            )
    joints, skin = (
        {
            name: walk.sel(marker=list(markers)).values.mean(axis=1)
            for name, markers in table.items()
        }
        for table in (mapping.joints, mapping.skin)
    )
    return joints, skin


def _lengths(walk: xr.DataArray, widths_mm: Mapping[str, float]) -> dict[str, float]:
    """Return measured lengths by ``left_knee_width`` and so on: those given, else the capture's."""
    lengths = {
        str(name).removesuffix("_mm"): float(value)
        for name, value in walk.coords.items()
        if str(name).endswith(MEASURED)
    }
    for part, width in widths_mm.items():
        if part not in WIDTH_OF_LEG or not 0 < width < MAX_WIDTH_MM:
            raise ValueError(
                f"widths_mm has {part!r}: {width}; give millimetres for some of "
                f"{list(WIDTH_OF_LEG)}, up to {MAX_WIDTH_MM}."
            )
        lengths |= {f"{side}_{part}_width": float(width) for side in SIDES}
    return lengths


def _best_set(
    points: Points, own: Points, own_skin: Points, measures: Measures, marker_set: str | None
) -> _Joints:
    """Return the joints by the first set that gives all of them."""
    if set(JOINTS.markers) <= set(own):
        return _Joints(own, set(), "own mapping")
    sets = [known for known in known_sets() if marker_set in (None, known.name)]
    if not sets:
        check_choice(marker_set, [known.name for known in known_sets()], "marker_set")
    names = marker_names(tuple(points))
    missing: dict[str, list[str]] = {}
    for known in sets:
        result = _joints_of(points, names, known, own_skin, measures)
        joints = result.joints | own
        missing[known.name] = [joint for joint in JOINTS.markers if joint not in joints]
        if not missing[known.name]:
            name = f"{known.name}, with own mapping" if own or own_skin else known.name
            return result._replace(
                joints=joints,
                approximate=result.approximate - set(own),
                name=name,
                share=known.share_found(names),
                runner_up=_runner_up(known, names),
            )
    nearest = min(missing, key=lambda name: len(missing[name]))
    raise ValueError(
        f"No known marker set gives the joints {missing[nearest]} (the nearest is {nearest!r}). "
        "Name the markers that they are in a file: 'eigenwalker info FILE --write-mapping "
        "names.toml' begins it with what their places say. Then give it: "
        f"virtual_markers(..., mapping='names.toml'). The capture has {_shortened(list(points))}."
    )


def _runner_up(used: MarkerSet, names: MarkerNames) -> str:
    """Return which other set has most of its markers in the capture, and their share."""
    others = [known for known in known_sets()[:-1] if known is not used]
    nearest = max(others, key=lambda known: known.share_found(names))
    return f"{nearest.name}, {nearest.share_found(names):.0%}"


def _joints_of(
    points: Points, names: MarkerNames, known: MarkerSet, own_skin: Points, measures: Measures
) -> _Joints:
    """Return the joints by one marker set: those captured as such, others from the skin."""
    direct: Points = {}
    stand_ins: set[str] = set()
    rebuilt: list[Rebuilt] = []
    used: set[str] = set()
    for joint, entry in (*known.joints.items(), *known.extras.items()):
        if hit := names.find(entry):
            direct[joint] = midpoint([points[marker] for marker in hit.markers])
            stand_ins |= {joint} if hit.stand_in else set()
            used |= set(hit.markers) if joint in known.joints else set()
            if hit.lacking:
                rebuilt.append(Rebuilt(joint, "from", hit.markers, hit.lacking))
    hits = {
        landmark: hit.markers
        for landmark, entry in known.landmarks.items()
        if (hit := names.find(entry))
    }
    if not (hits or own_skin):
        return _Joints(direct, stand_ins, known.name, markers=frozenset(used))
    skin = {name: midpoint([points[marker] for marker in hits[name]]) for name in hits}
    used |= {marker for markers in hits.values() for marker in markers}
    joints, approximate, mirrored = joints_from_skin(skin | direct | own_skin, measures)
    return _Joints(
        joints | direct,
        (approximate - set(direct)) | stand_ins,
        known.name,
        (*rebuilt, *mirrored),
        frozenset(used),
    )


def _shortened(names: Sequence[str]) -> str:
    more = f" and {len(names) - _MAX_NAMES} more" if len(names) > _MAX_NAMES else ""
    return f"{[name[:_MAX_LENGTH] for name in names[:_MAX_NAMES]]}{more}"
