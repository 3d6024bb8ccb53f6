"""Checks of what a public function is given: what was expected, and what was given instead."""

from __future__ import annotations

from collections.abc import Iterable, Sequence, Sized
from numbers import Real
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

LARGEST = 1e60
"""Size of a number up to which its fourth power, and sums of them, are finite."""


def described(value: Any) -> str:
    """Return what an argument is, in a few words."""
    if isinstance(value, str) or hasattr(value, "__fspath__"):
        return f"the text {str(value)[:60]!r}"
    if value is None or isinstance(value, Real):
        return repr(value)[:60]
    kind = type(value).__name__.removeprefix("nd")
    article = "an" if kind[:1] in "AEIOaeio" else "a"
    if hasattr(value, "dtype") and hasattr(value, "shape"):
        return f"{article} {kind} of {value.dtype} of shape {value.shape}"
    size = f" of {len(value)}" if isinstance(value, Sized) else ""
    return f"{article} {kind}{size}"


def check_kind(value: object, kind: type[Any] | tuple[type[Any], ...], expected: str) -> None:
    """Raise a TypeError that says what was expected and what came, unless a value is of a kind."""
    if not isinstance(value, kind):
        raise TypeError(f"Expected {expected}, got {described(value)}.")


def check_choice(value: object, known: Iterable[object], name: str) -> None:
    """Raise a ValueError that lists what is known, unless a value is."""
    choices = list(known)
    if not any(value is each or (type(value) is type(each) and value == each) for each in choices):
        few = len(choices) < 4 and " or ".join(map(repr, choices))
        raise ValueError(f"{name}={value!r} is not known; give {few or f'one of {choices}'}.")


def check_numbers(
    values: ArrayLike,
    name: str,
    *dims: str,
    missing: bool = False,
    least: int = 1,
    columns: Sequence[Any] | None = None,
) -> np.ndarray:
    """Return an argument as an array of float64 of these dimensions; any, where none are named.

    Refused are other shapes, fewer than `least` along the first dimension, what is no real number,
    infinity, numbers beyond `LARGEST`, and NaN unless samples may be `missing`; the first of these
    is named by its place, in a table with the names of its `columns`.
    """
    shape = f" of shape ({', '.join(dims)}{',' * (len(dims) == 1)})" if dims else ""
    expected = f"{name} must be real numbers{shape}"
    array = as_floats(values, expected)
    few = array.size < least if not array.ndim else len(array) < least or (least and not array.size)
    if few or (dims and array.ndim != len(dims)):
        more = f", {least} or more of the first" if least > 1 else ""
        raise ValueError(f"{expected}{more}; got shape {array.shape}.")
    if not array.size or max(array.max(), -array.min()) <= LARGEST:  # NaN is not
        return array
    sizes = np.abs(array)
    largest = float(sizes.max(initial=0, where=~np.isnan(sizes)))
    if largest > LARGEST:
        number = "infinity" if np.isinf(largest) else f"{largest:.4g}"
        place = _first_place(sizes == largest, columns)
        raise ValueError(f"{expected}, finite and up to {LARGEST:g} in size; got {number}{place}.")
    if not missing and (n_missing := int(np.isnan(sizes).sum())):
        place = _first_place(np.isnan(sizes), columns).replace(" ", ", the first ", 1)
        raise ValueError(f"{expected}, and {n_missing} of {array.size} are missing (NaN){place}.")
    return array


def _first_place(which: np.ndarray, columns: Sequence[Any] | None) -> str:
    """Return where in an argument the first of these is, counted from 0, in words."""
    place = np.argwhere(which)[0].tolist()
    if len(place) == 2:
        column = place[1] if columns is None else repr(columns[place[1]])[:60]
        return f" in row {place[0]}, column {column} (counted from 0)"
    return f" at index {str(place).strip('[]')} (counted from 0)" if place else ""


def check_whole(values: ArrayLike, name: str, *dims: str) -> np.ndarray:
    """Return an argument as an array of int of these dimensions; refuse what is not whole."""
    array = check_numbers(values, name, *dims)
    with np.errstate(invalid="ignore"):  # numbers beyond those of an int are refused below
        whole = array.astype(int)
    if (broken := array[whole != array]).size:
        raise ValueError(f"{name} must be whole numbers; got {broken[0]:g}.")
    return whole


def check_labels(values: ArrayLike, name: str) -> np.ndarray:
    """Return an argument of words or numbers, one each, as an array of one dimension."""
    try:
        labels = np.asarray(values)
    except (ValueError, TypeError):
        labels = np.empty((0, 0))
    if labels.ndim != 1 or not labels.size or labels.dtype.kind not in "OUSTfiub":
        raise TypeError(
            f"{name} must be words or numbers, of which there is one or more in a row; got "
            f"{described(values)}."
        )
    if labels.dtype.kind == "f":
        check_numbers(labels, name, missing=True)
    return as_floats(labels, name) if labels.dtype == np.longdouble else labels


def generator(seed: Any, name: str = "random_state", *stream: int) -> np.random.Generator:
    """Return a generator, or the one of a seed; with `stream`, one of several of that seed."""
    try:
        return np.random.default_rng([*np.atleast_1d(seed).tolist(), *stream] if stream else seed)
    except (ValueError, TypeError) as error:
        raise type(error)(f"{name}={seed!r:.60} is no seed; give a whole number from 0.") from error


def as_floats(values: ArrayLike, expected: str) -> np.ndarray:
    """Return real numbers as float64; raise a TypeError if they are something else."""
    try:
        array = np.asarray(values)
    except (ValueError, TypeError) as error:
        raise TypeError(f"{expected}; got rows of different length.") from error
    objects = array.dtype.kind == "O" and all(isinstance(each, Real) for each in array.flat)
    if array.dtype.kind not in "fiub" and not objects:
        what = f"{described(values)}, with other things than numbers"
        raise TypeError(
            f"{expected}; got {what if isinstance(values, list) else described(values)}."
        )
    try:
        with np.errstate(over="ignore"):  # of longer floats: they become infinite
            return array.astype(float, copy=False)
    except OverflowError:  # of whole numbers
        return np.full(array.shape, np.inf)
