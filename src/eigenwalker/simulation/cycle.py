"""One stride, solved: the joint angles nearest to a person's draw whose feet hold the ground.

A person asks for a step length, a step width and a range of vertical and lateral movement, and
has joint angles drawn about published norms. Both cannot be had at once. The cycle that walks is
the most probable one: Gauss-Newton finds the least change of the drawn angles, in units of what
people differ by, for which the planted feet stay where they are, the swinging ones clear the
ground, and the pelvis moves as asked.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from eigenwalker.core.blas_threads import one_blas_thread
from eigenwalker.simulation.cadence import pace_of
from eigenwalker.simulation.ground import Ground
from eigenwalker.simulation.segment_lengths import body_of

_MOST_STEPS = 30
_ENOUGH = 1.0


@dataclass(frozen=True)
class Cycle:
    """Fourier coefficients of one stride: angles in radians, the pelvis' path in millimetres.

    `legs` has shape (side, joint, coefficient) for thigh, knee and pitch of the foot over the
    side's own phase, which is 0 at its heel strike (at phase `onsets` of the left side); `pelvis`
    has shape (axis, coefficient) over the left side's phase. `legs_longer` and `pelvis_longer`
    are what is added for each unit by which a step is longer than the person's own.
    """

    legs: np.ndarray
    pelvis: np.ndarray
    legs_longer: np.ndarray
    pelvis_longer: np.ndarray
    onsets: np.ndarray


def solve_cycle(person: Mapping[str, float]) -> Cycle:
    """Return the stride that a person walks.

    Parameters
    ----------
    person : mapping
        Parameters of `traits.PARAMETERS`.

    Returns
    -------
    Cycle

    """
    body = body_of(person)
    pace = pace_of(person, body)
    own = Ground(person, body, pace)
    doubled = own.with_stride(2 * pace.stride)
    with one_blas_thread():
        best = _least_change(own, own.prior)
        slope = _change_with_stride(own, doubled, best)
    legs, _, pelvis = own.split(best)
    legs_slope, _, pelvis_slope = own.split(slope)
    sway = np.array([np.zeros_like(own.sway), own.sway, np.zeros_like(own.sway)])
    return Cycle(legs, pelvis + sway, legs_slope, pelvis_slope, own.onsets)


def _least_change(problem: Ground, unknown: np.ndarray) -> np.ndarray:
    """Return the most probable cycle: Gauss-Newton, its steps shortened where they overshoot."""

    def cost(residual: np.ndarray, unknown: np.ndarray) -> float:
        return float(residual @ residual + problem.precision @ (unknown - problem.prior) ** 2)

    residual, slopes = problem.linearised(unknown)
    now = cost(residual, unknown)
    for _ in range(_MOST_STEPS):
        pull = problem.precision * (problem.prior - unknown) - slopes.T @ residual
        step = np.linalg.solve(slopes.T @ slopes + np.diag(problem.precision), pull)
        for _ in range(6):
            residual, slopes = problem.linearised(unknown + step)
            then = cost(residual, unknown + step)
            if then < now:
                break
            step = 0.4 * step
        else:
            return unknown
        unknown, gain, now = unknown + step, now - then, then
        if gain < _ENOUGH:
            break
    return unknown


def _change_with_stride(own: Ground, doubled: Ground, best: np.ndarray) -> np.ndarray:
    """Return how the solution moves for each unit by which the stride is longer.

    Residuals are linear in the stride, so one solution of the linearised problem tells.
    """
    residual, slopes = own.linearised(best)
    missed, _ = doubled.linearised(best)
    normal = slopes.T @ slopes + np.diag(own.precision)
    return np.linalg.solve(normal, slopes.T @ (residual - missed))
