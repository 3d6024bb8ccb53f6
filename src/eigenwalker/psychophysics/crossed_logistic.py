"""A logistic model of single answers, with observers and walkers as crossed random factors."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any

import numpy as np
import pandas as pd
from scipy.special import expit
from scipy.stats import chi2, f as f_distribution, norm, t as t_distribution

from eigenwalker.psychophysics.answer_table import levels_of, take_columns, written
from eigenwalker.psychophysics.crossed_likelihood import (
    CrossedFit,
    CrossedLikelihood,
    Effects,
    fit_crossed,
)
from eigenwalker.psychophysics.factor_coding import (
    Coding,
    Term,
    code_factors,
    level_text,
    terms_of,
)

_CONFIDENCE = 0.95


@dataclass(frozen=True, eq=False)
class CrossedModel:
    """One fit of the model; where it did not converge, all its numbers are NaN.

    Parameters
    ----------
    formula : str
        As lme4 has it.
    converged : bool
    reason : str
        Why there are no numbers; empty where there are.
    coefficients : DataFrame
        A row a term, in treatment coding and by R's names: ``estimate`` (log odds), ``se`` and
        ``z`` as lme4 gives them; ``df`` of Satterthwaite, and ``p``, ``low`` and ``high`` by t with
        the standard error corrected for the few observers that it comes from.
    standard_deviations : Series
        Of the random effects, by name.
    tests : DataFrame
        A row a term: likelihood ratio ``chi2`` on ``df``, ``p_chi2``; the same as ``F`` on ``df``
        and ``df2``, whose ``p`` holds its level with few observers. A main effect is tested in
        columns that sum to 0, beside the interaction (type III).
    log_likelihood : float

    See Also
    --------
    crossed_logistic : makes it.
    """

    formula: str
    converged: bool
    reason: str
    coefficients: pd.DataFrame
    standard_deviations: pd.Series
    tests: pd.DataFrame
    log_likelihood: float


@dataclass(frozen=True, eq=False)
class CrossedLogistic:
    """Answers as functions of conditions, observers and walkers.

    Parameters
    ----------
    intercepts : CrossedModel
        With a random intercept for observers and one for walkers.
    by_condition : CrossedModel
        In which observers and walkers also differ in the effect of conditions that vary within
        observers. Tests are to be taken from it.
    largest : CrossedModel or None
        The largest model that converged; None if none did.
    rates : DataFrame
        Predicted rate of each combination of conditions over observers and walkers, from the
        largest model: the factors, ``rate``, ``low``, ``high``, and ``answers``.
    walkers : DataFrame
        A row a walker: ``walker``, ``answers``, ``ones``, ``effect`` (log odds), ``low``, ``high``,
        ``p`` (after Holm) and ``beyond_chance``: whether it is misjudged more, or less, often than
        chance explains.
    n_answers, n_unanswered, n_observers, n_walkers : int
        What it is of.

    See Also
    --------
    crossed_logistic : makes it.
    """

    intercepts: CrossedModel
    by_condition: CrossedModel
    largest: CrossedModel | None
    rates: pd.DataFrame
    walkers: pd.DataFrame
    n_answers: int
    n_unanswered: int
    n_observers: int
    n_walkers: int
    _columns: dict[str, str] = field(repr=False, default_factory=dict)

    @property
    def coefficients(self) -> pd.DataFrame:
        """Those of the model with two random intercepts, a row a term."""
        return self.intercepts.coefficients

    @property
    def standard_deviations(self) -> pd.Series:
        """Those of the model with two random intercepts."""
        return self.intercepts.standard_deviations

    @property
    def tests(self) -> pd.DataFrame:
        """Likelihood ratio tests of the terms, from the model `by_condition`."""
        return self.by_condition.tests

    @property
    def converged(self) -> bool:
        """Whether the model with two random intercepts converged."""
        return self.intercepts.converged

    def __repr__(self) -> str:
        return (
            f"CrossedLogistic({self.n_answers} answers of {self.n_observers} observers to "
            f"{self.n_walkers} walkers; {self.intercepts.reason or 'converged'})"
        )

    def r_script(self, table: str = "answers.csv") -> str:
        """Return the R script that fits the same models to a CSV of the same columns in lme4."""
        factors = sorted({name for term in terms_of(self._columns["fixed"]) for name in term})
        lines = ["library(lme4)", f'd <- read.csv("{table}", check.names = FALSE)']
        names = [*factors, self._columns["observer"], self._columns["walker"]]
        lines += [
            f'd[["{each}"]] <- factor(d[["{each}"]], unique(d[["{each}"]]))' for each in names
        ]
        control = 'control = glmerControl(optimizer = "bobyqa", optCtrl = list(maxfun = 1e5))'
        for model in (self.intercepts, self.by_condition):
            lines.append(f"print(summary(glmer({model.formula}, d, binomial, {control})))")
        return "\n".join(lines) + "\n"


def crossed_logistic(
    table: pd.DataFrame,
    *,
    response: str,
    fixed: str,
    observer: str,
    walker: str,
) -> CrossedLogistic:
    r"""Return a logistic model of answers, with observers and walkers as crossed random factors.

    Observers are a sample of all observers, and walkers of all walkers; what is found holds for
    others only if both are random:

    .. math:: \mathrm{logit}\, P(y = 1) = x \beta + b_{observer} + b_{walker}

    The likelihood is Laplace's approximation, as in lme4. A condition that varies within observers
    may act differently on each, and on each walker; `by_condition` has a variance for that, and the
    tests are of it.

    Parameters
    ----------
    table : DataFrame
        One row an answer.
    response : str
        Column of the answer, 0 or 1, such as whether it was wrong; empty where there was none.
    fixed : str
        Factors and interactions, such as ``"view * info"``. Numbers too are factors. The first
        level is that which comes first in the table, or first of a categorical.
    observer, walker : str
        Columns of the observer and the walker.

    Returns
    -------
    CrossedLogistic
        Its `coefficients` have ``estimate``, ``se`` and ``p`` for each term. A model that did not
        converge, or in which answers are separated (all the same at a level), has no numbers, says
        so in `reason`, and `largest` is the largest one that did.

    Raises
    ------
    ValueError
        If a column is missing, an answer is not 0 or 1, all answers are the same, a combination of
        levels has no answers, or there are fewer than three observers or walkers.

    See Also
    --------
    mixed_anova : Of rates, with walkers taken as fixed.

    References
    ----------
    Bates, Maechler, Bolker & Walker (2015), Fitting linear mixed-effects models using lme4;
    Baayen, Davidson & Bates (2008), Mixed-effects modeling with crossed random effects.

    Examples
    --------
    >>> rng = np.random.default_rng(0)
    >>> cells = pd.MultiIndex.from_product([range(8), range(10), ["full", "structure"]])
    >>> table = cells.to_frame(index=False, name=["observer", "walker", "info"])
    >>> rate = np.where(table["info"] == "full", 0.2, 0.5)
    >>> table["error"] = (rng.random(len(table)) < rate).astype(int)
    >>> model = crossed_logistic(
    ...     table, response="error", fixed="info", observer="observer", walker="walker"
    ... )
    >>> model.coefficients["estimate"].round(2).to_dict()
    {'(Intercept)': -1.56, 'infostructure': 1.4}

    """
    terms = terms_of(fixed)
    factors = list(dict.fromkeys(name for term in terms for name in term))
    columns = {"response": response, "observer": observer, "walker": walker}
    taken = take_columns(table, columns | {f"factor {f}": f for f in factors}, empty=("response",))
    taken = taken.rename(columns={f"factor {f}": f"{f}" for f in factors})
    answered = _zeros_and_ones(taken, response)
    study = _Study.of(answered, terms, observer, walker, response)
    main = [term for term in terms if len(term) == 1]
    intercepts, fit = study.fitted(terms, slopes=False)
    by_condition, fit_by = intercepts, fit
    if study.within:
        by_condition, fit_by = study.fitted(terms, slopes=True, start=fit)
    candidates = [(by_condition, fit_by, terms, True), (intercepts, fit, terms, False)]
    if not intercepts.converged:
        for fewer in (main, []):
            if fewer != terms:
                candidates.append((*study.fitted(fewer, slopes=False), fewer, False))
    converged = ((m, fit, some, by) for m, fit, some, by in candidates if fit is not None)
    largest = next(converged, None)
    return CrossedLogistic(
        intercepts,
        by_condition,
        largest[0] if largest else None,
        study.rates(*largest[1:]) if largest else pd.DataFrame(),
        study.walker_effects(*largest[1:]) if largest else pd.DataFrame(),
        n_answers=len(answered),
        n_unanswered=len(taken) - len(answered),
        n_observers=study.n_observers,
        n_walkers=study.n_walkers,
        _columns={**columns, "fixed": fixed},
    )


@dataclass(frozen=True, eq=False)
class _Study:
    """Answers counted in cells of one observer, walker and combination of conditions."""

    cells: pd.DataFrame
    terms: list[Term]
    names: dict[str, str]
    within: list[str]
    """Factors that vary within observers and within walkers."""
    n_groups: int
    n_observers: int
    n_walkers: int

    @classmethod
    def of(
        cls, answered: pd.DataFrame, terms: list[Term], observer: str, walker: str, response: str
    ) -> _Study:
        factors = list(dict.fromkeys(name for term in terms for name in term))
        keys = ["observer", "walker", *factors]
        grouped = answered.groupby(keys, observed=True, sort=False)["response"]
        cells = grouped.agg(ones="sum", answers="size").reset_index()
        varies = {
            each: [
                f for f in factors if (cells.groupby(each, observed=True)[f].nunique() > 1).any()
            ]
            for each in ("observer", "walker")
        }
        n_observers, n_walkers = cells["observer"].nunique(), cells["walker"].nunique()
        between = [f for f in factors if f not in varies["observer"]]
        n_groups = len(cells.drop_duplicates(between)) if between else 1
        for n, what in ((n_observers, "observers"), (n_walkers, "walkers")):
            if n < 3:
                raise ValueError(
                    f"There are {n} {what}; expected three or more, over which effects can vary."
                )
        if n_observers <= n_groups:
            raise ValueError(
                f"There are {n_observers} observers in {n_groups} groups; expected more observers "
                "than groups, since one in each tells nothing of how observers differ."
            )
        within = [f for f in varies["observer"] if f in varies["walker"]]
        names = {"observer": observer, "walker": walker, "response": response}
        study = cls(cells, terms, names, within, n_groups, n_observers, n_walkers)
        coding = code_factors(cells, terms)
        if np.linalg.matrix_rank(coding.X) < coding.X.shape[1]:
            shown = cells.groupby(factors, observed=True)["answers"].sum()
            full = pd.MultiIndex.from_product([levels_of(cells[f]) for f in factors])
            missing = [each for each in full if len(factors) > 1 and each not in shown.index]
            at = f": no answers at {dict(zip(factors, missing[0], strict=True))}" if missing else ""
            raise ValueError(
                f"The terms {[':'.join(term) for term in terms]} cannot be told apart{at}; leave "
                "out a term or a level."
            )
        return study

    def likelihood(self, coding: Coding, *, slopes: bool) -> tuple[CrossedLikelihood, bool]:
        """Return the likelihood, and whether observers are its first factor."""
        within = self.within if slopes else []
        slots, n_slots = [np.zeros(len(self.cells), int)], 1
        for name in within:
            levels = levels_of(self.cells[name])
            slots.append(n_slots + pd.Index(levels).get_indexer(pd.Index(self.cells[name])))
            n_slots += len(levels)
        effects = [
            Effects(pd.factorize(self.cells[each])[0], n, np.stack(slots, axis=1), n_slots)
            for each, n in (("observer", self.n_observers), ("walker", self.n_walkers))
        ]
        first = self.n_observers >= self.n_walkers
        ones, answers = (self.cells[each].to_numpy(float) for each in ("ones", "answers"))
        one, two = effects if first else effects[::-1]
        return CrossedLikelihood(coding.X, ones, answers, one, two), first

    def fitted(
        self, terms: list[Term], *, slopes: bool, start: CrossedFit | None = None
    ) -> tuple[CrossedModel, CrossedFit | None]:
        """Return a model of some terms, and its fit where it converged."""
        coding = code_factors(self.cells, terms)
        random = self._random(slopes=slopes)
        formula = f"{self.names['response']} ~ {' + '.join(':'.join(t) for t in terms) or '1'}"
        formula += "".join(f" + (1 | {name})" for name in random)
        reason, fit = self._separated(terms), None
        coefficients = pd.DataFrame(
            np.nan, index=pd.Index(coding.names, name="term"), columns=_COEFFICIENTS
        )
        sds = pd.Series(np.nan, index=random, name="standard_deviation")
        tests = pd.DataFrame([{"term": ":".join(term)} for term in terms], columns=_TESTS)
        log_likelihood = np.nan
        if not reason:
            likelihood, observers_first = self.likelihood(coding, slopes=slopes)
            try:
                if start is not None:
                    start = start._replace(theta=np.full(len(random), start.theta.mean() / 2))
                fit = fit_crossed(likelihood, start)
                small = _SmallSample.of(likelihood, fit, self.n_observers, self.n_groups)
                coefficients = self._coefficients(coding, fit, small)
                tests = self._tests(terms, coding, fit, small, slopes=slopes)
                order = (
                    fit.theta.reshape(2, -1) if observers_first else fit.theta.reshape(2, -1)[::-1]
                )
                sds = pd.Series(order.ravel(), index=random, name="standard_deviation")
                log_likelihood = -fit.deviance / 2
            except (FloatingPointError, np.linalg.LinAlgError) as error:
                reason, fit = f"It did not converge: {error}.", None
        model = CrossedModel(formula, not reason, reason, coefficients, sds, tests, log_likelihood)
        return model, fit

    def rates(self, fit: CrossedFit, terms: list[Term], slopes: bool) -> pd.DataFrame:
        """Return predicted rates over observers and walkers, with intervals."""
        factors = list(dict.fromkeys(name for term in terms for name in term))
        coding = code_factors(self.cells, terms)
        likelihood, _ = self.likelihood(coding, slopes=slopes)
        small = _SmallSample.of(likelihood, fit, self.n_observers, self.n_groups)
        keys = factors or ["response"]
        cells = self.cells if factors else self.cells.assign(response="all")
        rows = []
        sd = np.sqrt((fit.theta**2).sum())
        for level, of_level in cells.groupby(keys, observed=True, sort=False):
            x = coding.X[cells.index.get_loc(of_level.index[0])]
            se, df = small.corrected(x, within=False)
            half = t_distribution.isf((1 - _CONFIDENCE) / 2, df) * se
            eta = x @ fit.beta + np.array([0, -half, half])
            rate, low, high = (expit(eta[:, None] + sd * _NODES) @ _WEIGHTS).tolist()
            found = {"rate": rate, "low": low, "high": high, "answers": of_level["answers"].sum()}
            rows.append({**dict(zip(keys, level, strict=True)), **found})
        return pd.DataFrame(rows)

    def walker_effects(self, fit: CrossedFit, terms: list[Term], slopes: bool) -> pd.DataFrame:
        """Return how much more than the average each walker gets a 1, and whether by chance."""
        likelihood, observers_first = self.likelihood(
            code_factors(self.cells, terms), slopes=slopes
        )
        mode = likelihood.mode(fit.beta, fit.theta)
        n_slots, n_terms = likelihood.one.n_slots, likelihood.n_terms[0]
        units = np.zeros((len(mode.v1), self.n_walkers)), np.zeros((len(mode.v2), self.n_walkers))
        places = np.arange(self.n_walkers) * n_slots
        which = 1 if observers_first else 0
        units[which][places, np.arange(self.n_walkers)] = 1
        variance = mode.solve(*units)[which][places, np.arange(self.n_walkers)]
        theta = fit.theta[n_terms if observers_first else 0]
        effect = theta * (mode.v1, mode.v2)[which][places]
        sd = theta * np.sqrt(variance)
        names = pd.factorize(self.cells["walker"])[1]
        sums = self.cells.groupby("walker", observed=True, sort=False)[["answers", "ones"]].sum()
        p = 2 * norm.sf(np.abs(effect) / sd) if theta > 0 else np.ones(self.n_walkers)
        z = norm.isf((1 - _CONFIDENCE) / 2)
        found = pd.DataFrame({"walker": names}).join(sums.loc[names].reset_index(drop=True))
        found["effect"], found["low"], found["high"] = effect, effect - z * sd, effect + z * sd
        found["p"] = _holm(p)
        found["beyond_chance"] = found["p"] < 1 - _CONFIDENCE
        return found.sort_values("effect", ascending=False, ignore_index=True, kind="stable")

    def _random(self, *, slopes: bool) -> list[str]:
        within = self.within if slopes else []
        return [
            ":".join([self.names[each], *some])
            for each in ("observer", "walker")
            for some in [[], *([name] for name in within)]
        ]

    def _separated(self, terms: list[Term]) -> str:
        for term in terms or [()]:
            groups = self.cells.groupby(list(term), observed=True) if term else [("", self.cells)]
            for level, of_level in groups:
                ones, answers = of_level["ones"].sum(), of_level["answers"].sum()
                if ones in (0, answers):
                    named = zip(term, map(level_text, level), strict=True)
                    at = ", ".join(f"{name} {value}" for name, value in named)
                    return (
                        f"All {answers} answers at {at} are {int(ones > 0)}: effects are "
                        "separated, and their size is unknown."
                    )
        return ""

    def _coefficients(self, coding: Coding, fit: CrossedFit, small: _SmallSample) -> pd.DataFrame:
        se = np.sqrt(np.diag(fit.covariance)[: len(fit.beta)])
        rows = []
        for k, term in enumerate(coding.terms):
            unit = np.eye(len(fit.beta))[k]
            corrected, df = small.corrected(unit, within=bool({*term} & {*self.within}))
            corrected *= se[k] / max(small.se(unit), 1e-300)
            half = t_distribution.isf((1 - _CONFIDENCE) / 2, df) * corrected
            p = 2 * t_distribution.sf(abs(fit.beta[k]) / corrected, df)
            b = fit.beta[k]
            rows.append((b, se[k], b / se[k], df, p, b - half, b + half))
        return pd.DataFrame(rows, index=pd.Index(coding.names, name="term"), columns=_COEFFICIENTS)

    def _tests(
        self,
        terms: list[Term],
        coding: Coding,
        fit: CrossedFit,
        small: _SmallSample,
        *,
        slopes: bool,
    ) -> pd.DataFrame:
        sums = code_factors(self.cells, terms, sums=True)
        change = np.linalg.lstsq(sums.X, coding.X, rcond=None)[0]  # beta_sums = change @ beta
        rows = []
        for term in terms:
            others = [k for k, each in enumerate(sums.terms) if each != term]
            of_term = [k for k, each in enumerate(sums.terms) if each == term]
            reduced = Coding(sums.X[:, others], [], [])
            likelihood, _ = self.likelihood(reduced, slopes=slopes)
            start = fit._replace(beta=(change @ fit.beta)[others])
            without = fit_crossed(likelihood, start, curvature=False)
            ratio, df = max(without.deviance - fit.deviance, 0.0), len(of_term)
            F, df2 = small.as_f(
                ratio,
                change[of_term],
                within=bool({*term} & {*self.within}),
                levels=self._levels(term),
            )
            p = f_distribution.sf(F, df, df2) if np.isfinite(df2) else chi2.sf(ratio, df)
            rows.append((":".join(term), ratio, df, chi2.sf(ratio, df), F, df2, p))
        return pd.DataFrame(rows, columns=_TESTS)

    def _levels(self, term: Term) -> int:
        """Return contrasts of the factors of a term that vary within observers."""
        inside = [len(levels_of(self.cells[name])) - 1 for name in term if name in self.within]
        return int(np.prod(inside)) if inside else 1


_COEFFICIENTS = ["estimate", "se", "z", "df", "p", "low", "high"]
_TESTS = ["term", "chi2", "df", "p_chi2", "F", "df2", "p"]
_NODES, _WEIGHTS = np.polynomial.hermite_e.hermegauss(31)
_WEIGHTS = _WEIGHTS / _WEIGHTS.sum()


@dataclass(frozen=True, eq=False)
class _SmallSample:
    """What few observers do to tests: Satterthwaite's degrees of freedom, and the ML bias."""

    covariance: np.ndarray
    slopes: np.ndarray
    """Of the covariance by each free standard deviation, (deviation, effect, effect)."""
    of_deviations: np.ndarray
    n_observers: int
    n_groups: int

    @classmethod
    def of(
        cls, likelihood: CrossedLikelihood, fit: CrossedFit, n_observers: int, n_groups: int
    ) -> _SmallSample:
        p = len(fit.beta)
        free = np.flatnonzero(fit.theta > 0)
        slopes = []
        for k in free:
            step = np.zeros(len(fit.theta))
            step[k] = min(1e-3, fit.theta[k] / 2)
            above, below = (
                likelihood.fixed_covariance(fit.beta, fit.theta + sign * step) for sign in (1, -1)
            )
            slopes.append((above - below) / (2 * step[k]))
        return cls(
            likelihood.fixed_covariance(fit.beta, fit.theta),
            np.array(slopes).reshape(len(free), p, p),
            fit.covariance[np.ix_(p + free, p + free)],
            n_observers,
            n_groups,
        )

    @property
    def df_observers(self) -> int:
        return self.n_observers - self.n_groups

    def se(self, contrast: np.ndarray) -> float:
        return float(np.sqrt(contrast @ self.covariance @ contrast))

    def df(self, contrast: np.ndarray) -> float:
        gradient = self.slopes @ contrast @ contrast
        spread = float(gradient @ self.of_deviations @ gradient) if len(gradient) else 0.0
        variance = self.se(contrast) ** 2
        if spread <= 1e-9 * variance**2:
            return np.inf
        return max(2 * variance**2 / spread * self.df_observers / self.n_observers, 1.0)

    def corrected(
        self, contrast: np.ndarray, *, within: bool, levels: int = 1
    ) -> tuple[float, float]:
        """Return the standard error without the bias of maximum likelihood, and its df."""
        df = self.df(contrast)
        share = min(1.0, self.df_observers * (levels if within else 1) / df)
        return self.se(contrast) * np.sqrt(1 + share * self.n_groups / self.df_observers), df

    def as_f(
        self, ratio: float, contrasts: np.ndarray, *, within: bool, levels: int
    ) -> tuple[float, float]:
        """Return a likelihood ratio as F, and its second degrees of freedom."""
        _, axes = np.linalg.eigh(contrasts @ self.covariance @ contrasts.T)
        df2 = 1 / np.mean([1 / self.df(axis @ contrasts) for axis in axes.T])
        if not np.isfinite(df2):
            return ratio / len(contrasts), np.inf
        share = min(1.0, self.df_observers * (levels if within else 1) / df2)
        n = df2 * (1 + share * self.n_groups / self.df_observers)
        return float(np.expm1(ratio / n) * df2 / len(contrasts)), float(df2)


def _holm(p: np.ndarray) -> np.ndarray:
    """Return p-values after Holm's correction for their number."""
    order = np.argsort(p)
    scaled = np.maximum.accumulate(p[order] * np.arange(len(p), 0, -1))
    corrected = np.empty_like(p)
    corrected[order] = np.minimum(scaled, 1)
    return corrected


def _zeros_and_ones(taken: pd.DataFrame, name: Any) -> pd.DataFrame:
    answered = taken[taken["response"].notna()]
    values = pd.to_numeric(answered["response"], errors="coerce")
    wrong = ~values.isin([0, 1])
    if wrong.any():
        place = int(wrong.to_numpy().argmax())
        answer = answered["response"].iloc[place]
        raise ValueError(
            f"Line {answered.index[place]} of the table has {written(answer)} in the column "
            f"{name!r}; "
            "expected 0 or 1, such as whether the answer was wrong."
        )
    if values.nunique() < 2:
        same = f"are {values.iloc[0]:g}" if len(values) else "are empty"
        raise ValueError(
            f"All {len(taken)} answers in {name!r} {same}; there is nothing to explain."
        )
    return answered.assign(response=values.astype(float))
