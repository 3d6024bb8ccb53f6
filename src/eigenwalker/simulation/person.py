"""The parameters of a simulated person, each with its mean, its spread and their source."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable, Mapping
from importlib.resources import files
from types import MappingProxyType
from typing import Any, NamedTuple


class Parameter(NamedTuple):
    """One number in which simulated people differ.

    Attributes
    ----------
    female, male : float
        Means of the sexes.
    sd : float
        Standard deviation within a sex.
    source : str
        Publication that these come from.

    See Also
    --------
    PARAMETERS : all of them.
    """

    female: float
    male: float
    sd: float
    source: str


PEOPLE: dict[str, Any] = tomllib.loads(
    (files("eigenwalker.simulation") / "people.toml").read_text(encoding="utf-8")
)


def _parameter(source: str, **numbers: float) -> Parameter:
    for short, full in PEOPLE["sources"].items():
        source = source.replace(short, full)
    return Parameter(source=source, **numbers)


PARAMETERS: Mapping[str, Parameter] = MappingProxyType(
    {name: _parameter(**entry) for name, entry in PEOPLE["parameters"].items()}
)
"""All parameters: shares of height, factors of the norm, lags in strides."""


def average_person() -> dict[str, float]:
    """Return the parameters of the person halfway between the average woman and man.

    Returns
    -------
    dict of str to float
        For `simulate_walk`.

    See Also
    --------
    draw_people : people who differ.

    References
    ----------
    Of each number: `Parameter.source`.

    Examples
    --------
    >>> average_person()["height_mm"]
    1693.0
    """
    return {name: (p.female + p.male) / 2 for name, p in PARAMETERS.items()}


def check_parameters(names: Iterable[str]) -> None:
    """Refuse names that are no parameters of a simulated person."""
    if unknown := sorted(set(names) - set(PARAMETERS)):
        raise ValueError(f"A person has no {unknown}; parameters are {sorted(PARAMETERS)}.")
