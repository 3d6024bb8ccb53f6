"""The likelihood of answers of 0 or 1 with two crossed random factors, by Laplace's approximation.

With effects b = Z Lambda v, v standard normal, and the mode v of the penalised likelihood h,

    -2 log L = 2 h(v) + log det H,    H = Lambda' Z' W Z Lambda + 1,

as lme4 has it. H is block diagonal in the units of the first factor but for its border, so that
only a matrix of the effects of the second factor is factorised.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.optimize import minimize
from scipy.special import expit

_MAX_STEPS = 60
_LARGEST = 5.0
"""Log odds: standard deviations of random effects that are looked at."""
_FAR = 12.0
"""Log odds of a fixed effect beyond which answers are separated."""


class Effects(NamedTuple):
    """Random effects of the units of one factor: each has an intercept, and one a level of more.

    `unit` says which unit each cell is of; `slots` (cell, term) which of its `n_slots` effects act
    on the cell; each term has a standard deviation of its own.
    """

    unit: np.ndarray
    n_units: int
    slots: np.ndarray
    n_slots: int

    @property
    def places(self) -> np.ndarray:
        """Places of the effects in a vector of all, (cell, term)."""
        return self.unit[:, None] * self.n_slots + self.slots


class Mode(NamedTuple):
    """The most likely random effects, and what H is made of there."""

    v1: np.ndarray
    v2: np.ndarray
    penalised: float
    mu: np.ndarray
    inverse_blocks: np.ndarray
    border: np.ndarray
    core: tuple[np.ndarray, bool]
    log_det: float

    def solve(self, r1: np.ndarray, r2: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return H^-1 r, of vectors or of columns."""
        x2 = cho_solve(self.core, r2 - self.border.T @ r1)
        n_units, n_slots, _ = self.inverse_blocks.shape
        first = self.inverse_blocks @ r1.reshape(n_units, n_slots, -1)
        return first.reshape(r1.shape) - self.border @ x2, x2


class CrossedLikelihood:
    """-2 log likelihood of counts in cells, as a function of fixed effects and deviations."""

    def __init__(
        self, X: np.ndarray, ones: np.ndarray, answers: np.ndarray, one: Effects, two: Effects
    ) -> None:
        self.X, self.ones, self.answers, self.one, self.two = X, ones, answers, one, two
        self.n_terms = one.slots.shape[1], two.slots.shape[1]
        self._q = one.n_units * one.n_slots, two.n_units * two.n_slots
        self._p1, self._p2 = one.places, two.places
        self._v = np.zeros(self._q[0]), np.zeros(self._q[1])
        m1, q2 = one.n_slots, self._q[1]
        self._blocks = {
            (k, m): self._p1[:, k] * m1 + one.slots[:, m]
            for k in range(self.n_terms[0])
            for m in range(self.n_terms[0])
        }
        self._cross = {
            (k, m): self._p1[:, k] * q2 + self._p2[:, m]
            for k in range(self.n_terms[0])
            for m in range(self.n_terms[1])
        }
        self._second = {
            (k, m): self._p2[:, k] * q2 + self._p2[:, m]
            for k in range(self.n_terms[1])
            for m in range(self.n_terms[1])
        }

    def mode(self, beta: np.ndarray, theta: np.ndarray, *, again: bool = True) -> Mode:
        """Return the most likely random effects, by Newton's method from the last ones."""
        fixed, (v1, v2) = self.X @ beta, self._v
        value, mu = self._penalised(fixed, theta, v1, v2)
        for _ in range(_MAX_STEPS):
            blocks = self._factorised(mu, theta)
            r1, r2 = self._transposed(self.ones - self.answers * mu, theta)
            g1, g2 = r1 - v1, r2 - v2
            found = Mode(v1, v2, value, mu, *blocks)
            d1, d2 = found.solve(g1, g2)
            decrement = float(g1 @ d1 + g2 @ d2)
            if decrement < 1e-12 * (1 + abs(value)):
                self._v = v1 + d1, v2 + d2  # a start, not the result
                return found
            length = 1.0
            tried, mu = self._penalised(fixed, theta, v1 + d1, v2 + d2)
            while not tried <= value + 1e-9 * abs(value) and length > 1e-4:
                length /= 2
                tried, mu = self._penalised(fixed, theta, v1 + length * d1, v2 + length * d2)
            v1, v2, value = v1 + length * d1, v2 + length * d2, tried
        if again:
            self._v = np.zeros(self._q[0]), np.zeros(self._q[1])
            return self.mode(beta, theta, again=False)
        raise FloatingPointError("the random effects found no mode")

    def deviance(self, beta: np.ndarray, theta: np.ndarray) -> tuple[float, np.ndarray]:
        """Return -2 log likelihood and its gradient by fixed effects and standard deviations."""
        mode = self.mode(beta, theta)
        weight = self.answers * mode.mu * (1 - mode.mu)
        slope = weight * (1 - 2 * mode.mu)
        t1, t2 = theta[: self.n_terms[0]], theta[self.n_terms[0] :]
        inverse = cho_solve(mode.core, np.eye(self._q[1]))
        across = mode.border @ inverse  # - H^-1 between the factors
        shape = self.one.n_units, self.one.n_slots, -1
        within = mode.inverse_blocks + np.einsum(
            "gkq,glq->gkl", across.reshape(shape), mode.border.reshape(shape)
        )
        parts = np.zeros((sum(self.n_terms), len(weight)))  # z_k' (H^-1 a) of each cell and term
        flat_within, flat_across, flat_inverse = within.ravel(), across.ravel(), inverse.ravel()
        for (k, m), places in self._blocks.items():
            parts[k] += t1[m] * flat_within[places]
        for (k, m), places in self._cross.items():
            crossed = flat_across[places]
            parts[k] -= t2[m] * crossed
            parts[self.n_terms[0] + m] -= t1[k] * crossed
        for (k, m), places in self._second.items():
            parts[self.n_terms[0] + k] += t2[m] * flat_inverse[places]
        leverage = theta @ parts
        g = slope * leverage
        s1, s2 = mode.solve(*self._transposed(g, theta))
        residual = self.ones - self.answers * mode.mu
        through = g - weight * self._times(theta, s1, s2)  # d log det / d eta, v following
        gradient = np.empty(len(beta) + len(theta))
        gradient[: len(beta)] = self.X.T @ (through - 2 * residual)
        for k in range(len(theta)):
            first = k < self.n_terms[0]
            places = self._p1[:, k] if first else self._p2[:, k - self.n_terms[0]]
            effect = (mode.v1 if first else mode.v2)[places]
            mover = (s1 if first else s2)[places]
            direct = (through - 2 * residual) @ effect + mover @ residual
            gradient[len(beta) + k] = direct + 2 * weight @ parts[k]
        return 2 * mode.penalised + mode.log_det, gradient

    def fixed_covariance(self, beta: np.ndarray, theta: np.ndarray) -> np.ndarray:
        """Return the covariance of the fixed effects, given the standard deviations."""
        mode = self.mode(beta, theta)
        weight = self.answers * mode.mu * (1 - mode.mu)
        columns = [self._transposed(weight * x, theta) for x in self.X.T]
        r1, r2 = (np.stack(part, axis=1) for part in zip(*columns, strict=True))
        x1, x2 = mode.solve(r1, r2)
        information = self.X.T @ (weight[:, None] * self.X) - r1.T @ x1 - r2.T @ x2
        return np.linalg.inv(information)

    def _penalised(
        self, fixed: np.ndarray, theta: np.ndarray, v1: np.ndarray, v2: np.ndarray
    ) -> tuple[float, np.ndarray]:
        eta = fixed + self._times(theta, v1, v2)
        loss = self.answers @ np.logaddexp(0, eta) - self.ones @ eta
        return float(loss + (v1 @ v1 + v2 @ v2) / 2), expit(eta)

    def _times(self, theta: np.ndarray, v1: np.ndarray, v2: np.ndarray) -> np.ndarray:
        n1 = self.n_terms[0]
        eta = v1[self._p1[:, 0]] * theta[0] + v2[self._p2[:, 0]] * theta[n1]
        for k in range(1, n1):
            eta += v1[self._p1[:, k]] * theta[k]
        for k in range(1, self.n_terms[1]):
            eta += v2[self._p2[:, k]] * theta[n1 + k]
        return eta

    def _transposed(self, values: np.ndarray, theta: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        sums = []
        for places, q, sds in (
            (self._p1, self._q[0], theta[: self.n_terms[0]]),
            (self._p2, self._q[1], theta[self.n_terms[0] :]),
        ):
            terms = zip(places.T, sds, strict=True)
            sums.append(sum(sd * np.bincount(place, values, q) for place, sd in terms))
        return sums[0], sums[1]

    def _factorised(
        self, mu: np.ndarray, theta: np.ndarray
    ) -> tuple[np.ndarray, np.ndarray, tuple[np.ndarray, bool], float]:
        weight = self.answers * mu * (1 - mu)
        (q1, q2), m1 = self._q, self.one.n_slots
        t1, t2 = theta[: self.n_terms[0]], theta[self.n_terms[0] :]
        blocks, cross, second = np.zeros(q1 * m1), np.zeros(q1 * q2), np.zeros(q2 * q2)
        for (k, m), places in self._blocks.items():
            blocks += np.bincount(places, t1[k] * t1[m] * weight, q1 * m1)
        for (k, m), places in self._cross.items():
            cross += np.bincount(places, t1[k] * t2[m] * weight, q1 * q2)
        for (k, m), places in self._second.items():
            second += np.bincount(places, t2[k] * t2[m] * weight, q2 * q2)
        blocks = blocks.reshape(-1, m1, m1) + np.eye(m1)
        cross = cross.reshape(-1, m1, q2)
        inverse = np.linalg.inv(blocks)
        border = (inverse @ cross).reshape(q1, q2)
        core = second.reshape(q2, q2) + np.eye(q2) - cross.reshape(q1, q2).T @ border
        factor = cho_factor(core, lower=True)
        log_det = np.linalg.slogdet(blocks)[1].sum() + 2 * np.log(np.diag(factor[0])).sum()
        return inverse, border, (factor[0], True), float(log_det)


class CrossedFit(NamedTuple):
    """The most likely fixed effects and standard deviations, with the curvature there."""

    beta: np.ndarray
    theta: np.ndarray
    covariance: np.ndarray
    """Of fixed effects and standard deviations; NaN for deviations of 0."""
    deviance: float


def fit_crossed(
    likelihood: CrossedLikelihood, start: CrossedFit | None = None, *, curvature: bool = True
) -> CrossedFit:
    """Return the most likely effects; raise FloatingPointError where there are none."""
    p, n_terms = likelihood.X.shape[1], sum(likelihood.n_terms)
    theta = np.full(n_terms, 0.4) if start is None else np.maximum(start.theta, 0.1)
    beta = np.zeros(p) if start is None else start.beta
    beta = _fixed_given(likelihood, beta, theta)
    root = np.linalg.cholesky(likelihood.fixed_covariance(beta, theta))

    def scaled(z: np.ndarray) -> tuple[float, np.ndarray]:
        value, gradient = likelihood.deviance(beta + root @ z[:p], z[p:] / 4)
        return value, np.concatenate([root.T @ gradient[:p], gradient[p:] / 4])

    bounds = [(-30.0, 30.0)] * p + [(0.0, 4 * _LARGEST)] * n_terms
    z = np.concatenate([np.zeros(p), 4 * theta])
    options = {"gtol": 1e-4, "ftol": 1e-13, "maxiter": 200}
    for _ in range(3):
        found = minimize(scaled, z, jac=True, method="L-BFGS-B", bounds=bounds, options=options)
        z = found.x
        at_zero = np.flatnonzero(z[p:] < 0.02) + p
        lifted = z.copy()
        lifted[at_zero] = 0.4
        if not len(at_zero) or scaled(lifted)[0] > found.fun:
            break
        z = lifted
    z[at_zero] = 0.0
    beta, theta = beta + root @ z[:p], z[p:] / 4
    value, gradient = likelihood.deviance(beta, theta)
    free = np.concatenate([np.ones(p, bool), theta > 0])
    off = np.concatenate([root.T @ gradient[:p], gradient[p:] / 4])[free]
    if np.abs(off).max() > 0.02 or np.abs(likelihood.X @ beta).max() > _FAR:
        raise FloatingPointError("the search found no most likely effects")
    covariance = np.full((len(free), len(free)), np.nan)
    if curvature:
        covariance[np.ix_(free, free)] = _covariance(likelihood, beta, theta, free)
    return CrossedFit(beta, theta, covariance, value)


def _fixed_given(likelihood: CrossedLikelihood, beta: np.ndarray, theta: np.ndarray) -> np.ndarray:
    """Return the fixed effects of the joint mode, by Newton's method on them and the effects."""
    for _ in range(8):
        mode = likelihood.mode(beta, theta)
        gradient = likelihood.X.T @ (likelihood.ones - likelihood.answers * mode.mu)
        step = likelihood.fixed_covariance(beta, theta) @ gradient
        beta = beta + step * min(1.0, 3 / max(np.abs(step).max(), 1e-12))
        if np.abs(step).max() < 1e-3:
            break
    return beta


def _covariance(
    likelihood: CrossedLikelihood, beta: np.ndarray, theta: np.ndarray, free: np.ndarray
) -> np.ndarray:
    """Return the inverse of half the curvature of the deviance, by differences of gradients."""
    p, x = len(beta), np.concatenate([beta, theta])
    rows = []
    for place in np.flatnonzero(free):
        step = 1e-3 if place < p else min(1e-3, x[place] / 2)
        gradients = []
        for sign in (1, -1):
            moved = x.copy()
            moved[place] += sign * step
            gradients.append(likelihood.deviance(moved[:p], moved[p:])[1][free])
        rows.append((gradients[0] - gradients[1]) / (2 * step))
    curvature = np.array(rows) / 2
    curvature = (curvature + curvature.T) / 2
    if np.linalg.eigvalsh(curvature).min() <= 0:
        raise FloatingPointError("the likelihood has no curvature at its maximum")
    return np.linalg.inv(curvature)
