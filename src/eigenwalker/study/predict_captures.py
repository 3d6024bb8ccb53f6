"""A trait of new captures, predicted by a population."""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from eigenwalker.analysis.contrast import usual_trait
from eigenwalker.analysis.trait_model import TraitModel, trait_model
from eigenwalker.core.progress import Progress, ticked
from eigenwalker.core.walker import Walker
from eigenwalker.population.persons import persons_of
from eigenwalker.population.population import Population
from eigenwalker.study.capture_table import FILE, captures_in, traits_of_names
from eigenwalker.study.fit_folder import outcomes_in_processes, status_of
from eigenwalker.study.messages import error_to_expect
from eigenwalker.study.process_capture import CaptureResult

SAME = 1e-6
"""Distance in standard deviations below which a walk is one of those learnt from."""
ITSELF = "this capture"
"""Who is known of a capture that is itself among the walkers learnt from."""
MOST_WAITED_FOR = 150
"""Walkers of whom a page learns while somebody waits."""


@dataclass(frozen=True, eq=False)
class Predictions:
    """A trait of new captures.

    Parameters
    ----------
    model : TraitModel
        What predicted it.
    table : DataFrame
        One row a capture: ``file``, in its folder, or as it was named if there are several folders;
        ``status`` ("used", "flagged" or "refused"); ``prediction`` and
        the other columns of `TraitModel.predict`; ``error``, that of the model on walkers left out:
        a share, or of a number the RMSE in its unit; ``person_known``, a person of the walkers
        learnt from who walks here too, if that can be seen from the name, or "this capture" if it
        is itself one of them; ``reason``, why it is flagged or refused.

    See Also
    --------
    predict_captures : Makes it.
    """

    model: TraitModel
    table: pd.DataFrame

    def _repr_html_(self) -> str:
        """The table, for notebooks."""
        return self.table.to_html(index=False, escape=True, float_format="{:.3g}".format, na_rep="")


def predict_captures(
    population: Population,
    trait: str,
    files: Sequence[str | Path] | str | Path,
    *,
    trait_from_name: str | None = None,
    n_jobs: int = -1,
    progress: Progress | None = None,
    **reading: Any,
) -> Predictions:
    """Return the class or value of a trait for captures that were not learnt from.

    Parameters
    ----------
    population : Population
        To learn from.
    trait : str
        As `trait_model` takes it.
    files : path, or sequence of paths
        Captures, or folders of captures.
    trait_from_name : str, optional
        A regular expression whose named group ``person`` says who walks.
    n_jobs : int
        Processes to read with; -1 uses all cores.
    progress : callable, optional
        Called with the number of captures done and of all.
    **reading
        As `process_capture` takes them, such as ``unit`` and ``rate_hz``.

    Returns
    -------
    Predictions

    Raises
    ------
    ValueError
        If the trait cannot be predicted, or there are no files; never because of a single capture.

    See Also
    --------
    trait_model : What predicts.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> people = ew.load_population()
    >>> with TemporaryDirectory() as folder:
    ...     path = ew.write_mocap(ew.simulate_walk(sex="male", seed=3), f"{folder}/new.c3d")
    ...     new = ew.study.predict_captures(people, "sex", path, n_jobs=1)
    >>> new.table["status"].tolist(), 0 < new.model.error < 0.5
    (['used'], True)
    """
    named = _paths(files)
    paths = list(named)
    model = trait_model(population, trait)
    first = population.walkers[0]
    form = {"form": first.form, "n_harmonics": len(first.harmonics) // 2}
    folder = Path(os.path.commonpath([path.parent for path in paths]))
    names = [str(path.relative_to(folder)) for path in paths]
    inside = pd.Series([Path(name).as_posix() for name in names])
    persons_known = _persons_known(model, inside, trait_from_name)
    outcomes = outcomes_in_processes(
        folder, names, form | reading, n_jobs, partial(_placed, population)
    )
    vectors, rows = zip(*ticked(outcomes, len(names), progress), strict=True)
    one_folder = len({name.parent for name in named.values()}) == 1 or isinstance(files, str | Path)
    written = [path.as_posix() for path in named.values()]
    table = pd.DataFrame({FILE: inside if one_folder else written})
    table = table.join(pd.DataFrame(rows).reindex(columns=["status", "reason"]))
    reason = table.pop("reason")
    placed = [number for number, vector in enumerate(vectors) if vector is not None]
    if placed:
        predicted = model.predict(np.stack([vectors[number] for number in placed]))
        table = table.join(predicted.set_axis(placed))
        table["error"] = np.where(table["status"] == "refused", np.nan, model.error)
    table["person_known"] = persons_known
    table.loc[table["status"] == "refused", "person_known"] = ""
    if placed:
        same = table["distance"] < SAME
        table.loc[same, "distance"], table.loc[same, "person_known"] = 0.0, ITSELF
    return Predictions(model, table.assign(reason=reason))


def prediction_lines(population: Population, vector: np.ndarray) -> list[str]:
    """Return what the usual trait of a population is for one walk, in sentences; none of many.

    Of more than 150 walkers it would take too long for who waits.
    """
    try:
        trait = usual_trait(population)
        if len(population) > MOST_WAITED_FOR:
            return [f"{trait} of many walkers is told by 'eigenwalker predict'."]
        model = trait_model(population, trait)
    except ValueError:  # nothing tells these walkers apart
        return []
    row = model.predict(vector).iloc[0]
    value = f"{row['prediction']:.4g}" if model.is_number else str(row["prediction"])
    lines = [f"Predicted {model.trait}: {value}. {error_to_expect(model)}"]
    if row["distance"] < SAME:
        lines.append("This capture is one of the population: what is predicted was learnt from it.")
    if row["far"]:
        lines.append(
            f"This walk is far from all walkers learnt from (in {row['far_in']}): do not rely on "
            "what is predicted."
        )
    return lines


def _paths(files: Sequence[str | Path] | str | Path) -> dict[Path, Path]:
    """Return where captures are, and how they were named."""
    given = [files] if isinstance(files, str | Path) else list(files)
    paths: dict[Path, Path] = {}
    for each in map(Path, given):
        if not each.exists():
            raise ValueError(f"{each} does not exist; name captures, or folders of them.")
        inside = [each / name for name in sorted(captures_in(each))] if each.is_dir() else [each]
        paths |= {Path(os.path.abspath(path)): path for path in inside}
    if not paths:
        raise ValueError("There are no captures to predict of; name files, or folders of them.")
    return paths


def _placed(
    population: Population, result: CaptureResult
) -> tuple[Walker | np.ndarray | None, dict[str, Any]]:
    return population.vector(result.walker), status_of(result)


def _persons_known(model: TraitModel, files: pd.Series, pattern: str | None) -> list[str]:
    """Return who of those learnt from walks in each file, by a pattern or a word of its name."""
    population = model.population.select(model.rows)
    learnt = set() if population.persons is None else set(population.persons) - {""}
    if pattern:
        who = persons_of(traits_of_names(files, pattern))
        if who is None:
            raise ValueError(f"trait_from_name={pattern!r} has no group 'person'; name one so.")
        return [p if p in learnt else "" for p in who]
    by_name = {name.rpartition("/")[2]: name for name in population.names}
    known = []
    for file in files:
        name = file.rpartition("/")[2]
        words = {word.casefold() for word in re.findall(r"[^\W_]+", file)}
        sure = [p for p in learnt if not p.isdecimal() and p.casefold() in words]
        known.append(sure[0] if sure else f"the capture {name}" if name in by_name else "")
    return known
