"""All walks of a folder or a population, named and made comparable."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
from scipy.spatial.distance import pdist

from eigenwalker.analysis.walker_space import WalkerSpace
from eigenwalker.core.progress import Progress, ticked
from eigenwalker.metric.clips import PreparedClip, as_trajectories
from eigenwalker.metric.prepared import prepare
from eigenwalker.metric.retargeting import retarget
from eigenwalker.population.persons import name_persons, person_column, persons_of
from eigenwalker.population.population import Population, check_population, flags_of
from eigenwalker.study.body_warnings import retargeting_warnings
from eigenwalker.study.capture_table import FILE, capture_table
from eigenwalker.study.messages import capture_remark, flag_of
from eigenwalker.study.process_capture import process_capture

MAX_CLASSES = 10
"""Values of a numeric trait up to which each is a class."""


@dataclass(frozen=True, eq=False)
class Walks:
    """Walks by name, ready to be compared, and what could not be used.

    ``clips`` are the walks: what `pair_table`, `group_table` and `fit_to_answers` take. Some have
    ``labels``, such as their style, and ``remarks`` to be minded. ``refused`` tells why captures
    could not be used, ``flagged`` what is wrong with walks that are left out for it. ``vectors``
    are walkers of a population in its feature space, of shape (feature,) each; none of captures.
    ``persons`` are those whose walks they are, where that is known.

    See Also
    --------
    walks_of_folder, walks_of_population : make it.
    """

    clips: dict[str, PreparedClip]
    labels: dict[str, str] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    flagged: dict[str, str] = field(default_factory=dict)
    remarks: dict[str, str] = field(default_factory=dict)
    vectors: dict[str, np.ndarray] = field(default_factory=dict)
    persons: dict[str, str] = field(default_factory=dict)

    def __repr__(self) -> str:
        return (
            f"Walks({len(self.clips)} walks, {len(self.refused)} refused, "
            f"{len(self.flagged)} flagged)"
        )


class CaptureWalk(NamedTuple):
    """The walk of a capture, what is wrong with the capture, and remarks.

    Parameters
    ----------
    clip : PreparedClip
        The steady strides, in mm; on the mannequin if that was asked for.
    flag : str
        What is wrong with the capture, in a sentence; empty if nothing is.
    remark : str
        What to know before comparing the walk, in words; empty if there is nothing.

    See Also
    --------
    walk_of_capture : Makes it.
    """

    clip: PreparedClip
    flag: str
    remark: str


def walk_of_capture(
    path: str | Path,
    *,
    mannequin: bool = True,
    **reading: Any,
) -> CaptureWalk:
    """Return the steady strides of a capture, to be compared with other walks.

    Parameters
    ----------
    path : path
        A capture of any format that `read_mocap` reads.
    mannequin : bool
        Whether to show the walk on the neutral mannequin (`retarget`).
    **reading
        As `process_capture` takes them, such as ``default_unit``, ``default_rate_hz``, ``mapping``.

    Returns
    -------
    CaptureWalk

    See Also
    --------
    process_capture : The same with the walker and the quality.
    """
    result = process_capture(path, joints="full", **reading)
    flag, walk, warnings = flag_of(result.quality), result.walk, None
    if mannequin:
        walk = retarget(result.walk)
        warnings = retargeting_warnings(result.walk, walk)
    return CaptureWalk(prepare(walk), flag, capture_remark(flag, warnings))


def walks_of_folder(
    folder: str | Path,
    *,
    trait_from_name: str | None = None,
    person: str | None = None,
    with_flagged: bool = False,
    mannequin: bool = True,
    progress: Progress | None = None,
    **reading: Any,
) -> Walks:
    """Return the captures of a folder and its subfolders as comparable walks, named by file.

    Parameters
    ----------
    folder : path
        Where to look.
    trait_from_name : str, optional
        Pattern over names with a named group, which is the label: ``walk_(?P<style>[a-z]+)_``; a
        group ``person`` says who walked, and other words for it do.
    person : str, optional
        Which group it is.
    with_flagged : bool
        Whether captures count that are flagged (`assess`).
    mannequin : bool
        Whether to show the walks on the neutral mannequin (`retarget`).
    progress : callable, optional
        Called with the number of captures that are done, and of all.
    **reading
        As `process_capture` takes them, such as ``default_unit``, ``default_rate_hz``, ``mapping``.

    Returns
    -------
    Walks
        Captured rotations are kept if all walks have them, since others say less by them.

    Raises
    ------
    ValueError
        If the folder holds no captures, or the pattern makes no sense.

    See Also
    --------
    walks_of_population : The same for walkers of a population.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     for seed, name in enumerate(["anna", "ben"]):
    ...         walk = ew.simulate_walk(seed=seed, rate_hz=60)
    ...         path = ew.write_mocap(walk, f"{folder}/{name}.c3d")
    ...     walks = walks_of_folder(folder)
    >>> walks, list(walks.clips)
    (Walks(2 walks, 0 refused, 0 flagged), ['anna.c3d', 'ben.c3d'])
    """
    table = capture_table(folder, None, trait_from_name)
    if person is not None:
        table = name_persons(table, person)
    who = persons_of(table)
    persons: dict[str, str] = {}
    if who is not None:
        persons = dict(zip(table[FILE].tolist(), who.tolist(), strict=True))
    label = next((name for name in table if name not in (FILE, person_column(table))), None)
    walks = Walks({})
    for row in ticked(table.to_dict("records"), len(table), progress):
        name = str(row[FILE])
        try:
            clip, flag, remark = walk_of_capture(Path(folder, name), mannequin=mannequin, **reading)
        except (ValueError, OSError) as error:
            walks.refused[name] = str(error)
            continue
        if flag and not with_flagged:
            walks.flagged[name] = flag
        elif clip.cycle is None:  # it would change how all walks are compared
            walks.refused[name] = clip.not_periodic_reason
        else:
            walks.clips[name] = clip
            walks.labels.update({} if label is None else {name: str(row[label])})
            walks.remarks.update({name: remark} if remark else {})
    persons = {name: persons[name] for name in walks.clips if persons.get(name)}
    return replace(walks, clips=with_common_rotations(walks.clips), persons=persons)


def walks_of_population(
    population: Population,
    *,
    trait: str | None = None,
    mannequin: bool = True,
    progress: Progress | None = None,
) -> Walks:
    """Return the walkers of a population as comparable walks, named by file or number.

    Parameters
    ----------
    population : Population
        Its flagged walkers are left out; `Population.without_flags` counts them too.
    trait : str, optional
        Trait to be the label.
    mannequin : bool
        Whether to show them on the neutral mannequin (`retarget`).
    progress : callable, optional
        Called with the number of walkers that are done, and of all.

    Returns
    -------
    Walks

    Raises
    ------
    ValueError
        If there is no such trait, or it has too many values to be classes.

    See Also
    --------
    walks_of_folder : The same for captures.

    Examples
    --------
    >>> walks = walks_of_population(ew.simulate_population(2, 2, seed=1), trait="sex")
    >>> walks.labels["walker 0"], list(walks.clips)
    ('female', ['walker 0', 'walker 1', 'walker 2', 'walker 3'])
    """
    check_population(population)
    labels = [] if trait is None else _labels(population, trait)
    names, flags = population.names, flags_of(population.traits)
    persons = population.persons
    who = {} if persons is None else dict(zip(names, persons.tolist(), strict=True))
    clips, flagged = {}, {}
    walkers = zip(names, population.walkers, flags, population.flagged, strict=True)
    for name, walker, flag, is_flagged in ticked(walkers, len(names), progress):
        if is_flagged:
            flagged[name] = flag
        else:
            walk = as_trajectories(walker)
            clips[name] = prepare(retarget(walk) if mannequin else walk)
    return Walks(
        clips,
        {name: label for name, label in zip(names, labels, strict=False) if name in clips},
        flagged=flagged,
        vectors={name: row for name, row in zip(names, population.X, strict=True) if name in clips},
        persons={name: who[name] for name in clips if who.get(name)},
    )


def _labels(population: Population, trait: str) -> list[str]:
    """Return the class of each walker; refuse a trait whose values are no classes."""
    if trait not in population.traits:
        raise ValueError(
            f"The population has no trait {trait!r}; it has {list(population.traits.columns)}."
        )
    values = population.traits[trait]
    numeric = pd.api.types.is_numeric_dtype(values) and not pd.api.types.is_bool_dtype(values)
    n_values = values.nunique()
    if numeric and (n_values > MAX_CLASSES or n_values > len(values) / 2):
        raise ValueError(
            f"The trait {trait!r} has {n_values} different numbers in {len(values)} walkers, so "
            "it has no classes that could be apart; name one that has, or predict it from walks "
            "with 'eigenwalker classify'."
        )
    return values.astype(str).tolist()


def walker_space_distances(walks: Walks) -> np.ndarray:
    """Return how far walkers of a population are apart in their `WalkerSpace`.

    Parameters
    ----------
    walks : Walks
        Of `walks_of_population`.

    Returns
    -------
    array of shape (pair,)
        Euclidean distances of their scores, in the order of `itertools.combinations`: what
        `fit_to_answers` takes as one of ``others``. Without unit: features are standardised.

    Raises
    ------
    ValueError
        If the walks are of captures, which have no ``vectors``.

    See Also
    --------
    eigenwalker.psychophysics.fit_to_answers : Compares them with metrics.
    """
    return pdist(WalkerSpace().fit_transform(np.stack(list(walks.vectors.values()))))


def with_common_rotations(clips: dict[str, PreparedClip]) -> dict[str, PreparedClip]:
    """Return clips that all have captured rotations, or none of them."""
    if all("rotation" in each.clip.coords for each in clips.values()):
        return clips
    return {name: without_rotations(each) for name, each in clips.items()}


def without_rotations(prepared: PreparedClip) -> PreparedClip:
    """Return a clip without its captured rotations, whose joint angles come from positions."""
    clip, cycle = (
        None if each is None else each.drop_vars("rotation", errors="ignore")
        for each in (prepared.clip, prepared.cycle)
    )
    return replace(prepared, clip=clip, cycle=cycle)
