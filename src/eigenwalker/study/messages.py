"""What `inspect_file` finds in a capture, in words and with units, for people to read."""

from __future__ import annotations

from collections.abc import Mapping


def in_words(facts: Mapping[str, object]) -> dict[str, str | list[str]]:
    """Return what is known of a capture or population, each fact under a name in plain words.

    Parameters
    ----------
    facts : mapping
        As `inspect_file` returns them.

    Returns
    -------
    dict of str to str or list of str
        Lists hold one sentence or one name an entry.

    Examples
    --------
    >>> told = in_words({"kind": "capture", "rate_hz": 120.0, "wander_mm": None, "jumps": []})
    >>> told["rate"], told["drift"], told["jumps"]
    ('120 Hz', 'unknown', 'none')

    """
    if facts.get("kind") != "capture":
        return {name: _plain(value) for name, value in facts.items()}
    told: dict[str, str | list[str]] = {}
    for name, (label, form) in _MEASURES.items():
        if name in facts:
            told[label] = _number(facts[name], form)
    for name, label in _LISTS.items():
        if name in facts:
            told[label] = _listed(facts[name])
    if isinstance(limbs := told.get("limb length varies by"), list):
        told["limb length varies by"] = [_as_percentage(entry) for entry in limbs]
    if "n_strides" in facts:
        told["strides found"] = _strides(facts)
    if "marker_set" in facts:
        told["marker set"] = _marker_set(facts)
    if facts.get("unit_guessed"):
        told["unit"] = f"{told.get('unit', 'unknown')}, guessed from the height of the body"
    return {label: told[label] for label in _ORDER if label in told}


_MEASURES = {
    "kind": ("kind", "{}"),
    "verdict": ("verdict", "{}"),
    "format": ("format", "{}"),
    "unit": ("unit", "{}"),
    "rate_hz": ("rate", "{:.6g} Hz"),
    "duration_s": ("duration", "{:.4g} s"),
    "n_frames": ("frames", "{}"),
    "frequency_hz": ("stride frequency", "{:.3f} Hz"),
    "speed_mm_s": ("speed", "{:.0f} mm/s"),
    "r2": ("share explained", "{:.3f} by two harmonics"),
    "periodicity": ("periodicity", "{:.3f}"),
    "wander_mm": ("drift", "{:.0f} mm about a straight line"),
    "climb": ("climb", "{:.1%} of the way"),
    "height_mm": ("height", "{:.0f} mm from feet to head"),
    "missing_samples": ("missing samples", "{:.2%}"),
    "filled_share": ("filled samples", "{:.2%} of the steady part"),
}
_LISTS = {
    "problems": "problems",
    "missing_markers": "never seen",
    "rebuilt": "rebuilt markers",
    "approximate": "approximate joints",
    "jumps": "jumps",
    "swaps": "left-right swaps",
    "bone_length_variation": "limb length varies by",
    "markers": "markers",
}
_ORDER = (
    "kind",
    "verdict",
    "problems",
    "format",
    "unit",
    "rate",
    "duration",
    "frames",
    "strides found",
    "stride frequency",
    "speed",
    "share explained",
    "periodicity",
    "drift",
    "climb",
    "height",
    "marker set",
    "missing samples",
    "never seen",
    "filled samples",
    "rebuilt markers",
    "approximate joints",
    "jumps",
    "left-right swaps",
    "limb length varies by",
    "markers",
)


def _number(value: object, form: str) -> str:
    return "unknown" if value is None else form.format(value)


def _plain(value: object) -> str | list[str]:
    if isinstance(value, list):
        return _listed(value)
    return f"{value:.4g}" if isinstance(value, float) else _number(value, "{}")


def _listed(entries: object) -> str | list[str]:
    if not isinstance(entries, list) or not entries:
        return "none"
    return [str(entry) for entry in entries]


def _as_percentage(entry: str) -> str:
    name, _, share = entry.rpartition(": ")
    return f"{name}: {float(share):.1%}"


def _strides(facts: Mapping[str, object]) -> str:
    """How many strides were taken, and from where."""
    told = f"{facts['n_strides']}, {facts['steady_share']:.0%} of the time spent walking"
    if facts["straight_passes"] == 0 and facts["n_strides"]:
        return f"{told}; the heading turned by {facts['unwound_deg']:.0f} degrees and was unwound"
    if facts["straight_passes"] != 1 and facts["n_strides"]:
        return f"{told}; from one of {facts['straight_passes']} straight passes"
    return told


def _marker_set(facts: Mapping[str, object]) -> str:
    """Which set it was taken for, and how sure that is."""
    if facts["marker_set"] is None:
        return "unknown"
    share, next_best = facts.get("marker_set_share"), facts.get("marker_set_runner_up")
    told = str(facts["marker_set"])
    if isinstance(share, float):
        told += f", {share:.0%} of its points found"
    return told + (f" (next is {next_best})" if next_best else "")
