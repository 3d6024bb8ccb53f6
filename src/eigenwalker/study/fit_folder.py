"""A folder of captures made into a population, one bad file stopping no other."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
import pandas as pd

from eigenwalker._version import __version__
from eigenwalker.core.walker import Form, Walker
from eigenwalker.population.population import FLAG, Population, flags_of, joined_flags
from eigenwalker.study.capture_table import FILE, captures_in, listed
from eigenwalker.study.checkpoint import Journal
from eigenwalker.study.walker_from_file import Attempt, attempts


@dataclass(frozen=True, eq=False)
class Study:
    """What came of the captures of a folder.

    Parameters
    ----------
    population : Population or None
        None where no capture could be used.
    files : DataFrame
        One row a capture: ``file``, ``status`` ("used", "flagged" or "refused"), ``reason``, and
        for those that were read the rate, duration, strides, frequency, speed and share explained.

    """

    population: Population | None
    files: pd.DataFrame
    unlisted: tuple[str, ...] = ()

    @property
    def refused(self) -> pd.DataFrame:
        """The captures that could not be used, with the reason."""
        return self.files[self.files["status"] == "refused"]


def fit_folder(
    folder: str | Path,
    *,
    traits: pd.DataFrame | str | Path | None = None,
    trait_from_name: str | None = None,
    form: Form = "eigenposture",
    n_harmonics: int = 2,
    unit: str | None = None,
    rate_hz: float | None = None,
    low_pass_hz: float | None = None,
    n_jobs: int = -1,
    journal: str | Path | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Study:
    r"""Return the population of the captures in a folder.

    Parameters
    ----------
    folder : str or Path
        Searched with its subfolders.
    traits : DataFrame or path of a CSV, optional
        A column ``file`` (relative to the folder) and whatever is known of each walker; a column
        ``person`` says whose walk it is. Only the captures it lists are read.
    trait_from_name : str, optional
        A regular expression with named groups, searched for in each file's name, such as
        ``r"walk_(?P<style>[a-z]+)_"``.
    form, n_harmonics, unit, rate_hz, low_pass_hz
        See `walker_from_file`.
    n_jobs : int
        Processes to read with; -1 uses all cores.
    journal : str or Path, optional
        A file that keeps each walker as soon as it is made (`eigenwalker.study.checkpoint`).
        If it is there from an earlier run that was interrupted, captures that have not changed
        since are not read again. Remove it when the population is saved.
    progress : callable, optional
        Called with the number of captures done and of all.

    Returns
    -------
    Study

    Raises
    ------
    ValueError
        If folder, table or pattern make no sense; never because of a single capture.

    Examples
    --------
    Three captures whose names say the sex:

    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     for seed, sex in enumerate(["female", "male", "female"]):
    ...         walk = ew.simulate_walk(sex=sex, seed=seed)
    ...         _ = ew.write_mocap(walk, f"{folder}/{sex}_{seed}.c3d")
    ...     study = fit_folder(folder, trait_from_name=r"(?P<sex>[a-z]+)_", n_jobs=1)
    >>> study.population.traits["sex"].tolist(), len(study.refused)
    (['female', 'female', 'male'], 0)

    """
    folder = Path(folder)
    table = listed(folder, traits, trait_from_name)
    names = table[FILE].tolist()
    if n_harmonics < 1:
        raise ValueError(f"n_harmonics={n_harmonics} is too few; give 1 or more.")
    settings = {
        "form": form,
        "n_harmonics": n_harmonics,
        "unit": unit,
        "rate_hz": rate_hz,
        "low_pass_hz": low_pass_hz,
    }
    version = {"version": __version__}
    kept = None if journal is None else Journal(Path(journal), settings | version)
    done: dict[str, Attempt] = {}
    for name, attempt in attempts(folder, names, settings, n_jobs, kept):
        done[name] = attempt
        if progress:
            progress(len(done), len(names))
    walkers = [done[name][0] for name in names]
    study = _gathered(table, walkers, pd.DataFrame([done[name][1] for name in names]), form)
    unlisted = sorted(set(captures_in(folder)) - set(names)) if traits is not None else ()
    return replace(study, unlisted=tuple(unlisted))


def _gathered(
    table: pd.DataFrame, walkers: list[Walker | None], facts: pd.DataFrame, form: Form
) -> Study:
    files = pd.concat([table[[FILE]], facts.drop(columns=FLAG, errors="ignore")], axis=1)
    kept = [number for number, walker in enumerate(walkers) if walker is not None]
    if not kept:
        return Study(None, files)
    traits = table.iloc[kept].reset_index(drop=True)
    flags = joined_flags(flags_of(traits), facts[FLAG].iloc[kept])
    population = Population(
        tuple(walker for walker in walkers if walker is not None),
        traits.assign(**{FLAG: flags}),
        provenance={"source": f"{len(kept)} captures", "form": form}
        | _filter(facts.iloc[kept])
        | _guesses(facts.iloc[kept]),
    )
    said = population.traits[FLAG].to_numpy()
    files.loc[kept, "reason"] = said
    files.loc[kept, "status"] = np.where(said != "", "flagged", "used")
    return Study(population, files)


def _filter(facts: pd.DataFrame) -> dict[str, str]:
    """The low-pass filter that all captures went through, in words; nothing if none was asked."""
    cut_offs = facts["low_pass_hz"].dropna()
    return (
        {} if cut_offs.empty else {"low_pass": f"{cut_offs.iloc[0]:g} Hz, zero-phase Butterworth"}
    )


def _guesses(facts: pd.DataFrame) -> dict[str, str]:
    """What had to be guessed of the captures, in words."""
    guessed = facts["unit"][facts["unit_guessed"].astype(bool)]
    if guessed.empty:
        return {}
    units = ", ".join(f"{unit} {count}" for unit, count in guessed.value_counts().items())
    return {
        "units": f"guessed from the height of the body for {len(guessed)} of {len(facts)} "
        f"captures, whose files name none ({units})"
    }
