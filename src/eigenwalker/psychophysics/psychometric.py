"""Psychometric functions: the share of one answer as a function of the level shown."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from scipy.optimize import minimize
from scipy.special import expit
from scipy.stats import chi2

from eigenwalker.psychophysics.answer_table import take_columns, written

MAX_LAPSE = 0.1
"""Largest rate of lapses that is considered at either end."""
_STEEP = 2 * np.log(19)
"""Between 5 and 95 % of the curve lies its width."""


@dataclass(frozen=True, eq=False)
class PsychometricFits:
    """A psychometric function an observer.

    Parameters
    ----------
    table : DataFrame
        A row an observer: ``observer``, ``threshold`` (level at the middle of the curve), its
        ``threshold_low`` and ``threshold_high``; ``width`` (from 5 to 95 % of the curve),
        ``width_low``, ``width_high``; ``guess`` and ``lapse``, the rates at the lower and the upper
        end; ``deviance``, ``df`` and ``p_fit`` of the goodness of fit; ``answers``, ``levels``;
        ``extrapolated``, whether the threshold lies outside the levels shown; and ``reason``, why
        there is no curve. An end of an interval that the answers do not bound is infinite.
    counts : DataFrame
        ``observer``, ``level``, ``ones``, ``answers``.

    See Also
    --------
    psychometric : makes it.
    """

    table: pd.DataFrame
    counts: pd.DataFrame

    def curve(self, observer: object, levels: np.ndarray) -> np.ndarray:
        """Return the fitted share of ones of an observer at some levels."""
        row = self.table[self.table["observer"] == observer].iloc[0]
        F = expit(_STEEP * (np.asarray(levels) - row["threshold"]) / row["width"])
        return row["guess"] + (1 - row["guess"] - row["lapse"]) * F


def psychometric(
    table: pd.DataFrame,
    *,
    level: str,
    response: str,
    observer: str,
    guess: float | None = None,
) -> PsychometricFits:
    r"""Return a psychometric function of each observer, by maximum likelihood.

    .. math:: \psi(x) = \gamma + (1 - \gamma - \lambda)\, F(x), \qquad
        F(x) = \frac{1}{1 + e^{-2 \ln 19\,(x - m) / w}}

    with threshold m and width w. The lapses gamma and lambda at both ends are free from 0 to
    `MAX_LAPSE`, without other priors. Intervals are of 95 %, from the profile of the likelihood.

    Parameters
    ----------
    table : DataFrame
        One row an answer.
    level, response, observer : str
        Columns of the level shown, a number; of the answer, 0 or 1 (empty where there was none);
        and of the observer. Where ones become fewer with the level the width is negative.
    guess : float, optional
        Share of ones at the lower end, where it is known: 0.5 for correct answers of two
        alternatives. Left out, it is a lapse.

    Returns
    -------
    PsychometricFits
        An observer without a curve, such as one who always answers the same, stays in its table,
        with the reason.

    Raises
    ------
    ValueError
        If a column is missing, or an answer is not 0 or 1.

    See Also
    --------
    sensitivity : d' at one level.

    References
    ----------
    Wichmann & Hill (2001), The psychometric function I and II; Schütt et al. (2016), for the width.

    Examples
    --------
    >>> table = pd.DataFrame({"level": np.repeat([-2.0, -1, 0, 1, 2], 20), "observer": "Eva"})
    >>> ones = np.repeat([1, 3, 10, 17, 19], 20)
    >>> table["male"] = (np.tile(np.arange(20), 5) < ones).astype(int)
    >>> fits = psychometric(table, level="level", response="male", observer="observer")
    >>> abs(fits.table["threshold"].round(2)).tolist()
    [0.0]

    """
    if guess is not None and not 0 <= guess < 1:
        raise ValueError(f"guess is a share from 0 to below 1; got {guess}.")
    columns = {"level": level, "response": response, "observer": observer}
    taken = take_columns(table, columns, numbers=("level",), empty=("response",))
    answered = taken[taken["response"].notna()]
    ones = pd.to_numeric(answered["response"], errors="coerce")
    if (wrong := ~ones.isin([0, 1]).to_numpy()).any():
        place = int(wrong.argmax())
        raise ValueError(
            f"Line {answered.index[place]} of the table has "
            f"{written(answered['response'].iloc[place])} in the column {response!r}; expected 0 "
            "or 1."
        )
    answered = answered.assign(response=ones.astype(float))
    counts = answered.groupby(["observer", "level"], observed=True)["response"]
    counts = counts.agg(ones="sum", answers="size").reset_index()
    rows = []
    for name in taken["observer"].unique():
        own = counts[counts["observer"] == name]
        rows.append({"observer": name, **_fit_one(own, guess)})
    return PsychometricFits(pd.DataFrame(rows), counts)


def _fit_one(counts: pd.DataFrame, guess: float | None) -> dict[str, object]:
    x, ones, answers = (counts[each].to_numpy(float) for each in ("level", "ones", "answers"))
    found: dict[str, object] = dict.fromkeys(_NUMBERS, np.nan)
    found |= {"answers": int(answers.sum()), "levels": len(x), "extrapolated": False, "reason": ""}
    total = ones.sum()
    if not len(x):
        return found | {"reason": "no answers"}
    if total in (0, answers.sum()):
        return found | {"reason": f"all {answers.sum():g} answers are {int(total > 0)}: no curve"}
    if len(x) < 3:
        return found | {"reason": f"answers at {len(x)} levels; a curve needs three or more"}
    mean = (x * answers).sum() / answers.sum()
    sign = -1.0 if ((x - mean) * (ones - answers * total / answers.sum())).sum() < 0 else 1.0
    if guess is not None:
        sign = 1.0
    x = np.sort(sign * x) if sign < 0 else x
    if sign < 0:
        ones, answers = ones[::-1], answers[::-1]
    profile = _Profile(x, ones, answers, guess)
    best, deviance = profile.best()
    m, w, lower, upper = best
    m_low, m_high, w_low, w_high = profile.intervals(best)
    n_free = 2 + (0 < upper < MAX_LAPSE) + (guess is None and 0 < lower < MAX_LAPSE)
    df = len(x) - n_free
    if sign < 0:
        m_low, m_high, w_low, w_high = -m_high, -m_low, -w_high, -w_low
    return found | {
        "threshold": sign * m,
        "threshold_low": m_low,
        "threshold_high": m_high,
        "width": sign * w,
        "width_low": w_low,
        "width_high": w_high,
        "guess": upper if sign < 0 else lower,
        "lapse": lower if sign < 0 else upper,
        "deviance": deviance,
        "df": df,
        "p_fit": chi2.sf(deviance, df) if df > 0 else np.nan,
        "extrapolated": bool(m < x.min() or m > x.max()),
    }


_NUMBERS = (
    *("threshold", "threshold_low", "threshold_high", "width", "width_low", "width_high"),
    *("guess", "lapse", "deviance", "df", "p_fit"),
)


class _Profile:
    """The deviance of one observer's answers over thresholds, widths and lapses."""

    def __init__(
        self, x: np.ndarray, ones: np.ndarray, answers: np.ndarray, guess: float | None
    ) -> None:
        self.x, self.ones, self.answers, self.guess = x, ones, answers, guess
        share = np.clip(ones / answers, 1e-12, 1 - 1e-12)
        self.full = float((ones * np.log(share) + (answers - ones) * np.log1p(-share)).sum())
        self.lapses = np.linspace(0, MAX_LAPSE, 6)
        self.lowers = self.lapses if guess is None else np.array([guess])

    def deviance(self, m: float, w: float, lower: float, upper: float) -> float:
        F = expit(_STEEP * (self.x - m) / w)
        p = np.clip(lower + (1 - lower - upper) * F, 1e-12, 1 - 1e-12)
        value = (self.ones * np.log(p) + (self.answers - self.ones) * np.log1p(-p)).sum()
        return float(2 * (self.full - value))

    def grid(self, thresholds: np.ndarray, widths: np.ndarray) -> np.ndarray:
        """Return deviances of shape (threshold, width, lower, upper)."""
        F = expit(_STEEP * (self.x - thresholds[:, None, None]) / widths[:, None])
        values = np.empty((len(thresholds), len(widths), len(self.lowers), len(self.lapses)))
        for i, lower in enumerate(self.lowers):
            for j, upper in enumerate(self.lapses):
                p = np.clip(lower + (1 - lower - upper) * F, 1e-9, 1 - 1e-9)
                values[:, :, i, j] = np.log(p) @ self.ones
                values[:, :, i, j] += np.log1p(-p) @ (self.answers - self.ones)
        return 2 * (self.full - values)

    def best(self) -> tuple[tuple[float, float, float, float], float]:
        """Return the most likely threshold, width and lapses, and the deviance."""
        span = np.ptp(self.x)
        step = np.diff(self.x).min()
        self.thresholds = np.linspace(self.x.min() - 2 * span, self.x.max() + 2 * span, 81)
        self.widths = np.geomspace(step / 2, 20 * span, 32)
        values = self.grid(self.thresholds, self.widths)
        near = values < values.min() + 9
        some_m, some_w = near.any(axis=(1, 2, 3)), near.any(axis=(0, 2, 3))
        place = np.unravel_index(values.argmin(), values.shape)
        start = (self.thresholds[place[0]], np.log(self.widths[place[1]]))
        start += (self.lowers[place[2]], self.lapses[place[3]])
        self.thresholds = _finer(self.thresholds, some_m, 61)
        self.widths = np.exp(_finer(np.log(self.widths), some_w, 41))
        self.values = self.grid(self.thresholds, self.widths)
        lower = (0, MAX_LAPSE) if self.guess is None else (self.guess, self.guess)
        scale = np.array([span, 1.0, MAX_LAPSE, MAX_LAPSE])
        bounds = [
            (start[0] / span - 1, start[0] / span + 1),
            (np.log(step / 4), np.log(40 * span)),
            (lower[0] / MAX_LAPSE, lower[1] / MAX_LAPSE),
            (0, 1),
        ]
        found = minimize(
            lambda z: self.deviance(z[0] * span, np.exp(z[1]), z[2] * MAX_LAPSE, z[3] * MAX_LAPSE),
            np.array(start) / scale,
            bounds=bounds,
            method="L-BFGS-B",
        )
        m, w, low, high = (found.x * scale).tolist()
        return (m, float(np.exp(w)), low, high), float(found.fun)

    def intervals(self, best: tuple[float, ...]) -> tuple[float, float, float, float]:
        """Return where the profiles of threshold and width rise by what 95 % allow."""
        least = min(self.deviance(*best), self.values.min())
        ends = []
        log_widths = np.log(self.widths)
        for axes, places, middle in (
            ((1, 2, 3), self.thresholds, best[0]),
            ((0, 2, 3), log_widths, float(np.log(best[1]))),
        ):
            profile = self.values.min(axis=axes) - least - chi2.isf(0.05, 1)
            ends += [_crossing(places, profile, middle, side) for side in (-1, 1)]
        return ends[0], ends[1], float(np.exp(ends[2])), float(np.exp(ends[3]))


def _finer(places: np.ndarray, near: np.ndarray, n: int) -> np.ndarray:
    which = np.flatnonzero(near)
    first, last = max(which[0] - 1, 0), min(which[-1] + 1, len(places) - 1)
    return np.linspace(places[first], places[last], n)


def _crossing(places: np.ndarray, profile: np.ndarray, middle: float, side: int) -> float:
    """Return where a profile rises above 0 on one side; infinite where it does not."""
    beyond = np.flatnonzero((profile > 0) & (side * (places - middle) > 0))
    if not len(beyond):
        return side * np.inf
    outer = beyond[0] if side > 0 else beyond[-1]
    inner = outer - side
    if not 0 <= inner < len(places) or profile[inner] > 0:
        return float(places[outer])
    share = -profile[inner] / (profile[outer] - profile[inner])
    return float(places[inner] + share * (places[outer] - places[inner]))
