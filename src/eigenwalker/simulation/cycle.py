"""One stride, solved: the joint angles nearest to the drawn ones whose feet hold the ground.

A person is drawn with a step length, a step width and ranges of vertical and lateral movement, and
with joint angles about published norms. These contradict each other. The solved cycle is the most
probable one: Gauss-Newton finds the least change of the drawn angles, in units of what people
differ by, for which planted feet stay where they are, swinging ones clear the ground, and the
pelvis moves as drawn.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from eigenwalker.core.blas_threads import one_blas_thread
from eigenwalker.simulation.body import body_of
from eigenwalker.simulation.ground import Ground
from eigenwalker.simulation.prior_curves import gait_parameters

_MAX_ITERATIONS = 30
_LEAST_GAIN = 1.0


@dataclass(frozen=True)
class Cycle:
    """Fourier coefficients of one stride: angles in radians, the pelvis' path in millimetres.

    `legs` (side, joint, coefficient) are thigh, knee, foot pitch from the side's own heel strike,
    at phase `onsets`; `pelvis` (axis, coefficient) is from the left one. Slopes are the change for
    each unit by which a step is longer.
    """

    legs: np.ndarray
    pelvis: np.ndarray
    legs_slope: np.ndarray
    pelvis_slope: np.ndarray
    onsets: np.ndarray


def solve_cycle(person: Mapping[str, float]) -> Cycle:
    """Return the stride that a person with these parameters (see `PARAMETERS`) walks."""
    body = body_of(person)
    gait = gait_parameters(person, body)
    own = Ground(person, body, gait)
    doubled = own.with_stride_length(2 * gait.stride_length)
    with one_blas_thread():
        best = _most_probable(own)
        slope = _change_with_stride(own, doubled, best)
    legs, _, pelvis = own.split(best)
    legs_slope, _, pelvis_slope = own.split(slope)
    pelvis[1] += own.sway
    return Cycle(legs, pelvis, legs_slope, pelvis_slope, own.onsets)


def _most_probable(problem: Ground) -> np.ndarray:
    """Return the solution by Gauss-Newton, its steps shortened where they overshoot."""

    def cost(residual: np.ndarray, unknown: np.ndarray) -> float:
        return float(residual @ residual + problem.precision @ (unknown - problem.prior) ** 2)

    unknown = problem.prior
    residual, jacobian = problem.linearised(unknown)
    current = cost(residual, unknown)
    for _ in range(_MAX_ITERATIONS):
        gradient = problem.precision * (problem.prior - unknown) - jacobian.T @ residual
        step = np.linalg.solve(jacobian.T @ jacobian + np.diag(problem.precision), gradient)
        for _ in range(6):
            residual, jacobian = problem.linearised(unknown + step)
            new = cost(residual, unknown + step)
            if new < current:
                break
            step = 0.4 * step
        else:
            return unknown
        unknown, gain, current = unknown + step, current - new, new
        if gain < _LEAST_GAIN:
            break
    return unknown


def _change_with_stride(own: Ground, doubled: Ground, best: np.ndarray) -> np.ndarray:
    """Return how the solution moves with the stride length, in which residuals are linear."""
    residual, jacobian = own.linearised(best)
    residual_doubled, _ = doubled.linearised(best)
    normal = jacobian.T @ jacobian + np.diag(own.precision)
    return np.linalg.solve(normal, jacobian.T @ (residual - residual_doubled))
