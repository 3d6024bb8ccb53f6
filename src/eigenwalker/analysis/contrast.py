"""A trait as a target: the walkers that have it, and their classes or values."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import pandas as pd

from eigenwalker.core.arguments import check_kind
from eigenwalker.population.persons import PERSON
from eigenwalker.population.population import FLAG, Population, check_population
from eigenwalker.population.trait_table import heading_parts, trait_column

_POLES = {
    "age": ("young", "old"),
    "weight": ("light", "heavy"),
    "height": ("short", "tall"),
    "happy": ("sad", "happy"),
    "nervous": ("relaxed", "nervous"),
}
SEX = ("sex", "gender", "geschlecht", "sexe", "sexo")
"""Headings, in small letters, of the trait that is told where none is named."""
_NO_TRAITS = (FLAG, PERSON, "file")


@dataclass(frozen=True, eq=False)
class Contrast:
    """A trait as a classifier or a regression has to predict it.

    Parameters
    ----------
    trait : str
        Its column in the traits.
    rows : array of int of shape (walker,)
        The walkers: unflagged, and with a value of the trait.
    y : array of float of shape (walker,)
        -1 and +1 for two classes, the row vector r of Troje (2002), eq. 10; else the values.
    negative, positive : str
        Names of the two poles.
    two_classes : bool
    persons : array of shape (walker,), or None
        The person of each walk, where some person has several.

    See Also
    --------
    trait_contrast : Makes it.
    """

    trait: str
    rows: np.ndarray
    y: np.ndarray
    negative: str
    positive: str
    two_classes: bool
    persons: np.ndarray | None = None

    @property
    def varies_within_persons(self) -> bool:
        """Whether some person has several values, so that permutations stay within persons."""
        return self.persons is not None and bool((self.values_of_persons() > 1).any())

    def values_of_persons(self) -> pd.Series[int]:
        """Return how many values of the trait each person has."""
        table = pd.DataFrame({"y": self.y, "person": self.persons})
        return table.groupby("person")["y"].nunique()

    @property
    def labels(self) -> np.ndarray:
        """Targets for a discriminant: names of the poles, or the values of the trait."""
        if not self.two_classes:
            return self.y
        return np.where(self.y > 0, self.positive, self.negative)


def trait_contrast(population: Population, trait: str) -> Contrast:
    """Return the walkers with a known trait, and its class or value for each.

    Parameters
    ----------
    population : Population
    trait : str
        A column of the traits, in full (``"weight_kg"``) or without its unit (``"weight"``).
        ``"style=feminine:masculine"`` selects two of the values of a trait; the second is the
        positive pole. Of a trait of two values, the second in sorted order is ("male").

    Returns
    -------
    Contrast

    Raises
    ------
    ValueError
        If there is no such trait, or it is the same for all walkers.

    See Also
    --------
    classify, regress, trait_axis : take a trait in the same words.

    References
    ----------
    Troje (2002), eq. 10: the row vector r.

    Examples
    --------
    >>> sex = trait_contrast(ew.load_population(), "sex")
    >>> sex.positive, len(sex.rows)
    ('male', 40)
    >>> trait_contrast(ew.load_population(), "weight").positive
    'heavy'
    """
    check_population(population)
    name, pair = _parts(trait)
    column = _column(population, name)
    values = population.traits[column]
    if population.flagged.all():
        raise ValueError(
            f"All {len(population)} walkers are flagged, the first because: "
            f"{population.traits[FLAG][0]} To use them all the same, take "
            "population.without_flags()."
        )
    known = values.notna() & (_as_text(values) != "") & ~population.flagged
    if not pair and pd.api.types.is_numeric_dtype(values) and values[known].nunique() > 2:
        return _continuous(population, column, np.flatnonzero(known))
    negative, positive = _poles(column, pair, values[known])
    if pair:
        known &= _as_text(values).isin([negative, positive])
    rows = np.flatnonzero(known)
    y = np.where(_as_text(values.iloc[rows]) == positive, 1.0, -1.0)
    return Contrast(column, rows, y, negative, positive, True, _persons(population, rows))


def usual_trait(population: Population) -> str:
    """Return the trait to tell where none is named: the sex, else the first of two classes."""
    found: dict[str, bool] = {}
    problem = ValueError(f"The population has no trait to tell; it has {list(population.traits)}.")
    for name in (str(name) for name in population.traits if name not in _NO_TRAITS):
        try:
            found[name] = trait_contrast(population, name).two_classes
        except ValueError as error:
            problem = error
    if not found:
        raise problem
    return min(found, key=lambda name: (name.casefold() not in SEX, not found[name]))


def class_labels(
    population: Population, trait: str
) -> tuple[str, np.ndarray, np.ndarray, np.ndarray | None]:
    """Return the column of a trait of several classes, rows that have it, labels and persons.

    ``style=active:normal:elderly`` names some of its classes.
    """
    check_population(population)
    name, some = _parts(trait)
    column = _column(population, name)
    values = _as_text(population.traits[column])
    known = (values != "") & ~population.flagged
    if some:
        wanted = _spelled(some, values[known]).split(":")
        if missing := sorted(set(wanted) - set(values[known])):
            raise ValueError(
                f"{column} has no value {missing[0]!r}; it has {sorted(set(values[known]))}."
            )
        known &= values.isin(wanted)
    rows = np.flatnonzero(known)
    labels = values.iloc[rows].to_numpy(dtype=str)
    if len(set(labels)) < 2:
        raise ValueError(
            f"The trait {column} is the same for all walkers that may be used, so there is nothing "
            "to tell apart."
        )
    return column, rows, labels, _persons(population, rows)


def _parts(trait: object) -> tuple[str, str]:
    """Return the name of a trait, and the classes that are named of it."""
    check_kind(trait, str, "the name of a trait")
    name, _, classes = str(trait).partition("=")
    return name, classes


def _spelled(classes: str, known: Iterable[str]) -> str:
    """Return classes joined by colons as they are spelled, where another case means one alone."""
    words = Counter(word.casefold() for word in set(known))
    spelled = {word.casefold(): word for word in known if words[word.casefold()] == 1}
    return ":".join(spelled.get(word.casefold(), word) for word in classes.split(":"))


def has_several_classes(population: Population, trait: str) -> bool:
    """Return whether a trait, or what is named of its values, is three classes or more of text."""
    check_population(population)
    name, some = _parts(trait)
    values = population.traits[_column(population, name)]
    known = set(_as_text(values[~population.flagged])) - {""}
    if some:
        named = _spelled(some, known).split(":")
        return len(named) > 2 and set(named) <= known
    is_text = not pd.api.types.is_numeric_dtype(values) or pd.api.types.is_bool_dtype(values)
    return is_text and 2 < len(known) <= len(values) / 2


def _as_text(values: pd.Series) -> pd.Series:
    """Values as a user types them: 1 for 1.0, and nothing for a missing one."""
    if not pd.api.types.is_numeric_dtype(values) or pd.api.types.is_bool_dtype(values):
        return values.fillna("").astype(str)
    return values.map(lambda value: "" if pd.isna(value) else f"{value:.15g}")


def _column(population: Population, name: str) -> str:
    traits = population.traits
    return trait_column(traits.drop(columns=[c for c in _NO_TRAITS if c in traits]), name)


def _poles(column: str, pair: str, values: pd.Series) -> tuple[str, str]:
    """The negative and the positive value: those of ``negative:positive``, or the only two."""
    known = _as_text(values.drop_duplicates().sort_values()).tolist()
    if pair:
        parts = _spelled(pair, known).split(":")  # values may themselves hold a colon
        splits = [(":".join(parts[:i]), ":".join(parts[i:])) for i in range(1, len(parts))]
        poles = next((each for each in splits if set(each) <= set(known)), ("", ""))
        if poles[0] == poles[1]:
            raise ValueError(
                f"{pair!r} does not name two values of {column}; it has {known}. "
                f"Write, for instance, {column}={known[0]}:{known[-1]}."
            )
        return poles
    if len(known) < 2:
        raise ValueError(
            f"The trait {column} is the same, {known}, for all walkers that may be used, so there "
            "is nothing to tell apart."
        )
    if len(known) > 2:
        raise ValueError(
            f"The trait {column} has {len(known)} values, {known}; choose two, for instance "
            f"{column}={known[0]}:{known[1]}."
        )
    return known[0], known[1]


def _continuous(population: Population, column: str, rows: np.ndarray) -> Contrast:
    y = population.traits[column].to_numpy(dtype=float)[rows]
    if np.isinf(y).any():
        raise ValueError(f"The trait {column} is infinite for some walkers; leave it empty there.")
    stem = heading_parts(column)[0].casefold().split("_")[0]
    negative, positive = _POLES.get(stem, (f"low {column}", f"high {column}"))
    return Contrast(column, rows, y, negative, positive, False, _persons(population, rows))


def _persons(population: Population, rows: np.ndarray) -> np.ndarray | None:
    if population.persons is None:
        return None
    # Each walk of an unnamed person counts as a person of its own.
    persons = np.array([name or f"\0{row}" for row, name in enumerate(population.persons)])[rows]
    return persons if len(set(persons)) < len(persons) else None
