"""The gait parameters of all captures of a folder, as a tidy table with its codebook."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd

from eigenwalker.core.progress import Progress, ticked
from eigenwalker.gait.events import gait_events
from eigenwalker.gait.parameters import gait_parameters
from eigenwalker.population.persons import PERSON, name_persons, persons_of
from eigenwalker.population.trait_table import heading_parts
from eigenwalker.study.capture_table import FILE, capture_table
from eigenwalker.study.fit_folder import outcomes_in_processes, status_of
from eigenwalker.study.messages import parameter_codebook
from eigenwalker.study.process_capture import CaptureResult
from eigenwalker.study.traits_file import UNITS

PERCENT = 100.0


@dataclass(frozen=True, eq=False)
class ParameterTable:
    """Gait parameters of captures.

    Parameters
    ----------
    files : DataFrame
        One row a capture: ``file``, its traits, ``person`` where that is known, ``status`` ("used",
        "flagged" or "refused"), ``reason``, ``strides``, ``duration_s``, ``events_from``, and a
        column a parameter; empty of captures that were refused.
    persons : DataFrame
        One row a person and parameter: ``person``, ``parameter``, ``unit``, ``walks`` that are
        neither flagged nor refused, their ``mean`` and ``sd`` (empty of one walk). A walk of which
        nobody knows whose it is stands for itself.
    codebook : DataFrame
        One row a column of `files`: ``column``, ``unit``, ``meaning``.

    See Also
    --------
    parameter_table : Makes it.
    """

    files: pd.DataFrame
    persons: pd.DataFrame
    codebook: pd.DataFrame

    def _repr_html_(self) -> str:
        """The table of files, for notebooks."""
        return self.files.to_html(index=False, escape=True, float_format="{:.4g}".format, na_rep="")


def parameter_table(
    folder: str | Path,
    *,
    traits: pd.DataFrame | str | Path | None = None,
    trait_from_name: str | None = None,
    person: str | None = None,
    with_flagged: bool = False,
    n_jobs: int = -1,
    progress: Progress | None = None,
    **reading: Any,
) -> ParameterTable:
    """Return the gait parameters of all captures of a folder.

    Parameters
    ----------
    folder, traits, trait_from_name, person
        As `fit_folder` takes them.
    with_flagged : bool
        Whether flagged captures count in the means of persons.
    n_jobs : int
        Processes to read with; -1 uses all cores.
    progress : callable, optional
        Called with the number of captures done and of all.
    **reading
        As `process_capture` takes them, such as ``unit`` and ``rate_hz``.

    Returns
    -------
    ParameterTable
        In mm, s, steps a minute and % of the stride.

    Raises
    ------
    ValueError
        If folder, table or pattern make no sense; never because of a single capture.

    See Also
    --------
    eigenwalker.gait.gait_parameters : Those of one walk.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     _ = ew.write_mocap(ew.simulate_walk(seed=1), f"{folder}/anna.c3d")
    ...     table = parameter_table(folder, n_jobs=1)
    >>> table.files[["file", "status", "cadence_steps_min"]].round(0)
           file status  cadence_steps_min
    0  anna.c3d   used              104.0
    """
    folder = Path(folder)
    table = capture_table(folder, traits, trait_from_name)
    if person is not None:
        table = name_persons(table, person)
    names, settings = table[FILE].tolist(), {"joints": "full", **reading}
    outcomes = outcomes_in_processes(folder, names, settings, n_jobs, _measured)
    rows = [row for _, row in ticked(outcomes, len(names), progress)]
    measured = pd.DataFrame(rows).reindex(columns=list(parameter_codebook()))
    traits_of = table.drop(columns=[name for name in measured if name in table and name != FILE])
    files = pd.concat([traits_of, measured.drop(columns=FILE, errors="ignore")], axis=1)
    who = persons_of(table)
    counted = files["status"].isin(["used", "flagged"] if with_flagged else ["used"]).to_numpy()
    return ParameterTable(
        files,
        _by_person(files[counted], None if who is None else who[counted]),
        _codebook(files, table.attrs.get(UNITS, {})),
    )


def _measured(result: CaptureResult) -> tuple[None, dict[str, Any]]:
    """Return the row of a capture."""
    parameters, events = gait_parameters(result.walk), gait_events(result.walk)
    row = {
        **status_of(result),
        "strides": result.quality.n_strides,
        "duration_s": result.quality.duration_s,
        "events_from": ", ".join(sorted({_plain(name) for name in events["marker"]})),
    }
    return None, row | {str(name): _in_unit(str(name), v) for name, v in parameters.items()}


def _plain(marker: str) -> str:
    return marker.partition("_")[2] or marker


def _in_unit(name: object, value: float) -> float:
    """Return a parameter in the unit of the codebook."""
    _, unit, _ = parameter_codebook()[str(name)]
    return PERCENT * value if unit == "%" else value


def _by_person(files: pd.DataFrame, persons: Sequence[str] | np.ndarray | None) -> pd.DataFrame:
    """Return mean and SD of each parameter over the walks of each person."""
    book = parameter_codebook()
    parameters = [name for name in files if name in book and book[str(name)][0] == "parameter"]
    unnamed = files[FILE].astype(str).to_numpy()
    who = unnamed if persons is None else np.where(np.asarray(persons) == "", unnamed, persons)
    long = files[parameters].assign(**{PERSON: who}).melt(PERSON, var_name="parameter")
    long["value"] = long["value"].astype(float)
    groups = long.groupby([PERSON, "parameter"], sort=False)["value"]
    tidy = groups.agg(walks="count", mean="mean", sd="std").reset_index()
    tidy.insert(2, "unit", [book[name][1] for name in tidy["parameter"]])
    return tidy


def _codebook(files: pd.DataFrame, units: Mapping[str, str]) -> pd.DataFrame:
    book = parameter_codebook()
    rows = [
        (
            name,
            *(book[name][1:] if name in book else (_unit(name, units), "trait, as it was given")),
        )
        for name in map(str, files)
    ]
    return pd.DataFrame(rows, columns=["column", "unit", "meaning"])


def _unit(trait: str, units: Mapping[str, str]) -> str:
    """Return the unit of a trait by its cells, else by its heading."""
    return units.get(trait) or heading_parts(trait)[1]
