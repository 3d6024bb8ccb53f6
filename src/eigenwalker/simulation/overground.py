"""Walking somewhere: from steps in place to a path over ground, with its start and its turns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eigenwalker.simulation.cadence import Pace
from eigenwalker.simulation.segment_lengths import Body
from eigenwalker.simulation.walk_cycle_frames import Angles

_SETTING_OFF_S = 1.0
"""From standing to full speed takes about a stride."""


@dataclass(frozen=True)
class Route:
    """How someone goes: standing first, then along a line or an arc.

    Parameters
    ----------
    standing_s : float
        Seconds of standing before the first step.
    heading_deg : float
        Direction of the first step, anticlockwise from x.
    turning_deg_s : float
        How fast the direction changes, to the left, while walking at full speed.

    """

    standing_s: float = 0.0
    heading_deg: float = 0.0
    turning_deg_s: float = 0.0

    def vigour(self, time: np.ndarray) -> np.ndarray:
        """Return how far someone has set off: 0 while standing, 1 at full speed."""
        if self.standing_s <= 0:
            return np.ones(len(time))
        share = np.clip((time - self.standing_s) / _SETTING_OFF_S, 0.0, 1.0)
        return share**2 * (3 - 2 * share)

    def along(
        self, positions: dict[str, np.ndarray], time: np.ndarray, speed: float
    ) -> dict[str, np.ndarray]:
        """Return positions of a walk in place, carried and turned along the route.

        A foot that stands while the body turns pivots with it.
        """
        step = np.gradient(time) * self.vigour(time)
        heading = np.radians(self.heading_deg + self.turning_deg_s * (np.cumsum(step) - step))
        cos, sin = np.cos(heading), np.sin(heading)
        path = np.cumsum(speed * step[:, None] * np.stack([cos, sin], axis=1), axis=0)
        carried = {}
        for name, place in positions.items():
            x, y, z = place.T
            carried[name] = np.stack(
                [cos * x - sin * y + path[:, 0], sin * x + cos * y + path[:, 1], z], axis=1
            )
        return carried


def set_off(
    angles: Angles, pelvis: np.ndarray, body: Body, pace: Pace, vigour: np.ndarray
) -> tuple[Angles, np.ndarray]:
    """Return angles and pelvis path of someone who stands first: a blend with quiet standing."""
    standing = _standing(body, pace)
    knee, thigh = standing["knee_flexion"], standing["thigh"]
    down = body.thigh * np.cos(thigh) + body.shank * np.cos(thigh - knee)
    splay = standing["splay"]
    ahead = body.thigh * np.sin(thigh) + body.shank * np.sin(thigh - knee)
    height = down * np.cos(splay) + body.foot.height - body.hip[2]
    still = np.array([-body.hip[0] - ahead, 0.0, height])
    blended = {}
    for name, curve in angles.items():
        part = name.removeprefix("left_").removeprefix("right_")
        side = -1 if name.startswith("right") else 1
        rest = standing.get(part, 0.0) * (side if part == "splay" else 1)
        blended[name] = rest + vigour * (curve - rest)
    return blended, still + vigour[:, None] * (pelvis - still)


def _standing(body: Body, pace: Pace) -> dict[str, float]:
    """Angles of quiet standing, in radians: knees all but straight, arms hanging."""
    thigh, knee = np.radians(3.0), np.radians(6.0)
    down = body.thigh * np.cos(thigh) + body.shank * np.cos(thigh - knee)
    return {
        "thigh": thigh,
        "knee_flexion": knee,
        "splay": float(np.arcsin((pace.step_width / 2 - body.hip[1]) / down)),
        "elbow_flexion": np.radians(18.0),
        "shoulder_abduction": np.radians(8.0),
        "shoulder_rotation": np.radians(15.0),
        "foot_yaw": np.radians(-7.3),
    }
