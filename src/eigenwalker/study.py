"""A folder of captures made into a population, one bad file stopping no other."""

from __future__ import annotations

import csv
import re
import warnings
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import joblib
import numpy as np
import pandas as pd
from threadpoolctl import threadpool_limits

import eigenwalker
from eigenwalker.decomposition import decompose_fourier, decompose_pca
from eigenwalker.gait import in_place
from eigenwalker.journal import Journal
from eigenwalker.mocap import FORMATS, explained_by, is_capture, read_mocap, virtual_markers
from eigenwalker.population import FLAG, Population, flags_of, joined_flags
from eigenwalker.quality import assess
from eigenwalker.walker import Form, Walker

DECOMPOSE = {"eigenposture": decompose_pca, "fourier": decompose_fourier}
SUFFIXES = tuple(dict.fromkeys(form.suffix for form in FORMATS))
FILE = "file"
"""Column of a traits table that names the capture, relative to the folder."""


_Attempt = tuple[Walker | None, dict[str, object]]


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


def walker_from_file(
    path: str | Path,
    *,
    form: Form = "eigenposture",
    n_harmonics: int = 2,
    unit: str | None = None,
    rate_hz: float | None = None,
    low_pass_hz: float | None = None,
) -> tuple[Walker, dict[str, object]]:
    """Return the walker of one capture, from file to model, and what is to be known of it.

    Parameters
    ----------
    path : str or Path
        A capture of any format that `read_mocap` reads.
    form : {"eigenposture", "fourier"}
        How to take the walk apart.
    n_harmonics : int
        Multiples of the stride frequency.
    unit, rate_hz
        As `read_mocap` takes them, for captures that name none.
    low_pass_hz : float, optional
        Cut-off of a low-pass filter, as `in_place` takes it.

    Returns
    -------
    walker : Walker
    facts : dict
        What `Quality` tells of the capture, in single numbers and words, the marker set, and
        ``flag``: why the walk is to be kept out of averages, empty if it is not.

    Raises
    ------
    UnreadableFile, ValueError
        If the file cannot be read, is no body or no walk.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     file = ew.write_mocap(ew.simulate_walk(seed=1), f"{folder}/walk.c3d")
    ...     walker, facts = walker_from_file(file)
    >>> walker
    Walker(15 markers, 4 postures in the eigenposture form, 0.870 Hz, r2 0.99...)
    >>> facts["strides"], facts["flag"]
    (10, '')

    """
    capture = read_mocap(path, unit=unit, rate_hz=rate_hz)
    joints = virtual_markers(capture)
    walk = in_place(joints, low_pass_hz=low_pass_hz)
    walker = DECOMPOSE[form](walk, n_harmonics=n_harmonics)
    quality = assess(joints)
    facts: dict[str, object] = {
        "rate_hz": quality.rate_hz,
        "duration_s": quality.duration_s,
        "strides": walk.attrs["n_strides"],
        "frequency_hz": walker.frequency_hz,
        "speed_mm_s": walker.speed_mm_s,
        "straight_passes": quality.straight_passes,
        "unwound_deg": quality.unwound_deg,
        "r2": walker.fit.fourier_r2 if walker.fit else float("nan"),
        "periodicity": quality.periodicity,
        "wander_mm": quality.wander_mm,
        "bone_variation": max(quality.bone_length_variation.values(), default=float("nan")),
        "missing_share": float(np.isnan(capture.values).any(axis=2).mean()),
        "rebuilt": "; ".join(quality.rebuilt),
        "jumps": sum(quality.jumps.values()),
        "left_right_swaps": quality.left_right_swaps,
        "low_pass_hz": low_pass_hz or float("nan"),
        "marker_set": joints.attrs.get("marker_set", ""),
        "unit": str(capture.attrs.get("unit", "mm")),
        "unit_guessed": bool(capture.attrs.get("unit_guessed", False)),
        "verdict": quality.verdict,
        FLAG: quality.flag,
    }
    return walker, facts


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
        A file that keeps each walker as soon as it is made (`eigenwalker.journal`). If it is there
        from an earlier run that was interrupted, captures that have not changed since are not
        read again. Remove it when the population is saved.
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
    table = _listed(folder, traits, trait_from_name)
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
    version = {"version": eigenwalker.__version__}
    kept = None if journal is None else Journal(Path(journal), settings | version)
    done: dict[str, _Attempt] = {}
    for name, attempt in _attempts(folder, names, settings, n_jobs, kept):
        done[name] = attempt
        if progress:
            progress(len(done), len(names))
    walkers = [done[name][0] for name in names]
    study = _gathered(table, walkers, pd.DataFrame([done[name][1] for name in names]), form)
    unlisted = sorted(set(_captures_in(folder)) - set(names)) if traits is not None else ()
    return replace(study, unlisted=tuple(unlisted))


def _attempts(
    folder: Path, names: list[str], settings: dict[str, Any], n_jobs: int, kept: Journal | None
) -> Iterator[tuple[str, _Attempt]]:
    """Yield what became of each capture; first of those that an earlier run has made."""
    waiting = []
    for name in names:
        if kept and (found := kept.find(name, _state(folder, name))):
            yield name, found
        else:
            waiting.append(name)
    if not waiting:
        return
    tasks = [joblib.delayed(_attempt)(folder, name, settings) for name in waiting]
    n_processes = min(joblib.effective_n_jobs(n_jobs), len(tasks))
    attempts: Iterable[_Attempt] = joblib.Parallel(n_processes, return_as="generator")(tasks)  # pyright: ignore[reportAssignmentType] - typed as a list or None
    for name, (walker, facts) in zip(waiting, attempts, strict=True):
        if kept is not None and walker is not None:
            kept.keep(name, _state(folder, name), walker, facts)
        yield name, (walker, facts)


def _state(folder: Path, name: str) -> list[int]:
    """Return size and time of a capture and of the files that explain it."""
    path = folder / name
    if not path.is_file():
        return []
    stats = [file.stat() for file in (path, *explained_by(path))]
    return [number for stat in stats for number in (stat.st_size, stat.st_mtime_ns)]


def _attempt(folder: Path, name: str, settings: dict[str, Any]) -> _Attempt:
    """One capture in a process of its own; whatever goes wrong with it stays with it."""
    try:
        path = _within(folder, name)
        with threadpool_limits(1), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # what they say stands in the facts
            walker, facts = walker_from_file(path, **settings)
        return walker, {
            "status": "flagged" if facts[FLAG] else "used",
            "reason": facts[FLAG],
        } | facts
    except ValueError as error:
        return None, {"status": "refused", "reason": str(error)}
    except Exception as error:  # one capture must not stop the others
        reason = f"an unexpected {type(error).__name__} ({error}); please report it with the file"
        return None, {"status": "refused", "reason": reason}


def _within(folder: Path, name: str) -> Path:
    path = folder / name
    if not path.resolve().is_relative_to(folder.resolve()):
        raise ValueError(f"{name}: leads out of the folder {folder}; list captures inside it only.")
    return path


def _listed(
    folder: Path, traits: pd.DataFrame | str | Path | None, pattern: str | None
) -> pd.DataFrame:
    """The captures to read with what is known of each: a table with a column ``file``."""
    if not folder.is_dir():
        raise ValueError(f"{folder} is no folder; name one that holds captures ({_known()}).")
    if traits is not None:
        table = _traits_table(traits)
    else:
        names = sorted(_captures_in(folder))
        table = pd.DataFrame({FILE: names})
    if table.empty:
        raise ValueError(f"There are no captures ({_known()}) in {folder}.")
    if not pattern:
        return table
    named = _named_traits(table[FILE], pattern)
    if both := [str(name) for name in named if name in table]:
        raise ValueError(f"Both the traits table and the pattern name {both}; let one do so.")
    return table.join(named)


def _captures_in(folder: Path) -> list[str]:
    return [path.relative_to(folder).as_posix() for path in folder.rglob("*") if is_capture(path)]


def _known() -> str:
    return ", ".join(f"*{suffix}" for suffix in sorted(SUFFIXES))


def _traits_table(traits: pd.DataFrame | str | Path) -> pd.DataFrame:
    if not isinstance(traits, pd.DataFrame):
        try:
            traits = pd.read_csv(
                traits,
                sep=None,
                engine="python",
                encoding="utf-8-sig",
                converters={FILE: str, "person": str},
            )
        except (OSError, ValueError, csv.Error) as error:
            why = str(error).strip().rstrip(".")
            raise ValueError(
                f"The traits table {traits} could not be read: {why}. Save it as CSV in UTF-8."
            ) from error
    tidy = {name: str(name).strip() for name in traits}
    traits = traits.rename(columns=tidy).rename(columns={"File": FILE, "FILE": FILE})
    if FILE not in traits:
        raise ValueError(
            f"The traits table needs a column 'file' (relative to the folder); it has "
            f"{list(traits.columns)}."
        )
    table = traits.reset_index(drop=True)
    missing = table[FILE].isna() | (table[FILE].astype(str).str.strip() == "")
    if missing.any():
        row = int(np.flatnonzero(missing)[0]) + 1
        raise ValueError(f"Row {row} of the traits table names no file.")
    table[FILE] = [Path(str(name).strip()).as_posix() for name in table[FILE]]
    if (twice := table[FILE][table[FILE].duplicated()]).any():
        raise ValueError(f"The traits table lists {sorted(set(twice))[:5]} more than once.")
    return table


def _named_traits(names: pd.Series, pattern: str) -> pd.DataFrame:
    try:
        compiled = re.compile(pattern)
    except re.error as error:
        raise ValueError(f"{pattern!r} is no regular expression: {error}.") from error
    if not compiled.groupindex:
        raise ValueError(
            f"{pattern!r} has no named group; write for instance 'walk_(?P<style>[a-z]+)_'."
        )
    matches = [compiled.search(name) for name in names]
    if not any(matches):
        raise ValueError(f"{pattern!r} matches no file name; the first is {names.iloc[0]!r}.")
    found = pd.DataFrame(
        [match.groupdict() if match else dict.fromkeys(compiled.groupindex) for match in matches]
    )
    return found.apply(_numbers_where_all_are)


def _numbers_where_all_are(column: pd.Series) -> pd.Series:
    numbers = pd.to_numeric(column, errors="coerce")
    return numbers if numbers.notna().equals(column.notna()) else column


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
