"""Walks of files and populations, named and made ready to be compared."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np
import pandas as pd
import xarray as xr
from scipy.spatial.distance import pdist

from eigenwalker.analysis.walker_space import WalkerSpace
from eigenwalker.core.progress import Progress
from eigenwalker.metric.clips import PreparedClip, as_trajectories
from eigenwalker.metric.prepared import prepare
from eigenwalker.metric.retargeting import retarget
from eigenwalker.population.population import FLAG, Population, flags_of
from eigenwalker.study.body_warnings import strangeness
from eigenwalker.study.capture_table import FILE, capture_table
from eigenwalker.study.messages import flag_of
from eigenwalker.study.process_capture import process_capture

STRANGE = "strange"
"""Attribute of a walk that says why it is not itself on the mannequin."""
MOST_CLASSES = 10
"""Values of a trait of numbers up to which each is a class."""


@dataclass(frozen=True, eq=False)
class Walks:
    """Walks by name, and what could not be taken.

    Parameters
    ----------
    clips : dict of str to PreparedClip
        The walks.
    labels : dict of str to str
        A class of each walk, such as its style, where one is known.
    refused : dict of str to str
        Why captures could not be used, by name.
    flagged : dict of str to str
        What is wrong with walks that are left out for it, by name.
    remarks : dict of str to str
        What is to be known of walks that count, by name.
    vectors : dict of str to array
        Walkers of a population as points of its feature space; empty for captures.

    """

    clips: dict[str, PreparedClip]
    labels: dict[str, str] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    flagged: dict[str, str] = field(default_factory=dict)
    remarks: dict[str, str] = field(default_factory=dict)
    vectors: dict[str, np.ndarray] = field(default_factory=dict)


def walk_of_capture(
    path: Path, *, mannequin: bool = True, unit: str | None = None, rate_hz: float | None = None
) -> xr.DataArray:
    """Return the steady strides of a capture, ready to be compared (`prepare_walk`).

    Unit and frame rate are for files that name none: others keep their own. The attributes say what
    is wrong with the capture (``flag``), and why it is not itself on the mannequin (``strange``);
    empty if nothing is.
    """
    result = process_capture(path, joints="full", default_unit=unit, default_rate_hz=rate_hz)
    own = result.walk.assign_attrs({FLAG: flag_of(result.quality)})
    if not mannequin:
        return own
    shown = retarget(own)
    return shown.assign_attrs({STRANGE: strangeness(own, shown)})


def remarks_on(clip: xr.DataArray) -> str:
    """Return what is to be known of the capture behind a walk, in words; mostly nothing."""
    flag, strange = clip.attrs.get(FLAG), clip.attrs.get(STRANGE)
    said = [f"it is flagged: {flag.rstrip('.')}"] if flag else []
    return "; ".join([*said, strange] if strange else said)


def walks_of_population(
    population: Population,
    *,
    trait: str | None = None,
    mannequin: bool = True,
    progress: Progress | None = None,
) -> Walks:
    """Return the walkers of a population as walks, named by file or number.

    Parameters
    ----------
    population : Population
        Its flagged walkers are left out; `Population.without_flags` counts them too.
    trait : str, optional
        Trait to be the label.
    mannequin : bool
        Whether to show them on the neutral mannequin.
    progress : callable, optional
        Called with the number of walkers that are done, and of all.

    """
    if trait is not None and trait not in population.traits:
        raise ValueError(
            f"The population has no trait {trait!r}; it has {list(population.traits.columns)}."
        )
    if trait is not None:
        _refuse_continuous(population.traits[trait])
    names, flags = population.names, flags_of(population.traits)
    clips, flagged = {}, {}
    for row, (name, walker) in enumerate(zip(names, population.walkers, strict=True)):
        if population.flagged[row]:
            flagged[name] = flags[row]
        else:
            walk = as_trajectories(walker)
            clips[name] = prepare(retarget(walk) if mannequin else walk)
        if progress is not None:
            progress(row + 1, len(names))
    labels = {}
    if trait is not None:
        told = population.traits[trait].astype(str)
        labels = {name: label for name, label in zip(names, told, strict=True) if name in clips}
    vectors = {name: row for name, row in zip(names, population.X, strict=True) if name in clips}
    return Walks(clips, labels, flagged=flagged, vectors=vectors)


def walker_space_distances(walks: Walks) -> np.ndarray:
    """Return how far walkers of a population are apart in their `WalkerSpace`.

    Parameters
    ----------
    walks : Walks
        As `walks_of_population` gives them.

    Returns
    -------
    array of shape (pair,)
        Pairs in the order of `itertools.combinations`.

    """
    return pdist(WalkerSpace().fit_transform(np.stack(list(walks.vectors.values()))))


def _refuse_continuous(values: pd.Series) -> None:
    """Refuse a trait whose values are no classes, so that walks could be of the same one."""
    kinds = values.nunique()
    if pd.api.types.is_bool_dtype(values) or not pd.api.types.is_numeric_dtype(values):
        return
    if kinds > MOST_CLASSES or kinds > len(values) / 2:
        raise ValueError(
            f"The trait {values.name!r} has {kinds} different numbers in {len(values)} walkers, so "
            "it has no classes that could be apart; name one that has, or tell it from walks with "
            "'eigenwalker classify'."
        )


def walks_of_folder(
    folder: str | Path,
    *,
    trait_from_name: str | None = None,
    with_flagged: bool = False,
    mannequin: bool = True,
    unit: str | None = None,
    rate_hz: float | None = None,
    progress: Progress | None = None,
) -> Walks:
    """Return the captures of a folder and its subfolders as walks, named by file.

    Parameters
    ----------
    folder : path
        Where to look.
    trait_from_name : str, optional
        Pattern over names with a named group, which is the label: ``walk_(?P<style>[a-z]+)_``.
    with_flagged : bool
        Whether captures count that are flagged (`assess`).
    mannequin, unit, rate_hz
        As in `walk_of_capture`.
    progress : callable, optional
        Called with the number of captures that are done, and of all.

    Raises
    ------
    ValueError
        If the folder holds no captures, or the pattern makes no sense.

    """
    table = capture_table(folder, None, trait_from_name)
    named = [column for column in table if column != FILE]
    clips: dict[str, PreparedClip] = {}
    labels, refused, flagged, remarks = {}, {}, {}, {}
    for done, row in enumerate(table.to_dict("records"), start=1):
        name = str(row[FILE])
        try:
            walk = walk_of_capture(folder / name, mannequin=mannequin, unit=unit, rate_hz=rate_hz)
            if walk.attrs[FLAG] and not with_flagged:
                flagged[name] = walk.attrs[FLAG]
            else:
                clips[name] = repeating(walk)
                labels |= {name: str(row[named[0]])} if named else {}
                remarks |= {name: said} if (said := remarks_on(walk)) else {}
        except (ValueError, OSError) as error:
            refused[name] = str(error)
        if progress is not None:
            progress(done, len(table))
    return Walks(with_like_rotations(clips), labels, refused, flagged, remarks)


def with_like_rotations(clips: dict[str, PreparedClip]) -> dict[str, PreparedClip]:
    """Return clips that all have captured rotations, or none of them: others tell less by them."""
    if all("rotation" in each.clip.coords for each in clips.values()):
        return clips
    return without_rotations(clips)


def without_rotations(clips: dict[str, PreparedClip]) -> dict[str, PreparedClip]:
    """Return clips without their captured rotations: positions alone tell joint angles then."""
    return {
        name: replace(
            each,
            clip=each.clip.drop_vars("rotation", errors="ignore"),
            cycle=None if each.cycle is None else each.cycle.drop_vars("rotation", errors="ignore"),
        )
        for name, each in clips.items()
    }


def repeating(walk: xr.DataArray) -> PreparedClip:
    """Return a walk made ready; refuse what does not repeat, as it would change how all compare."""
    prepared = prepare(walk)
    if prepared.cycle is None:
        raise ValueError(prepared.not_periodic_reason)
    return prepared
