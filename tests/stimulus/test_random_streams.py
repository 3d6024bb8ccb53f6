"""Random numbers: against a plain reading of the generator, and as chance should be."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given, strategies as st
from scipy import stats

from eigenwalker.stimulus.random_streams import normals, permutation, random_words, uniforms

WORD = st.integers(0, 2**32 - 1)


def sfc32(a: int, b: int, c: int, counter: int, count: int) -> list[int]:
    """The generator as its author wrote it, one word after the other, in whole numbers."""
    words = []
    for _ in range(20 + count):
        word = (a + b + counter) % 2**32
        counter = (counter + 1) % 2**32
        a = b ^ (b >> 9)
        b = (c + (c << 3)) % 2**32
        c = (((c << 21) | (c >> 11)) + word) % 2**32
        words.append(word)
    return words[20:]


@given(purpose=WORD, seed=WORD, index=WORD, life=WORD)
def test_words_are_those_of_sfc32(purpose, seed, index, life):
    drawn = random_words(purpose, seed, index, life, count=5).tolist()
    assert drawn == sfc32(seed, index, life, purpose, 5)


@given(seed=WORD, lives=st.lists(WORD, min_size=2, max_size=6))
def test_a_place_is_reached_without_those_before_it(seed, lives):
    together = uniforms(1, seed, 3, np.array(lives), count=2)
    alone = [uniforms(1, seed, 3, life, count=2).tolist() for life in lives]
    assert together.tolist() == alone


def test_one_changed_bit_of_a_name_changes_half_of_the_words():
    rng = np.random.default_rng(0)
    for place in range(4):
        changed = []
        for bit in range(32):
            name = rng.integers(0, 2**32, 4, dtype=np.uint64).tolist()
            other = list(name)
            other[place] ^= 1 << bit
            words = [random_words(*n, count=8).astype(np.uint64) for n in (name, other)]
            changed.append(sum(int(x).bit_count() for x in words[0] ^ words[1]) / 256)
        assert 0.4 < min(changed) < max(changed) < 0.6


def test_first_numbers_of_neighbouring_streams_are_uniform_and_independent():
    drawn = uniforms(4, 7, np.arange(4000), 0, count=2)
    assert stats.kstest(drawn[:, 0], "uniform").pvalue > 1e-3
    assert abs(np.corrcoef(drawn[:-1, 0], drawn[1:, 0])[0, 1]) < 0.05
    assert abs(np.corrcoef(drawn.T)[0, 1]) < 0.05


def test_uniform_numbers_have_53_bits_and_stay_below_1():
    words = random_words(1, 5, 9, 2, count=2).tolist()
    expected = math.ldexp((words[0] >> 5) * 2**26 + (words[1] >> 6), -53)
    assert uniforms(1, 5, 9, 2, count=1)[0] == expected
    assert (2**27 - 1) * 2**26 + 2**26 - 1 < 2**53


def test_normal_numbers_are_normal():
    drawn = normals(1, 2, np.arange(3000), 0, count=3)
    assert stats.kstest(drawn.ravel(), "norm").pvalue > 1e-3


@given(seed=WORD, size=st.integers(1, 40))
def test_a_permutation_holds_each_number_once(seed, size):
    assert sorted(permutation(2, seed, 0, size=size).tolist()) == list(range(size))


def test_all_orders_of_three_are_as_likely():
    orders = [tuple(permutation(2, seed, 0, size=3).tolist()) for seed in range(3000)]
    counts = [orders.count(order) for order in set(orders)]
    assert len(counts) == 6
    assert stats.chisquare(counts).pvalue > 1e-3
