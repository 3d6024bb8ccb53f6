"""Sentences that the reports on differences of walks share."""

from __future__ import annotations

from collections.abc import Sequence

import xarray as xr

from eigenwalker.metric.retargeting import is_mannequin

CITE = (
    "Pražák, M., McDonnell, R., Kavan, L., & O'Sullivan, C. (2010). A perception based metric for "
    "comparing human locomotion. Computer Animation and Social Agents."
)
SCALE_IS_UNKNOWN = (
    "The published weights tell how joint groups compare. The unit in which the paper measured, "
    "and what its normalisation constant does, are not known, so that the number has no scale of "
    "its own and tells no share of observers: compare it with those of other pairs. "
    "PerceptualMetric fits a scale to observers' answers."
)
WHERE_POINTS_SIT = (
    "Captures of different marker sets also differ by where their points sit on the body, joint "
    "angles most of all: compare like with like where you can."
)


def plain_name(name: object) -> str:
    """Return a joint or a joint group as it is written in a sentence."""
    return str(name).replace("_", " ")


def body_sentence(clips: Sequence[xr.DataArray]) -> str:
    """Return on whose bodies walks are shown."""
    walks = "Both walks" if len(clips) == 2 else "All walks"
    if all(is_mannequin(clip) for clip in clips):
        return (
            f"{walks} are shown on a neutral mannequin of fixed proportions, so that only "
            "movements differ."
        )
    return "Each walk has its own body, whose build counts too."


def missing_points(clips: Sequence[xr.DataArray]) -> list[str]:
    """Return the points that not all walks have, in a sentence; none if there are none."""
    markers = [set(map(str, clip.marker.values)) for clip in clips]
    missing = sorted(set.union(*markers) - set.intersection(*markers))
    names = ", ".join(map(plain_name, missing))
    who = "one of the walks lacks" if len(clips) == 2 else "some of the walks lack"
    return [f"Left out, as {who} them: {names}."] if missing else []
