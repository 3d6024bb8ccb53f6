"""Random numbers that Python and the browser draw alike: sfc32, reached at any place at once.

A stimulus is a function of time, so the random numbers of the seventh life of dot 12 must not
depend on drawing those of the six lives before. Each has a stream of its own, named by four words:
purpose, seed, number of the dot, number of its life. `docs/stimulus-format.md` defines them bit by
bit.
"""

from __future__ import annotations

from enum import IntEnum

import numpy as np
from numpy.typing import ArrayLike

WARM_UP = 20
"""Words dropped before the first is used, so that similar names give different streams."""


class Purpose(IntEnum):
    """The transform that a stream is for: with one seed, two draw different numbers."""

    TEST = 1
    SCRAMBLE = 2
    PHASE_SCRAMBLE = 3
    LIMB_DOTS = 4
    MASK = 5
    START = 6


def random_words(
    purpose: int, seed: int, index: ArrayLike = 0, life: ArrayLike = 0, *, count: int
) -> np.ndarray:
    """Return the first 32-bit words of streams of sfc32 (Doty-Humphrey, PractRand): (..., count).

    Index and life are broadcast against each other and taken modulo 2^32.
    """
    index, life = np.broadcast_arrays(np.atleast_1d(index), np.atleast_1d(life))
    if index.shape == (1,):
        return _words_of_one(purpose, seed, int(index[0]), int(life[0]), count)
    a = np.full(index.shape, seed, dtype=np.uint32)
    b = np.mod(index, 2**32).astype(np.uint32)
    c = np.mod(life, 2**32).astype(np.uint32)
    counter = np.full(index.shape, purpose, dtype=np.uint32)
    words = np.empty((*index.shape, count), dtype=np.uint32)
    for turn in range(-WARM_UP, count):
        word = a + b + counter
        counter = counter + np.uint32(1)
        a = b ^ (b >> np.uint32(9))
        b = c + (c << np.uint32(3))
        c = ((c << np.uint32(21)) | (c >> np.uint32(11))) + word
        if turn >= 0:
            words[..., turn] = word
    return words


def _words_of_one(purpose: int, seed: int, index: int, life: int, count: int) -> np.ndarray:
    """Return the words of one stream, with Python's numbers: ten times as fast as with arrays."""
    mask = 2**32 - 1
    a, b, c, words = seed & mask, index & mask, life & mask, []
    for counter in range(purpose, purpose + WARM_UP + count):
        word = (a + b + counter) & mask
        a = b ^ (b >> 9)
        b = (c + (c << 3)) & mask
        c = (((c << 21) | (c >> 11)) + word) & mask
        words.append(word)
    return np.array(words[WARM_UP:], dtype=np.uint32)


def uniforms(
    purpose: int, seed: int, index: ArrayLike = 0, life: ArrayLike = 0, *, count: int
) -> np.ndarray:
    """Return numbers in [0, 1) of 53 bits, each from two words of a stream: (..., count)."""
    words = random_words(purpose, seed, index, life, count=2 * count)
    high, low = words[..., 0::2] >> np.uint32(5), words[..., 1::2] >> np.uint32(6)
    return (high * 2.0**26 + low) / 2.0**53


def normals(
    purpose: int, seed: int, index: ArrayLike = 0, life: ArrayLike = 0, *, count: int
) -> np.ndarray:
    """Return normally distributed numbers by Box and Muller (1958): (..., count)."""
    drawn = uniforms(purpose, seed, index, life, count=2 * ((count + 1) // 2))
    radius = np.sqrt(-2 * np.log(1 - drawn[..., 0::2]))
    angle = 2 * np.pi * drawn[..., 1::2]
    pairs = np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=-1)
    return pairs.reshape(*drawn.shape[:-1], -1)[..., :count]


def permutation(purpose: int, seed: int, index: int, *, size: int) -> np.ndarray:
    """Return 0, 1, ... size - 1 in random order (Fisher and Yates, from the end)."""
    order = list(range(size))
    drawn = uniforms(purpose, seed, index, count=max(size - 1, 1))
    for last, uniform in zip(range(size - 1, 0, -1), drawn.tolist(), strict=False):
        other = int(uniform * (last + 1))
        order[last], order[other] = order[other], order[last]
    return np.array(order)
