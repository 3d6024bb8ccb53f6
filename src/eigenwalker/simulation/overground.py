"""Walking over ground: from steps in place to a path, with its start and its turns."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from eigenwalker.core.kinematics import rotate_z
from eigenwalker.simulation.body import Body
from eigenwalker.simulation.prior_curves import GaitParameters
from eigenwalker.simulation.walk_cycle_frames import Angles

_START_S = 1.0
"""From standing to full speed takes about a stride."""


@dataclass(frozen=True)
class Route:
    """A route over ground: standing first, then along a line or an arc.

    Parameters
    ----------
    standing_s : float
        Seconds of standing before the first step.
    heading_deg : float
        Direction of the first step, anticlockwise from x, in degrees.
    turning_deg_s : float
        How fast the direction changes, to the left, while walking at full speed, in degrees a
        second.

    See Also
    --------
    simulate_walk : takes a route.

    Examples
    --------
    >>> walk = ew.simulate_walk(seed=1, route=Route(heading_deg=90))
    >>> bool(np.ptp(walk.sel(marker="pelvis", axis="y").values) > 10_000)  # 12 s along y, in mm
    True
    """

    standing_s: float = 0.0
    heading_deg: float = 0.0
    turning_deg_s: float = 0.0

    def speed_ramp(self, time: np.ndarray) -> np.ndarray:
        """Return the share of full speed at each time: 0 while standing, then smoothly up to 1."""
        if self.standing_s <= 0:
            return np.ones(len(time))
        share = np.clip((time - self.standing_s) / _START_S, 0.0, 1.0)
        return share**2 * (3 - 2 * share)

    def along(self, positions: np.ndarray, time: np.ndarray, speed: float) -> np.ndarray:
        """Return positions (time, marker, axis) in place, carried and turned along the route.

        A foot that stands while the body turns pivots with it.
        """
        step = np.gradient(time) * self.speed_ramp(time)
        heading = np.radians(self.heading_deg + self.turning_deg_s * (np.cumsum(step) - step))
        direction = np.stack([np.cos(heading), np.sin(heading)], axis=1)
        carried = rotate_z(positions, heading)
        carried[..., :2] += np.cumsum(speed * step[:, None] * direction, axis=0)[:, None]
        return carried


def blend_with_standing(
    angles: Angles, pelvis: np.ndarray, body: Body, gait: GaitParameters, ramp: np.ndarray
) -> tuple[Angles, np.ndarray]:
    """Return angles and pelvis path of someone who stands first, and walks where `ramp` is 1.

    In quiet standing knees are all but straight, and arms hang.
    """
    thigh, knee = np.radians(3.0), np.radians(6.0)
    down = body.thigh * np.cos(thigh) + body.shank * np.cos(thigh - knee)
    ahead = body.thigh * np.sin(thigh) + body.shank * np.sin(thigh - knee)
    splay = float(np.arcsin((gait.step_width / 2 - body.hip[1]) / down))
    height = down * np.cos(splay) + body.foot.height - body.hip[2]
    standing = {
        "thigh": thigh,
        "knee_flexion": knee,
        "splay": splay,
        "elbow_flexion": np.radians(18.0),
        "shoulder_abduction": np.radians(8.0),
        "shoulder_rotation": np.radians(15.0),
        "carrying_angle": np.radians(13.0),
        "foot_yaw": np.radians(-7.3),
    }
    blended = {}
    for name, curve in angles.items():
        part = name.removeprefix("left_").removeprefix("right_")
        side = -1 if name == "right_splay" else 1
        rest = standing.get(part, 0.0) * side
        blended[name] = rest + ramp * (curve - rest)
    still = np.array([-body.hip[0] - ahead, 0.0, height])
    return blended, still + ramp[:, None] * (pelvis - still)
