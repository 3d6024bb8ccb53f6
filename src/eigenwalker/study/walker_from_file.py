"""Captures made into walkers, each in a process of its own."""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import joblib
import numpy as np
from joblib.externals.loky.process_executor import TerminatedWorkerError
from threadpoolctl import threadpool_limits

from eigenwalker.core.walker import Form, Walker
from eigenwalker.decomposition.fourier import decompose_fourier
from eigenwalker.decomposition.pca import decompose_pca
from eigenwalker.gait.in_place import in_place
from eigenwalker.io.read import companion_files, read_mocap
from eigenwalker.markers.virtual_markers import virtual_markers
from eigenwalker.population.population import FLAG
from eigenwalker.quality.findings import assess
from eigenwalker.study.checkpoint import Journal

DECOMPOSE = {"eigenposture": decompose_pca, "fourier": decompose_fourier}

Attempt = tuple[Walker | None, dict[str, object]]
"""The walker of a capture, None where there is none, and what is to be known of it."""


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


def attempts(
    folder: Path, names: list[str], settings: dict[str, Any], n_jobs: int, kept: Journal | None
) -> Iterator[tuple[str, Attempt]]:
    """Yield what became of each capture; first of those that an earlier run has made.

    Parameters
    ----------
    folder : Path
        That the names lead from; names that lead out of it are refused.
    names : list of str
        Captures.
    settings : dict
        As `walker_from_file` takes them.
    n_jobs : int
        Processes to read with; -1 uses all cores.
    kept : Journal or None
        Keeps each walker as soon as it is made.

    Yields
    ------
    name, attempt

    """
    waiting = []
    for name in names:
        if kept and (found := kept.find(name, _state(folder, name))):
            yield name, found
        else:
            waiting.append(name)
    for name, (walker, facts) in _made(folder, waiting, settings, n_jobs):
        if kept is not None and walker is not None:
            kept.keep(name, _state(folder, name), walker, facts)
        yield name, (walker, facts)


def _made(
    folder: Path, names: list[str], settings: dict[str, Any], n_jobs: int
) -> Iterator[tuple[str, Attempt]]:
    """Make walkers side by side; where the system ends a process, one by one for a while."""
    done = 0
    n_processes = min(joblib.effective_n_jobs(n_jobs), len(names))
    while done < len(names):
        try:
            for attempt in _side_by_side(folder, names[done:], settings, n_processes):
                yield names[done], attempt
                done += 1
        except TerminatedWorkerError:
            for name in names[done : done + 2 * n_processes]:  # one of these was being read
                yield name, _alone(folder, name, settings)
                done += 1


def _side_by_side(
    folder: Path, names: list[str], settings: dict[str, Any], n_processes: int
) -> Iterator[Attempt]:
    tasks = [joblib.delayed(_attempt)(folder, name, settings) for name in names]
    made: Any = joblib.Parallel(n_processes, return_as="generator")(tasks)
    return made


def _alone(folder: Path, name: str, settings: dict[str, Any]) -> Attempt:
    """One capture in a process that may die of it."""
    try:
        made: Any = joblib.Parallel(2)([joblib.delayed(_attempt)(folder, name, settings)])
    except TerminatedWorkerError:
        reason = (
            "the system ended the process that read it, as it does when memory runs out; look "
            "whether the file is far larger than the others, or use fewer processes"
        )
        return None, {"status": "refused", "reason": reason}
    return made[0]


def _state(folder: Path, name: str) -> list[int]:
    """Return size and time of a capture and of the files that explain it."""
    path = folder / name
    if not path.is_file():
        return []
    stats = [file.stat() for file in (path, *companion_files(path))]
    return [number for stat in stats for number in (stat.st_size, stat.st_mtime_ns)]


def _attempt(folder: Path, name: str, settings: dict[str, Any]) -> Attempt:
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
