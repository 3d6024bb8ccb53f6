"""What a folder of captures holds, in a few lines: medians, ranges and counts."""

from __future__ import annotations

import pandas as pd

MEASURES = {
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
"""Columns of a study's table that are summed up, what they are called, and how they are written."""


def summary_of(files: pd.DataFrame) -> dict[str, str]:
    """Return what the captures of a study have in common, and how far they differ.

    Parameters
    ----------
    files : DataFrame
        The table of a `Study`: one row a capture.

    Returns
    -------
    dict of str to str
        Medians with the least and the most, and counts, in words.

    Examples
    --------
    >>> files = pd.DataFrame({"rate_hz": [100, 100, 120], "jumps": [0, 2, 1]})
    >>> summary_of(files.assign(status="used"))
    {'rate': '100 Hz (100 to 120)', 'jumps': '3 in 2 captures'}

    """
    read = files[files["status"] != "refused"]
    told = {}
    for column, (name, form) in MEASURES.items():
        if column in read and read[column].notna().any():
            told[name] = _in_words(read[column], form)
    for column, name in (("jumps", "jumps"), ("left_right_swaps", "left-right swaps")):
        if column in read:
            with_some = (read[column] > 0).sum()
            told[name] = (
                f"{read[column].sum():.0f} in {with_some} captures" if with_some else "none"
            )
    if "rebuilt" in read and (rebuilt := (read["rebuilt"].fillna("") != "").sum()):
        told["rebuilt markers"] = f"in {rebuilt} captures"
    if "unwound_deg" in read and (turning := (read["unwound_deg"] > 0).sum()):
        told["turning walks unwound"] = str(turning)
    for column, name in (("marker_set", "marker set"), ("verdict", "verdict")):
        if column in read:
            counts = read[column].value_counts()
            told[name] = ", ".join(f"{value} {count}" for value, count in counts.items())
    return told


def _in_words(values: pd.Series, form: str) -> str:
    middle = form.format(values.median())
    least, most = (form.format(value).split(" ")[0] for value in (values.min(), values.max()))
    return middle if least == most else f"{middle} ({least} to {most})"
