"""Sentences about captures: verdicts, repairs, what was left out, and what a folder holds."""

from __future__ import annotations

from collections.abc import Mapping

import pandas as pd

from eigenwalker.markers.label_repair import Repair
from eigenwalker.quality.quality import (
    BONE_VARIATION,
    FLICKER_SHARE,
    FREQUENCIES_HZ,
    STEADY_R2,
    Quality,
)
from eigenwalker.study.body_warnings import WIDE_HIPS, RetargetingWarnings
from eigenwalker.study.process_capture import CaptureResult


def reasons(quality: Quality) -> list[str]:
    """Return a sentence for each finding that speaks against a capture.

    Parameters
    ----------
    quality : Quality
        As `assess` returns it, or ``process_capture(...).quality``.

    Returns
    -------
    list of str
        Empty for the verdict "use".

    See Also
    --------
    eigenwalker.quality.assess

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1)
    >>> reasons(ew.assess(walk.copy(data=walk.values * [1, -1, -1])))[0]
    'The head is not above the feet: the wrong axis points up.'
    """
    values = _values(quality)
    return [_SENTENCES[finding].format(**values) for finding in quality.findings]


def flag_of(quality: Quality) -> str:
    """Return all that speaks against a capture in one line, empty for the verdict "use"."""
    return " ".join(reasons(quality))


def capture_remark(flag: str, warnings: RetargetingWarnings | None = None) -> str:
    """Return what is wrong with a capture, and with its walk on the mannequin, in one line."""
    body = []
    if warnings and warnings.legs_cross:
        body.append("its legs cross on the mannequin, as they did not in the capture")
    if warnings and warnings.hip_ratio > WIDE_HIPS:
        body.append(
            f"its hips are {warnings.hip_ratio:.1f} times as wide beside its shoulders as joints "
            "are, so they are points on the skin"
        )
    remarks = [f"it is flagged: {flag.rstrip('.')}"] if flag else []
    return "; ".join([*remarks, ", and ".join(body)] if body else remarks)


def capture_lines(result: CaptureResult) -> list[str]:
    """Return what to know about a capture in addition to its walker, in sentences."""
    quality, walker = result.quality, result.walker
    explained = walker.fit.fourier_r2 if walker.fit else float("nan")
    lines = [
        f"{quality.n_strides} strides in {quality.duration_s:.0f} s at {walker.frequency_hz:.2f} "
        f"Hz; the sines of this walker hold {100 * explained:.0f} % of its movement."
    ]
    if flag := flag_of(quality):
        lines.append(flag)
    if quality.rebuilt:
        lines.append(f"Rebuilt: {'; '.join(quality.rebuilt)}.")
    if quality.unit_guessed:
        lines.append(f"The file names no unit; {quality.unit} was guessed from the height.")
    return lines


def repair_in_words(repair: Repair) -> str:
    """Return the markers and the frames of a repair."""
    markers = f"{repair.marker} and {repair.partner}" if repair.partner else repair.marker
    if repair.first_frame == repair.last_frame:
        return f"{markers}, frame {repair.first_frame}"
    return f"{markers}, frames {repair.first_frame} to {repair.last_frame}"


def _length(millimetres: float) -> str:
    if millimetres >= 1e5:
        return f"{millimetres / 1e6:.3g} km"
    return f"{millimetres:.3g} mm" if millimetres < 1000 else f"{millimetres / 1000:.3g} m"


def _values(quality: Quality) -> dict[str, object]:
    """Return what `_SENTENCES` name."""
    variation = quality.bone_length_variation
    limb = max(variation, key=lambda limb: variation[limb], default=("", ""))
    swaps = [repair_in_words(repair) for repair in quality.repairs if repair.kind == "swap"]
    jumping = dict.fromkeys(repair.marker for repair in quality.repairs if repair.kind == "jump")
    often = [name for name, share in quality.removed_share.items() if share > FLICKER_SHARE]
    return {
        "q": quality,
        "height": _length(quality.height_mm),
        "wrong_unit": f"the unit {quality.unit or 'of length'} is wrong",
        "rises": "rises" if quality.climb > 0 else "falls",
        "rise": abs(quality.climb_mm),
        "n_elastic": sum(share > BONE_VARIATION for share in variation.values()),
        "n_limbs": len(variation),
        "worst": f"{limb[0]} to {limb[1]}, {variation.get(limb, 0):.1%}",
        "repeated": ", ".join(quality.repeated),
        "swaps": "; ".join(swaps[:3]) + (f" and {len(swaps) - 3} more" if len(swaps) > 3 else ""),
        "often": ", ".join(often),
        "jumping": ", ".join(jumping),
    }


_NOT_PERIODIC = (
    "This is no steady walk: two harmonics explain {q.r2:.2f} of the movement, where steady walks "
    f"reach {STEADY_R2:.2f} or more."
)
_SENTENCES = {
    "head_below_feet": "The head is not above the feet: the wrong axis points up.",
    "leaning": "From feet to head the body leans by {q.lean_deg:.0f} degrees: the frame is tilted, "
    "or head or feet are not where they are said to be.",
    "impossible_height": "From feet to head the body measures {height}, which no walking person "
    "does: {wrong_unit}. Read it with unit=...",
    "small_body": "From feet to head the body measures {height}: if this is no small child, "
    "{wrong_unit}.",
    "no_steady_walk": "No steady walk was found. {q.problem}",
    "not_level": "This is no level walk: the body {rises} by {rise:.0f} mm over {q.n_strides} "
    "strides.",
    "hardly_periodic": _NOT_PERIODIC,
    "not_periodic": _NOT_PERIODIC,
    "cadence": "{q.frequency_hz:.2f} strides a second is not the pace of a walk, which is between "
    f"{FREQUENCIES_HZ[0]} and {FREQUENCIES_HZ[1]}; the frame rate may be wrong.",
    "one_stride": "Only one stride is steady, so nothing tells how it varies.",
    "unsteady": "This is no steady walk: {q.n_strides} strides hang together, {q.steady_share:.0%} "
    "of the time spent walking.",
    "filled_gaps": "Of the steady samples {q.filled_share:.0%} were missing and were filled.",
    "elastic_limbs": "{n_elastic} of {n_limbs} limbs change length by more than "
    f"{BONE_VARIATION:.0%}; worst from {{worst}}.",
    "sides_swapped": "Knees bend backwards: left is called right, or the capture is mirrored.",
    "repeated_names": "Several markers are called alike, and the first of them is taken: "
    "{repeated}.",
    "swapped_labels": "Left and right changed places and were put right: {swaps}.",
    "flicker": "Markers flicker, and gaps were left: {often}.",
    "jumps": "Markers jump: {jumping}.",
    "cut_short": "The file lacks {q.n_frames_cut} of the frames that it declares.",
}

_SUMMARY = {
    "rate_hz": ("rate", "{:.4g} Hz"),
    "duration_s": ("duration", "{:.3g} s"),
    "strides": ("strides found", "{:.0f}"),
    "frequency_hz": ("stride frequency", "{:.3f} Hz"),
    "r2": ("share explained", "{:.3f}"),
    "periodicity": ("periodicity", "{:.3f}"),
    "missing_share": ("missing samples", "{:.1%}"),
    "bone_variation": ("limb length varies by", "{:.1%}"),
    "wander_mm": ("drift", "{:.0f} mm"),
}
"""Columns of `Study.files`, their names in the summary, and how their values are written."""


def summary_in_words(files: pd.DataFrame) -> dict[str, str]:
    """Return medians, ranges and counts of the captures of a study."""
    read = files[files["status"] != "refused"]
    lines = {}
    for column, values in summarise(files).iterrows():
        name, form = _SUMMARY[str(column)]
        median, least, most = map(float, values)
        lines[name] = _range(median, least, most, form)
    for column, name in (("jumps", "jumps"), ("left_right_swaps", "left-right swaps")):
        if column in read:
            n_captures = (read[column] > 0).sum()
            lines[name] = (
                f"{read[column].sum():.0f} in {n_captures} captures" if n_captures else "none"
            )
    if "rebuilt" in read and (rebuilt := (read["rebuilt"].fillna("") != "").sum()):
        lines["rebuilt markers"] = f"in {rebuilt} captures"
    if "unwound_deg" in read and (turning := (read["unwound_deg"] > 0).sum()):
        lines["turning walks unwound"] = str(turning)
    for column, name in (("marker_set", "marker set"), ("verdict", "verdict")):
        if column in read:
            counts = read[column].value_counts()
            lines[name] = ", ".join(f"{value} {count}" for value, count in counts.items())
    return lines


def summarise(files: pd.DataFrame) -> pd.DataFrame:
    """Return medians and ranges of the captures of a study.

    Parameters
    ----------
    files : DataFrame
        ``Study.files``: one row a capture.

    Returns
    -------
    DataFrame
        One row a measure, such as ``frequency_hz``; columns ``median``, ``least``, ``most``.
        Refused captures are left out.

    Examples
    --------
    >>> files = pd.DataFrame({"rate_hz": [100, 100, 120], "status": "used"})
    >>> summarise(files)
             median  least   most
    rate_hz   100.0  100.0  120.0
    """
    read = files[files["status"] != "refused"]
    columns = [name for name in _SUMMARY if name in read and read[name].notna().any()]
    table = read[columns].agg(["median", "min", "max"]).T
    return table.rename(columns={"min": "least", "max": "most"})


def _range(median: float, least: float, most: float, form: str) -> str:
    low, high = (form.format(value).split(" ")[0] for value in (least, most))
    return form.format(median) + ("" if low == high else f" ({low} to {high})")


_INSPECTION = {
    "kind": ("kind", "{}"),
    "verdict": ("verdict", "{}"),
    "problems": ("problems", ""),
    "format": ("format", "{}"),
    "unit": ("unit", "{}"),
    "rate_hz": ("rate", "{:.6g} Hz"),
    "duration_s": ("duration", "{:.4g} s"),
    "n_frames": ("frames", "{}"),
    "n_strides": ("strides found", ""),
    "frequency_hz": ("stride frequency", "{:.3f} Hz"),
    "speed_mm_s": ("speed", "{:.0f} mm/s"),
    "r2": ("share explained", "{:.3f} by two harmonics"),
    "periodicity": ("periodicity", "{:.3f}"),
    "wander_mm": ("drift", "{:.0f} mm about a straight line"),
    "climb": ("climb", "{:.1%} of the way"),
    "height_mm": ("height", "{:.0f} mm from feet to head"),
    "marker_set": ("marker set", ""),
    "missing_samples": ("missing samples", "{:.2%}"),
    "missing_markers": ("never seen", ""),
    "filled_share": ("filled samples", "{:.2%} of the steady part"),
    "rebuilt": ("rebuilt markers", ""),
    "approximate": ("approximate joints", ""),
    "jumps": ("jumps", ""),
    "swaps": ("left-right swaps", ""),
    "bone_length_variation": ("limb length varies by", ""),
    "markers": ("markers", ""),
}
"""Facts of `inspect_file`, their names for people, and how numbers are written; "" for lists."""


def inspection_in_words(facts: Mapping[str, object]) -> dict[str, str | list[str]]:
    """Return what `inspect_file` finds, in words and with units."""
    if facts.get("kind") != "capture":
        return {
            name: _written(value, "{:.4g}" if isinstance(value, float) else "{}")
            for name, value in facts.items()
        }
    written = {
        name: _written(facts[name], form)
        for name, (_, form) in _INSPECTION.items()
        if name in facts
    }
    if isinstance(limbs := written.get("bone_length_variation"), list):
        written["bone_length_variation"] = [_as_percentage(entry) for entry in limbs]
    if "n_strides" in facts:
        written["n_strides"] = _strides(facts)
    if "marker_set" in facts:
        written["marker_set"] = _marker_set(facts)
    if facts.get("unit_guessed"):
        written["unit"] = f"{written.get('unit', 'unknown')}, guessed from the height of the body"
    return {_INSPECTION[name][0]: value for name, value in written.items()}


def _written(value: object, form: str) -> str | list[str]:
    if isinstance(value, list) or not form:
        return [str(entry) for entry in value] if isinstance(value, list) and value else "none"
    return "unknown" if value is None else form.format(value)


def _as_percentage(entry: str) -> str:
    name, _, share = entry.rpartition(": ")
    return f"{name}: {float(share):.1%}"


def _strides(facts: Mapping[str, object]) -> str:
    """Return how many strides were taken, and from where."""
    line = f"{facts['n_strides']}, {facts['steady_share']:.0%} of the time spent walking"
    if not facts["n_strides"] or facts["straight_passes"] == 1:
        return line
    if facts["straight_passes"] == 0:
        return f"{line}; the heading turned by {facts['unwound_deg']:.0f} degrees and was unwound"
    return f"{line}; from one of {facts['straight_passes']} straight passes"


def _marker_set(facts: Mapping[str, object]) -> str:
    """Return the marker set that was recognised, and how sure that is."""
    if facts["marker_set"] is None:
        return "unknown"
    share, next_best = facts.get("marker_set_share"), facts.get("marker_set_runner_up")
    line = str(facts["marker_set"])
    if isinstance(share, float):
        line += f", {share:.0%} of its points found"
    return line + (f" (next is {next_best})" if next_best else "")
