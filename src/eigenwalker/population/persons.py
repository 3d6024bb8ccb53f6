"""Whose walk each one is: the column of a traits table that names the person."""

from __future__ import annotations

import re

import numpy as np
import pandas as pd

PERSON = "person"
"""Column of the traits that names the person of each walk, where nobody says another."""
_PERSONS = (
    *("person", "subject", "subj", "participant", "proband", "probanden", "patient", "volunteer"),
    *("performer", "actor", "individual", "walker", "versuchsperson", "vp", "teilnehmer"),
    *("participante", "sujet", "sujeto", "soggetto", "pid", "sub"),
)
"""Words for a person in headings, the surest first."""
_NUMBERS = ("id", "ids", "no", "nr", "num", "number", "nummer", "code", "key")
"""What may stand beside them."""
_LEAST_PERSONS = 5


def person_column(traits: pd.DataFrame) -> str | None:
    """Return the column of a traits table that says who walked, by its heading.

    A heading is one of the words for a person (``Person``, ``subject``, ``participant_id``,
    ``Proband``; any case). ``ID`` alone is one where its values repeat: a person then has several
    walks. Of several such columns one that repeats is taken before one that does not.

    Parameters
    ----------
    traits : DataFrame of shape (walker, trait)

    Returns
    -------
    str or None
        None if there is none.

    See Also
    --------
    Population.with_persons : Decides it.

    Examples
    --------
    >>> person_column(pd.DataFrame({"sex": ["f", "f", "m"], "Subject ID": [1, 1, 2]}))
    'Subject ID'
    """
    if PERSON in traits:
        return PERSON
    ranked = [(rank, str(name)) for name in traits if (rank := _rank(str(name))) is not None]
    names = [name for _, name in sorted(ranked)]
    repeating = [name for name in names if _named(traits[name]).duplicated().any()]
    sure = [name for rank, name in sorted(ranked) if rank < len(_PERSONS)]
    return next(iter(repeating + sure), None)


def persons_of(traits: pd.DataFrame) -> np.ndarray | None:
    """Return the person of each walk as text, empty where unknown; None without such a column."""
    column = person_column(traits)
    return None if column is None else _texts(traits[column]).to_numpy(dtype=str)


def name_persons(traits: pd.DataFrame, column: str | None) -> pd.DataFrame:
    """Return traits whose column ``person`` is the one named; empty for None or "none"."""
    if column is None or (column not in traits and column.lower() == "none"):
        return traits.assign(**{PERSON: ""})
    if column not in traits:
        same = [str(name) for name in traits if str(name).casefold() == column.casefold()]
        if len(same) == 1:
            return name_persons(traits, same[0])
        names = [str(name) for name in traits if name not in ("file", "flag")]
        known = f"there are {names}" if names else "nothing but their files is known of the walks"
        raise ValueError(f"There is no column {column!r} to name persons; {known}.")
    if column == PERSON:
        return traits
    return traits.drop(columns=PERSON, errors="ignore").rename(columns={column: PERSON})


def columns_like_persons(traits: pd.DataFrame) -> list[str]:
    """Return columns whose heading says nothing, but whose values repeat as persons' do.

    Five values or more, none of more than a quarter of the walks, two walks for each on average,
    within which another trait of few values is always the same.
    """
    few = [name for name in traits if 1 < _named(traits[name]).nunique() <= _LEAST_PERSONS]
    return [
        str(name)
        for name in traits
        if name not in ("file", "flag", PERSON)
        and _repeats_as_persons(_named(traits[name]))
        and any(_constant_within(traits[name], traits[other]) for other in few)
    ]


def _rank(heading: str) -> int | None:
    """Return how sure it is, 0 the surest, that a heading names a person; None if it does not."""
    spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", heading)
    words = re.findall(r"[^\W\d_]+", spaced.casefold())
    rest = [word for word in words if word not in _NUMBERS]
    if not rest and "id" in words:
        return len(_PERSONS)
    if len(rest) != 1:
        return None
    word = rest[0] if rest[0] in _PERSONS else rest[0].removesuffix("s")
    return _PERSONS.index(word) if word in _PERSONS else None


def _texts(values: pd.Series) -> pd.Series:
    """Return the persons as text: 1 for 1.0, and nothing for who is unknown."""
    if pd.api.types.is_numeric_dtype(values) and not pd.api.types.is_bool_dtype(values):
        return values.map(lambda value: "" if pd.isna(value) else f"{value:.15g}")
    return values.fillna("").astype(str).str.strip()


def _named(values: pd.Series) -> pd.Series:
    texts = _texts(values)
    return texts[texts != ""]


def _repeats_as_persons(persons: pd.Series) -> bool:
    counts = persons.value_counts()
    return (
        len(counts) >= _LEAST_PERSONS
        and counts.mean() >= 2
        and counts.max() <= max(len(persons) / 4, 2)
    )


def _constant_within(persons: pd.Series, trait: pd.Series) -> bool:
    values = _texts(trait)
    return bool((values.groupby(_texts(persons)).nunique() == 1).all())
