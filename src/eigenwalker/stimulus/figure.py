"""A figure of a stimulus: somebody who moves, and where in the scene."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from eigenwalker.core.skeleton import Skeleton
from eigenwalker.core.trajectories import check_trajectories, label_trajectories, sampling_rate
from eigenwalker.core.walker import Walker
from eigenwalker.plotting.links import LINKS

DECIMALS = 6
"""Of sampled trajectories in files, in mm."""


@dataclass(frozen=True, eq=False)
class Figure:
    """Somebody or something in a scene.

    Parameters
    ----------
    motion : Walker, or DataArray of shape (time, marker, axis)
        Coefficients, for what is periodic; or evenly sampled trajectories, for what is not. The
        first phase of a walker is 0 at 0 s, as is the first frame of trajectories.
    skeleton : Skeleton
        Who is joined to whom, and who is whose counterpart.
    position_mm : sequence of float
        Where its origin is in the scene.
    heading_deg : float
        By how much it is turned to its left.
    repeat : bool
        Whether trajectories begin anew after their last frame, or hold still.

    """

    motion: Walker | xr.DataArray
    skeleton: Skeleton = LINKS
    position_mm: Sequence[float] = (0.0, 0.0, 0.0)
    heading_deg: float = 0.0
    repeat: bool = False

    def to_dict(self) -> dict[str, Any]:
        """Return the figure as it stands in a file, samples as an array."""
        if isinstance(self.motion, Walker):
            markers, motion = self.motion.markers, {"walker": walker_to_dict(self.motion)}
        else:
            walk = check_trajectories(self.motion)
            markers = tuple(walk.marker.values.tolist())
            speed = walk.attrs.get("speed_mm_s")
            motion = {
                "trajectories": {
                    "markers": markers,
                    "rate_hz": round(sampling_rate(walk), DECIMALS),
                    "repeat": self.repeat,
                    "samples": walk.values.round(DECIMALS),
                    "speed_mm_s": _known(speed),
                }
            }
        body = self.skeleton.restricted_to(markers)
        return {
            **motion,
            "segments": body.segments,
            "pairs": body.pairs,
            "position_mm": tuple(map(float, self.position_mm)),
            "heading_deg": float(self.heading_deg),
        }

    @classmethod
    def from_dict(cls, figure: Mapping[str, Any]) -> Figure:
        """Return the figure that stands in the checked content of a file."""
        given = figure["walker"] or figure["trajectories"]
        if figure["walker"] is not None:
            motion: Walker | xr.DataArray = walker_from_dict(given)
        else:
            motion = label_trajectories(
                given["samples"], markers=given["markers"], rate_hz=given["rate_hz"]
            )
            if given["speed_mm_s"] is not None:
                motion.attrs["speed_mm_s"] = given["speed_mm_s"]
        body = Skeleton(given["markers"], figure["segments"], figure["pairs"])
        repeat = figure["walker"] is None and given["repeat"]
        return cls(motion, body, figure["position_mm"], figure["heading_deg"], repeat)


def walker_to_dict(walker: Walker) -> dict[str, Any]:
    """Return a walker as it stands in a stimulus file."""
    return {
        "markers": walker.markers,
        "p0": walker.p0.tolist(),
        "p": walker.p.tolist(),
        "harmonics": walker.harmonics.tolist(),
        "phases": walker.phases.tolist(),
        "frequency_hz": walker.frequency_hz,
        "form": walker.form,
        "speed_mm_s": _known(walker.speed_mm_s),
    }


def walker_from_dict(walker: Mapping[str, Any]) -> Walker:
    """Return the walker that stands in the checked content of a stimulus file."""
    speed = walker["speed_mm_s"]
    n_markers = len(walker["markers"])
    return Walker(
        markers=walker["markers"],
        p0=np.array(walker["p0"]),
        p=np.array(walker["p"], dtype=float).reshape(-1, n_markers, 3),
        harmonics=np.array(walker["harmonics"], dtype=int),
        phases=np.array(walker["phases"], dtype=float),
        frequency_hz=walker["frequency_hz"],
        form=walker["form"],
        speed_mm_s=float("nan") if speed is None else speed,
    )


def _known(speed: object) -> float | None:
    return float(speed) if isinstance(speed, int | float) and np.isfinite(speed) else None
