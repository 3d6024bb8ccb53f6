"""A folder of captures made into a population; a bad file does not stop the others."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import joblib
import numpy as np
import pandas as pd
from joblib.externals.loky.process_executor import TerminatedWorkerError
from threadpoolctl import threadpool_limits

from eigenwalker.core.progress import Progress, ticked
from eigenwalker.core.walker import Form, Walker
from eigenwalker.io.read import companion_files
from eigenwalker.markers.mapping import as_mapping
from eigenwalker.population.persons import name_persons
from eigenwalker.population.population import FLAG, Population, flags_of, join_flags
from eigenwalker.study.capture_table import FILE, capture_table, captures_in
from eigenwalker.study.checkpoint import Checkpoint
from eigenwalker.study.messages import (
    assumed_rate_in_words,
    flag_of,
    rebuilt_in_words,
    summarise,
)
from eigenwalker.study.process_capture import CaptureResult, process_capture

_Outcome = tuple[Walker | None, dict[str, Any]]
"""The walker of a capture, None where it was refused, and its row of `Study.files`."""


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
    unlisted : tuple of str
        Captures of the folder that a traits table does not list.
    n_resumed : int
        Captures that an earlier run had read, which was interrupted.

    See Also
    --------
    fit_folder : Makes it.
    """

    population: Population | None
    files: pd.DataFrame
    unlisted: tuple[str, ...] = ()
    n_resumed: int = 0

    def _repr_html_(self) -> str:
        """The table of files, for notebooks."""
        return self.files.to_html(index=False, escape=True, float_format="{:.4g}".format, na_rep="")

    @property
    def refused(self) -> pd.DataFrame:
        """The captures that could not be used, with the reason."""
        return self.files[self.files["status"] == "refused"]

    @property
    def summary(self) -> pd.DataFrame:
        """Medians and ranges of what was measured (`summarise`)."""
        return summarise(self.files)


def fit_folder(
    folder: str | Path,
    *,
    traits: pd.DataFrame | str | Path | None = None,
    trait_from_name: str | None = None,
    form: Form = "eigenposture",
    n_harmonics: int = 2,
    mapping: Any = None,
    person: str | None = None,
    low_pass_hz: float | None = None,
    n_jobs: int = -1,
    checkpoint: str | Path | None = None,
    progress: Progress | None = None,
    **reading: Any,
) -> Study:
    r"""Return the population of the captures in a folder.

    Parameters
    ----------
    folder : str or Path
        Searched with its subfolders.
    traits : DataFrame or path of a CSV, optional
        A column ``file`` (relative to the folder) and the traits of each walker; a column
        ``person`` says whose walk it is. Only the captures it lists are read.
    trait_from_name : str, optional
        A regular expression with named groups, searched in each file's name, such as
        ``r"walk_(?P<style>[a-z]+)_"``.
    form : {"eigenposture", "fourier"}
        Decomposition: principal components or a Fourier series.
    n_harmonics : int
        Multiples of the stride frequency.
    person : str, optional
        The trait that says who walked, or "none"; else one such as
        ``person``, ``Subject`` or a repeating ``ID`` is taken.
    mapping : optional
        Markers with names of your own, as `virtual_markers` takes it; the same for all captures.
    low_pass_hz : float, optional
        Cut-off of a low-pass filter, for noisy captures.
    n_jobs : int
        Processes to read with; -1 uses all cores.
    checkpoint : str or Path, optional
        A file to which each walker is added as soon as it is made. If it is there from an earlier
        run that was interrupted, of the same folder with the same settings, captures that have not
        changed since are not read again. Remove it when the population is saved.
    progress : callable, optional
        Called with the number of captures done and of all.
    **reading
        As `read_mocap` takes them, such as ``unit`` and ``rate_hz``; those that are cut short
        (``partial="keep"``) are flagged.

    Returns
    -------
    Study

    Raises
    ------
    ValueError
        If folder, table or pattern make no sense; never because of a single capture.

    See Also
    --------
    process_capture : a single capture.

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
    table = capture_table(folder, traits, trait_from_name)
    if person is not None:
        table = name_persons(table, person)
    names = table[FILE].tolist()
    if n_harmonics < 1:
        raise ValueError(f"n_harmonics={n_harmonics} is too few; give 1 or more.")
    settings = {
        "form": form,
        "n_harmonics": n_harmonics,
        "mapping": as_mapping(mapping).as_dict(),
        "low_pass_hz": low_pass_hz,
        **reading,
    }
    earlier = None
    if checkpoint is not None:
        earlier = Checkpoint(Path(checkpoint), folder, settings)
    done: dict[str, _Outcome] = {}
    n_resumed = 0
    outcomes = _outcomes(folder, names, settings, n_jobs, earlier)
    for name, outcome, resumed in ticked(outcomes, len(names), progress):
        done[name] = outcome
        n_resumed += resumed
    unlisted = sorted(set(captures_in(folder)) - set(names)) if traits is not None else ()
    study = _study(table, [done[name] for name in names], form, tuple(unlisted))
    return replace(study, n_resumed=n_resumed)


def _study(
    table: pd.DataFrame, outcomes: list[_Outcome], form: Form, unlisted: tuple[str, ...]
) -> Study:
    rows = pd.DataFrame([row for _, row in outcomes])
    files = pd.concat([table[[FILE]], rows.drop(columns=FLAG, errors="ignore")], axis=1)
    read = [number for number, (walker, _) in enumerate(outcomes) if walker is not None]
    if not read:
        return Study(None, files, unlisted)
    traits = table.iloc[read].reset_index(drop=True)
    flags = join_flags(flags_of(traits), rows[FLAG].iloc[read])
    population = Population(
        tuple(walker for walker, _ in outcomes if walker is not None),
        traits.assign(**{FLAG: flags}),
        provenance=_provenance(rows.iloc[read], form),
    )
    reasons = population.traits[FLAG].to_numpy()
    files.loc[read, "reason"] = reasons
    files.loc[read, "status"] = np.where(reasons != "", "flagged", "used")
    return Study(population, files, unlisted)


def _provenance(rows: pd.DataFrame, form: Form) -> dict[str, str]:
    """Return in words where a population comes from: filter, and guessed units, if any."""
    provenance = {"source": f"{len(rows)} captures", "form": form}
    cut_offs = rows["low_pass_hz"].dropna()
    if len(cut_offs):
        provenance["low_pass"] = f"{cut_offs.iloc[0]:g} Hz, zero-phase Butterworth"
    guessed = rows["unit"][rows["unit_guessed"].astype(bool)]
    if len(guessed):
        units = ", ".join(f"{unit} {count}" for unit, count in guessed.value_counts().items())
        provenance["units"] = (
            f"guessed from the height of the body for {len(guessed)} of {len(rows)} captures, "
            f"whose files name none ({units})"
        )
    assumed = rows["rate_assumed"][rows["rate_assumed"] != ""]
    if len(assumed):
        most = assumed.value_counts().index[0]
        provenance["rates"] = f"assumed for {len(assumed)} of {len(rows)} captures ({most})"
    return provenance


def _outcomes(
    folder: Path,
    names: list[str],
    settings: Mapping[str, Any],
    n_jobs: int,
    checkpoint: Checkpoint | None,
) -> Iterator[tuple[str, _Outcome, bool]]:
    """Yield the outcome of each capture by name, and whether it was in the checkpoint."""
    waiting: dict[str, list[int]] = {}
    for name in names:
        state = _state(folder, name) if checkpoint else []
        if checkpoint and (earlier := checkpoint.get(name, state)):
            yield name, earlier, True
        else:
            waiting[name] = state
    made = outcomes_in_processes(folder, list(waiting), settings, n_jobs, _walker_and_row)
    for name, (walker, row) in zip(waiting, made, strict=True):
        if checkpoint is not None and walker is not None:
            checkpoint.append(name, waiting[name], walker, row)
        yield name, (walker, row), False


def outcomes_in_processes(
    folder: Path,
    names: list[str],
    settings: Mapping[str, Any],
    n_jobs: int,
    outcome_of: Callable[[CaptureResult], tuple[Any, dict[str, Any]]],
) -> Iterator[tuple[Any, dict[str, Any]]]:
    """Process captures in parallel; where the system ends a process, some one by one."""
    low_pass_hz = settings.get("low_pass_hz")
    if low_pass_hz is not None and not 0 < low_pass_hz < np.inf:
        raise ValueError(f"low_pass_hz={low_pass_hz:g} is no cut-off; give one above 0, such as 6.")
    if n_jobs == 0:
        raise ValueError("n_jobs=0 does nothing; give 1 or more, or -1 for all cores.")
    done = 0
    n_processes = min(joblib.effective_n_jobs(n_jobs), len(names))
    while done < len(names):
        tasks = [
            joblib.delayed(_outcome)(folder, name, settings, outcome_of) for name in names[done:]
        ]
        try:
            outcomes: Any = joblib.Parallel(n_processes, return_as="generator")(tasks)
            for outcome in outcomes:
                yield outcome
                done += 1
        except TerminatedWorkerError:
            for name in names[done : done + 2 * n_processes]:  # one of these was being read
                yield _alone(folder, name, settings, outcome_of)
                done += 1


def _alone(
    folder: Path,
    name: str,
    settings: Mapping[str, Any],
    outcome_of: Callable[[CaptureResult], tuple[Any, dict[str, Any]]],
) -> tuple[Any, dict[str, Any]]:
    """Process one capture in a process that the system may end."""
    try:
        task = joblib.delayed(_outcome)(folder, name, settings, outcome_of)
        outcomes: Any = joblib.Parallel(2)([task])
    except TerminatedWorkerError:
        return _refused(
            "the system ended the process that read it, as it does when memory runs out; look "
            "whether the file is far larger than the others, or use fewer processes"
        )
    return outcomes[0]


def _outcome(
    folder: Path,
    name: str,
    settings: Mapping[str, Any],
    outcome_of: Callable[[CaptureResult], tuple[Any, dict[str, Any]]],
) -> tuple[Any, dict[str, Any]]:
    """Process one capture; errors become its row."""
    try:
        path = _within(folder, name)
        with threadpool_limits(1), warnings.catch_warnings():
            warnings.simplefilter("ignore")  # the row holds what they say
            return outcome_of(process_capture(path, **settings))
    except ValueError as error:
        return _refused(str(error))
    except Exception as error:  # one capture must not stop the others
        return _refused(
            f"an unexpected {type(error).__name__} ({error}); please report it with the file"
        )


def _refused(reason: str) -> _Outcome:
    return None, {"status": "refused", "reason": reason}


def status_of(result: CaptureResult) -> dict[str, Any]:
    """Return the status of a capture that was read, and the reason where it is flagged."""
    flag = flag_of(result.quality)
    return {"status": "flagged" if flag else "used", "reason": flag}


def _walker_and_row(result: CaptureResult) -> _Outcome:
    return result.walker, _row(result)


def _row(result: CaptureResult) -> dict[str, Any]:
    """Return the row of `Study.files` for a capture that was read."""
    quality, walker, capture = result.quality, result.walker, result.capture
    return {
        **status_of(result),
        "rate_hz": quality.rate_hz,
        "duration_s": quality.duration_s,
        "strides": quality.n_strides,
        "frequency_hz": walker.frequency_hz,
        "speed_mm_s": walker.speed_mm_s,
        "straight_passes": quality.straight_passes,
        "unwound_deg": quality.unwound_deg,
        "r2": walker.fit.fourier_r2 if walker.fit else float("nan"),
        "periodicity": quality.periodicity,
        "wander_mm": quality.wander_mm,
        "bone_variation": max(quality.bone_length_variation.values(), default=float("nan")),
        "missing_share": float(np.isnan(capture.values).any(axis=2).mean()),
        "rebuilt": rebuilt_in_words(quality),
        "jumps": sum(quality.jumps.values()),
        "left_right_swaps": quality.left_right_swaps,
        "low_pass_hz": result.walk.attrs.get("low_pass_hz", float("nan")),
        "marker_set": result.walk.attrs.get("marker_set", ""),
        "unit": str(capture.attrs.get("unit", "mm")),
        "unit_guessed": quality.unit_guessed,
        "rate_assumed": assumed_rate_in_words(capture),
        "verdict": quality.verdict,
        FLAG: flag_of(quality),
    }


def _state(folder: Path, name: str) -> list[int]:
    """Return sizes and times of a capture and of the files that explain it.

    The time of the last change to the file itself tells one that was copied over it with its time.
    """
    path = folder / name
    if not path.is_file():
        return []
    stats = [file.stat() for file in (path, *companion_files(path))]
    return [n for stat in stats for n in (stat.st_size, stat.st_mtime_ns, stat.st_ctime_ns)]


def _within(folder: Path, name: str) -> Path:
    path = folder / name
    if not path.resolve().is_relative_to(folder.resolve()):
        raise ValueError(f"{name}: leads out of the folder {folder}; list captures inside it only.")
    return path
