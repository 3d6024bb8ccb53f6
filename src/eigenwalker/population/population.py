"""Walkers with their traits, in correspondence: the rows of a table of features."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from html import escape
from pathlib import Path

import numpy as np
import pandas as pd

from eigenwalker.core.arguments import check_kind, check_numbers
from eigenwalker.core.walker import Walker, check_walkers
from eigenwalker.core.walker_svg import beside, html_table
from eigenwalker.gait.heading import ground_speed
from eigenwalker.population.correspondence import (
    Correspondence,
    correspond,
    correspond_to,
    match_sign_and_order,
    posture_correlations,
)
from eigenwalker.population.features import FeatureLayout, circular_mean, wrap_phase
from eigenwalker.population.persons import name_persons, persons_of
from eigenwalker.population.trait_table import check_traits

FLAG = "flag"
"""Column of the traits that says why a walker is left out of averages and curves; empty if not."""
MOST_SHOWN = 12
"""Traits that a notebook shows."""


@dataclass(frozen=True, eq=False)
class Population:
    """Walkers and what is known of them.

    Making a population brings its walkers into correspondence, which needs no traits and is done
    once; a walker for which that fails is flagged. Flagged walkers stay, but shape no average.

    Parameters
    ----------
    walkers : sequence of Walker
        All of the same markers, form and number of harmonics.
    traits : DataFrame of shape (walker, trait)
        What is known of each walker: sex, age, ratings, file ... A column ``flag`` says why a
        walker should be left out, a column ``person`` whose trial it is; columns with other words
        for it are known too (``Subject``, ``ID``).
    correspondence : Correspondence, optional
        How walkers that are in correspondence already were brought there; leave it out for others.
    provenance : mapping of str to str
        Where the walkers come from: stored in the file and shown in reports.

    Raises
    ------
    ValueError
        If the walkers cannot be compared, or there is not one row of traits for each.

    See Also
    --------
    load_population, fit_folder, simulate_population : make one.

    References
    ----------
    Troje (2002), eq. 4 to 6 and 12.

    Examples
    --------
    >>> people = ew.load_population()
    >>> people.X.shape
    (40, 229)
    >>> tall = people.select(people.traits["height_mm"] > 1700)
    >>> extrapolated = people.walker(3 * people.X[0] - 2 * people.X[1])
    """

    walkers: Sequence[Walker]
    traits: pd.DataFrame
    correspondence: Correspondence | None = None
    provenance: Mapping[str, str] = field(default_factory=dict[str, str])

    def __post_init__(self) -> None:
        check_kind(self.walkers, Sequence, "walkers in a list")
        walkers, traits = tuple(self.walkers), check_traits(self.traits)
        if len(walkers) != len(traits):
            raise ValueError(
                f"There are {len(walkers)} walkers and {len(traits)} rows of traits; "
                "give one row for each walker, in the same order."
            )
        flags = flags_of(traits)
        if self.correspondence is None:
            walkers, correspondence = correspond(walkers, leave_out=[flag != "" for flag in flags])
            object.__setattr__(self, "correspondence", correspondence)
            flags = join_flags(flags, correspondence.flags)
        object.__setattr__(self, "walkers", walkers)
        object.__setattr__(self, "traits", traits.assign(**{FLAG: flags}))
        object.__setattr__(self, "provenance", dict(self.provenance))

    def __repr__(self) -> str:
        traits = ", ".join(str(name) for name in self.traits if name != FLAG)
        return (
            f"Population({len(self)} walkers, {self.flagged.sum()} flagged, "
            f"{len(self.feature_names)} features; traits: {traits})"
        )

    def _repr_html_(self) -> str:
        """The average walker, and a table of traits, for notebooks."""
        named = self.traits.drop(columns=FLAG)
        rows = [
            [escape(str(name)), escape(_summary(named[name])), str(int(named[name].notna().sum()))]
            for name in list(named)[:MOST_SHOWN]
        ]
        if len(named.columns) > MOST_SHOWN:
            rows.append([f"and {len(named.columns) - MOST_SHOWN} more", "", ""])
        flagged = f", {self.flagged.sum()} flagged" if self.flagged.any() else ""
        title = f"Population of {len(self)} walkers{flagged}, {len(self.feature_names)} features"
        head = [["<i>trait</i>", "<i>values</i>", "<i>known of</i>"]] if rows else []
        drawing = self.layout.walker(self.average).moving_svg()
        return beside(drawing, html_table([*head, *rows], title=title))

    def __len__(self) -> int:
        return len(self.walkers)

    @property
    def layout(self) -> FeatureLayout:
        """Which number of a feature vector is what."""
        return FeatureLayout.of(self.walkers[0])

    @property
    def feature_names(self) -> tuple[str, ...]:
        """Names of the columns of `X`."""
        return self.layout.names

    @property
    def names(self) -> list[str]:
        """What to call each walker: its file, or its number in the population."""
        numbers = [f"walker {row}" for row in range(len(self))]
        if "file" not in self.traits:
            return numbers
        files = self.traits["file"].fillna("").astype(str)
        return [file or number for file, number in zip(files, numbers, strict=True)]

    @property
    def persons(self) -> np.ndarray | None:
        """Whose walk each is, as text of shape (walker,), empty where unknown; None if nobody says.

        Such as ``person``, ``Subject`` or a repeating ``ID`` says; `with_persons` decides it.
        """
        return persons_of(self.traits)

    @property
    def flagged(self) -> np.ndarray:
        """Which walkers averages and curves leave out: bool of shape (walker,)."""
        return (self.traits[FLAG] != "").to_numpy()

    @property
    def in_average(self) -> np.ndarray:
        """Which walkers shape the average: the unflagged ones, or all where all are flagged."""
        return ~self.flagged | self.flagged.all()

    @cached_property
    def X(self) -> np.ndarray:  # noqa: N802 - the name that scikit-learn gives such a table
        """Features: array of shape (walker, feature), in mm, Hz and radians.

        Phases are unwrapped around their circular mean, so that they can be averaged.
        """
        table = np.stack([self.layout.vector(walker) for walker in self.walkers])
        return _read_only(self._unwrapped(table))

    @cached_property
    def average(self) -> np.ndarray:
        """The average walker as a vector, w_0 of Troje (2002), eq. 5: shape (feature,).

        Every walk counts once, also several of a person.
        """
        return _read_only(self.X[self.in_average].mean(axis=0))

    @cached_property
    def sizes(self) -> np.ndarray:
        """Size of each walker relative to the average one: array of shape (walker,).

        The least-squares s_j in ``p_j0 = s_j * mean(p_0)``, Troje (2002), eq. 12, with positions
        relative to the point of the floor below the pelvis.
        """
        postures = self.part("p0")
        mean = postures[self.in_average].mean(axis=0)
        return _read_only(postures @ mean / (mean @ mean))

    def part(self, name: str) -> np.ndarray:
        """Return some of the features of all walkers, to train a classifier on.

        Parameters
        ----------
        name : str
            ``"all"``, ``"structure"`` (p0), ``"dynamics"`` (p1, p2, ..., phases, frequency),
            ``"p1"``, ``"p1+p2+p3"``, ``"phases"``, ``"frequency"``, or ``"size"``, which is no
            feature but the s_j of eq. 12.

        Returns
        -------
        array of shape (walker, feature)

        Examples
        --------
        >>> people = ew.load_population()
        >>> people.part("structure").shape, people.part("p1+p2").shape, people.part("size").shape
        ((40, 45), (40, 90), (40, 1))
        """
        if name == "size":
            return self.sizes[:, None]
        return self.X[:, self.layout.columns(name)]

    def walker(self, vector: np.ndarray) -> Walker:
        """Return the walker that any point of the feature space describes.

        Parameters
        ----------
        vector : array of shape (feature,)
            Such as ``people.average + 6 * direction``.

        Returns
        -------
        Walker
            Its speed is that of its feet on the ground, times a factor by which the average walker
            has the mean of the walkers' speeds.

        Raises
        ------
        ValueError
            If the vector does not describe anything that could walk.

        Examples
        --------
        >>> people = ew.load_population()
        >>> between = people.walker((people.X[0] + people.X[1]) / 2)
        >>> slower, faster = sorted(walker.frequency_hz for walker in people.walkers[:2])
        >>> slower < between.frequency_hz < faster
        True
        """
        walker = self.layout.walker(vector)
        return replace(walker, speed_mm_s=self.speed_factor * ground_speed(walker))

    @cached_property
    def speed_factor(self) -> float:
        """Mean of the walkers' known speeds over the speed of the average walker's feet, else 1."""
        speeds = np.array([walker.speed_mm_s for walker in self.walkers])[self.in_average]
        known = speeds[np.isfinite(speeds)]
        feet = ground_speed(self.layout.walker(self.average))
        factor = known.mean() / feet if len(known) and feet else np.nan
        return float(factor) if factor > 0 else 1.0

    def vector(self, walker: Walker) -> np.ndarray:
        """Return any walker as a point of this population's feature space: shape (feature,).

        The walker need not belong to the population: it is brought into correspondence first.
        """
        aligned, _, flag = correspond_to(walker, self._correspondence.reference)
        if flag:
            raise ValueError(f"This walker cannot be compared with the population: {flag}")
        return self._unwrapped(self.layout.vector(aligned)[None])[0]

    def hybrid(self, *, structure: np.ndarray, dynamics: np.ndarray) -> np.ndarray:
        """Return the structure of one walker with the dynamics of another: shape (feature,).

        The stimuli of Troje (2002) have size divided out first: ``people.size_normalised()``.

        Parameters
        ----------
        structure, dynamics : array of shape (feature,)
            Vectors of the two walkers; either may be ``people.average``.

        Examples
        --------
        The body of the first walker, moving as walkers do on average:

        >>> people = ew.load_population().size_normalised()
        >>> mixed = people.walker(people.hybrid(structure=people.X[0], dynamics=people.average))
        >>> bool((mixed.p0 == people.walkers[0].p0).all())
        True
        """
        columns = self.layout.columns("structure")
        mixed = check_numbers(dynamics, "dynamics", "feature", least=len(self.layout)).copy()
        structure = check_numbers(structure, "structure", "feature", least=len(self.layout))
        mixed[columns] = structure[columns]
        return mixed

    def size_normalised(self) -> Population:
        """Return the population with the size of each walker divided out: Troje (2002), eq. 12.

        Mean postures, eigenpostures and speed are divided by s_j, frequency and phases are not.
        Correspondence stays as it is.
        """
        walkers = tuple(
            replace(
                walker,
                p0=walker.p0 / size,
                p=walker.p / size,
                speed_mm_s=walker.speed_mm_s / size,
            )
            for walker, size in zip(self.walkers, self.sizes, strict=True)
        )
        return replace(self, walkers=walkers)

    def select(self, rows: Sequence[bool] | Sequence[int] | pd.Series | np.ndarray) -> Population:
        """Return some of the walkers, by a mask or by their numbers; correspondence stays."""
        numbers: list[int] = np.arange(len(self))[np.asarray(rows)].tolist()
        if not numbers:
            raise ValueError("No walker is left; a population needs one or more.")
        before = self._correspondence
        flags = tuple(before.flags[number] for number in numbers)
        return replace(
            self,
            walkers=tuple(self.walkers[number] for number in numbers),
            traits=self.traits.iloc[numbers],
            correspondence=replace(before, similarity=before.similarity[numbers], flags=flags),
        )

    def drop(self, numbers: Iterable[int]) -> Population:
        """Return the population without the walkers of these numbers."""
        return self.select(np.setdiff1d(np.arange(len(self)), list(numbers)))

    def unflagged(self) -> Population:
        """Return the population without flagged walkers."""
        return self.select(~self.flagged)

    def without_flags(self) -> Population:
        """Return the population with its flags removed, so that flagged walkers count too."""
        return replace(self, traits=self.traits.assign(**{FLAG: ""}))

    def with_persons(self, column: str | None) -> Population:
        """Return the population with the column of its traits that names the person of each walk.

        Parameters
        ----------
        column : str or None
            It is called ``person`` from then on. None: every walk counts as of another person.

        Returns
        -------
        Population

        Raises
        ------
        ValueError
            If there is no such column.

        See Also
        --------
        persons : Whom they name.

        Examples
        --------
        >>> people = ew.simulate_population(2, 2, seed=1)
        >>> people = Population(people.walkers, people.traits.assign(who=["a", "a", "b", "b"]))
        >>> people.with_persons("who").persons.tolist()
        ['a', 'a', 'b', 'b']
        """
        return replace(self, traits=name_persons(self.traits, column))

    def add(self, walkers: Sequence[Walker], traits: pd.DataFrame) -> Population:
        """Return the population with more walkers, brought into correspondence with those here.

        The numbers of the walkers that are here do not change.
        """
        if not walkers:
            return self
        check_walkers(walkers)
        before = self._correspondence
        aligned = [correspond_to(walker, before.reference) for walker in walkers]
        traits = check_traits(traits)
        if len(traits) != len(aligned):
            raise ValueError(f"There are {len(aligned)} walkers and {len(traits)} rows of traits.")
        flags = [flag for _, _, flag in aligned]
        traits = traits.assign(**{FLAG: join_flags(flags_of(traits), flags)})
        return replace(
            self,
            walkers=(*self.walkers, *(each for each, _, _ in aligned)),
            traits=pd.concat([self.traits, traits], ignore_index=True),
            correspondence=replace(
                before,
                similarity=np.vstack([before.similarity, *(each for _, each, _ in aligned)]),
                flags=(*before.flags, *flags),
            ),
        )

    def posture_correlations(self) -> pd.DataFrame:
        """Return the mean correlation of each posture over all pairs of unflagged walkers.

        Returns
        -------
        DataFrame of shape (posture, 2)
            Of eigenpostures with only sign and order made to agree, as in Troje (2002), and in
            correspondence.
        """
        walkers = [self.walkers[number] for number in np.flatnonzero(self.in_average).tolist()]
        mean = posture_correlations(np.stack([walker.p0[None] for walker in walkers]))
        eigenpostures = {
            "sign and order": match_sign_and_order(walkers),
            "in correspondence": np.stack([walker.p for walker in walkers]),
        }
        return pd.DataFrame(
            {
                name: np.concatenate([mean, posture_correlations(postures)])
                for name, postures in eigenpostures.items()
            },
            index=[f"p{i}" for i in range(len(walkers[0].p) + 1)],
        )

    def save(self, path: str | Path) -> Path:
        """Write the population to one self-describing NetCDF file, and return its path."""
        from eigenwalker.population.population_file import Stored, write_population

        content = Stored(self.walkers, self.traits, self._correspondence, self.provenance)
        return write_population(content, Path(path))

    @classmethod
    def load(cls, path: str | Path) -> Population:
        """Return the population that `save` wrote.

        Raises
        ------
        UnreadableFile
            If the file holds no population or is damaged.
        """
        from eigenwalker.population.population_file import read_population

        return cls(*read_population(Path(path)))

    @property
    def _correspondence(self) -> Correspondence:
        assert self.correspondence is not None
        return self.correspondence

    @cached_property
    def _phase_centre(self) -> np.ndarray:
        phases = np.stack([walker.phases[1:] for walker in self.walkers])
        return circular_mean(phases[self.in_average])

    def _unwrapped(self, table: np.ndarray) -> np.ndarray:
        if self.layout.form == "eigenposture":
            columns = self.layout.columns("phases")
            table[:, columns] = wrap_phase(table[:, columns], around=self._phase_centre)
        return table


def _summary(values: pd.Series) -> str:
    """Values of a trait in a few words."""
    known = values.dropna()
    if pd.api.types.is_numeric_dtype(known) and not pd.api.types.is_bool_dtype(known):
        if known.empty:
            return ""
        return f"{known.min():.4g} to {known.max():.4g}, mean {known.mean():.4g}"
    counts = known.astype(str).value_counts()
    shown = ", ".join(f"{count} {str(value)[:40]}" for value, count in counts.head(4).items())
    return shown + (f", {len(counts) - 4} others" if len(counts) > 4 else "")


def _read_only(values: np.ndarray) -> np.ndarray:
    values.flags.writeable = False
    return values


def check_population(population: object) -> None:
    """Raise a TypeError unless this is a population."""
    check_kind(population, Population, "a population, as load_population() returns it")


def flags_of(traits: pd.DataFrame) -> list[str]:
    """Return the flag of each row of traits, empty where there is none."""
    flags = traits.get(FLAG, pd.Series("", index=traits.index))
    return flags.fillna("").astype(str).tolist()


def join_flags(*flags: Iterable[str]) -> list[str]:
    """Return the flags of several sources as one for each walker."""
    return [" ".join(filter(None, each)) for each in zip(*flags, strict=True)]
