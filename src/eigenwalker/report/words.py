"""The fixed words of the reports, of ``words.toml``, and sentences that reports on walks share."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from importlib.resources import files
from typing import Any

import matplotlib.figure
import xarray as xr

from eigenwalker.metric.retargeting import is_mannequin
from eigenwalker.report.blocks import Figure

WORDS: dict[str, Any] = tomllib.loads(
    files("eigenwalker.report").joinpath("words.toml").read_text(encoding="utf-8")
)
CITE, TABLES = WORDS["cite"], WORDS["tables"]


def figure(drawing: matplotlib.figure.Figure, name: str, **values: object) -> Figure:
    """Return a figure with its caption and its text for screen readers, in which values stand."""
    return Figure(drawing, *(text.format(**values) for text in WORDS["figures"][name].values()))


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
