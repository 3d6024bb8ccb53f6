"""Sensitivity and criterion: how well classes are told apart, and which answer is preferred."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
import pandas as pd
from scipy.stats import norm

from eigenwalker.psychophysics.error_rates import judged


def sensitivity(
    table: pd.DataFrame,
    *,
    response: str,
    truth: str,
    observer: str,
    by: str | Sequence[str] = (),
    signal: object = None,
    correction: Literal["log-linear", "none"] = "log-linear",
) -> pd.DataFrame:
    r"""Return d' and criterion of each observer, in each condition.

    With the rates of hits H and of false alarms F, and z the quantile of the normal distribution,

    .. math:: d' = z(H) - z(F), \qquad c = -\frac{z(H) + z(F)}{2}

    The log-linear correction adds 0.5 to each count of answers "signal" and 1 to each number of
    trials, so that rates of 0 and 1 give finite numbers.

    Parameters
    ----------
    table : DataFrame
        One row a trial. Those without an answer (empty cells) do not count.
    response, truth : str
        Columns of the class answered and of the walker's own; two classes.
    observer : str
        Column of the observer.
    by : str or sequence of str
        Columns of conditions.
    signal : object, optional
        The class whose recognition is a hit; left out, the second in sorted order, such as "male".
    correction : {"log-linear", "none"}
        Without it rates of 0 and 1 give infinite numbers.

    Returns
    -------
    DataFrame
        A row for each observer and condition: ``observer``, the columns of `by`, ``signal_trials``,
        ``noise_trials``, ``hits``, ``false_alarms``, ``hit_rate``, ``false_alarm_rate`` (as
        counted), ``d_prime`` and ``criterion``; NaN where a class was not shown. ``attrs`` hold
        ``signal`` and ``correction``.

    Raises
    ------
    ValueError
        If a column is missing, there are not two classes, or an answer is none of them.

    See Also
    --------
    error_rates : Errors of both kinds together.

    References
    ----------
    Hautus (1995), Corrections for extreme proportions; Macmillan & Creelman (2005).

    Examples
    --------
    >>> table = pd.DataFrame({"sex": ["male"] * 10 + ["female"] * 10, "observer": "Eva"})
    >>> table["answer"] = ["male"] * 8 + ["female"] * 2 + ["female"] * 8 + ["male"] * 2
    >>> found = sensitivity(table, response="answer", truth="sex", observer="observer")
    >>> found[["hits", "false_alarms", "d_prime"]].round(2).values.tolist()
    [[8.0, 2.0, 1.5]]

    """
    if correction not in ("log-linear", "none"):
        raise ValueError(f"correction is 'log-linear' or 'none'; got {correction!r}.")
    by = [by] if isinstance(by, str) else [*by]
    columns = {"response": response, "truth": truth, "observer": observer}
    taken = judged(table, **columns, **{f"by_{i}": name for i, name in enumerate(by)})
    classes = sorted(taken["truth"].unique(), key=str)
    if len(classes) != 2:
        raise ValueError(f"Expected two classes in {truth!r}; got {len(classes)}: {classes[:6]}.")
    signal = classes[1] if signal is None else signal
    if signal not in classes:
        raise ValueError(f"signal={signal!r} is none of the classes {classes} of {truth!r}.")
    taken = taken[taken["response"].notna()]
    is_signal = (taken["truth"] == signal).to_numpy()
    called = (taken["response"] == signal).to_numpy()
    counted = taken.assign(
        signal_trials=is_signal,
        noise_trials=~is_signal,
        hits=is_signal & called,
        false_alarms=~is_signal & called,
    )
    keys = ["observer", *(f"by_{i}" for i in range(len(by)))]
    names = ["signal_trials", "noise_trials", "hits", "false_alarms"]
    counts = counted.groupby(keys, observed=True, sort=False)[names].sum()
    shown, answered = counts[names[:2]].to_numpy(float), counts[names[2:]].to_numpy(float)
    shown[shown == 0] = np.nan
    add = 0.5 if correction == "log-linear" else 0.0
    z = norm.ppf((answered + add) / (shown + 2 * add))
    found = counts.reset_index().set_axis(["observer", *by, *names], axis=1)
    found["hit_rate"], found["false_alarm_rate"] = (answered / shown).T
    found["d_prime"], found["criterion"] = z[:, 0] - z[:, 1], -z.mean(axis=1)
    found.attrs = {"signal": signal, "correction": correction, "answers": len(taken)}
    return found
