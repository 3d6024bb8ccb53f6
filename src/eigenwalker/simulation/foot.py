"""The foot as a rocker: it rolls over the heel, lies flat, rolls over the ball, then the toes.

Seen from the side, in the plane of the foot: first coordinate forward, second up, millimetres.
Pitch is in radians, positive with the heel up.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

TOE_BEND = np.radians(28)
"""How far toes bend up before the ball leaves the ground."""


@dataclass(frozen=True)
class Foot:
    """Where heel, ball and toes are, from the ankle, on level ground."""

    heel: float
    ball: float
    toe: float
    height: float

    def ankle_over_print(self, pitch: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return where the ankle of a planted foot is, from the print of its ball.

        The sole rolls without slipping: about the heel while toes are up, about the ball while
        toes can bend, about the tip of the toes after that.

        Parameters
        ----------
        pitch : array of shape (frame,)

        Returns
        -------
        place, slope : arrays of shape (frame, 2)
            Place of the ankle, and its derivative by pitch.

        """
        waves, rolled = _waves(pitch), np.maximum(pitch - TOE_BEND, 0.0)
        heel = np.array([-self.heel - self.ball, 0.0])
        on_heel, on_heel_slope = _turned(waves, self.heel, self.height)
        on_ball, on_ball_slope = _turned(waves, -self.ball, self.height)
        tip = np.array([self.toe, 0.0])
        toes, toes_slope = _turned(_waves(rolled), self.toe, 0.0)
        lifted = (pitch > TOE_BEND)[:, None]
        place = np.where((pitch < 0)[:, None], heel + on_heel, on_ball - toes + tip)
        slope = np.where((pitch < 0)[:, None], on_heel_slope, on_ball_slope - lifted * toes_slope)
        return place, slope

    def ankle_over_ball(self, pitch: np.ndarray) -> np.ndarray:
        """Return how far the ankle is ahead of the ball: array of shape (frame,)."""
        return self.height * np.sin(pitch) - self.ball * np.cos(pitch)

    def sole_under_ankle(self, pitch: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return heel, ball and tip of the toes from the ankle, and their derivatives by pitch.

        Arrays of shape (frame, 3, 2).
        """
        waves, bend = _waves(pitch), np.clip(pitch, 0.0, TOE_BEND)
        heel, heel_slope = _turned(waves, -self.heel, -self.height)
        ball, ball_slope = _turned(waves, self.ball, -self.height)
        toes, toes_slope = _turned(_waves(pitch - bend), self.toe, 0.0)
        bending = ((pitch > 0) & (pitch < TOE_BEND))[:, None]
        return (
            np.stack([heel, ball, ball + toes], axis=1),
            np.stack([heel_slope, ball_slope, ball_slope + ~bending * toes_slope], axis=1),
        )


def _waves(pitch: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    return np.cos(pitch), np.sin(pitch)


def _turned(
    waves: tuple[np.ndarray, np.ndarray], forward: float, up: float
) -> tuple[np.ndarray, np.ndarray]:
    """Place of a point of the foot from the ankle, and its derivative by pitch."""
    cos, sin = waves
    ahead, above = forward * cos + up * sin, up * cos - forward * sin
    return np.stack([ahead, above], axis=1), np.stack([above, -ahead], axis=1)
