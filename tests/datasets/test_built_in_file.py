"""The built-in people as they ship: those that this very code makes, or none."""

from dataclasses import fields

import numpy as np
import pytest

from eigenwalker.datasets import built_in, code_hash, load_population
from eigenwalker.datasets.built_in_file import read_people, write_people
from eigenwalker.decomposition import decompose_pca
from eigenwalker.gait import in_place
from eigenwalker.markers import virtual_markers
from eigenwalker.simulation import simulate_population, simulate_walk, truth_of


@pytest.fixture(scope="module")
def few():
    return simulate_population(2, 1, seed=5, duration_s=3)


def test_people_are_read_as_they_were_written_to_the_last_bit(few, tmp_path):
    read = read_people(write_people(few, tmp_path / "people.npz", built="here"))
    for walker, other in zip(few.walkers, read.walkers, strict=True):
        for one, two in ((walker, other), (walker.fit, other.fit)):
            for field in fields(one):
                if field.name != "fit":
                    assert np.array_equal(getattr(one, field.name), getattr(two, field.name))
    assert np.array_equal(few.X, read.X)
    assert few.traits.equals(read.traits)
    assert few.correspondence.flags == read.correspondence.flags
    assert read.provenance.items() > few.provenance.items()
    assert truth_of(read).seeds == truth_of(few).seeds


def test_built_in_people_are_those_that_this_code_makes():
    people = load_population()
    assert len(people) == 40
    truth = truth_of(people)
    for number in (0, 39):
        capture = simulate_walk(
            truth.people.iloc[number], seed=truth.seeds[number], **truth.capture
        )
        walker = decompose_pca(in_place(virtual_markers(capture)))
        np.testing.assert_allclose(people.vector(walker), people.X[number], rtol=1e-6, atol=1e-4)


def test_the_population_says_where_it_comes_from():
    provenance = load_population().provenance
    assert provenance["simulated"] == "20 women and 20 men who do not exist, seed 0"
    if code_hash.people_file().exists():
        assert provenance["built"].endswith(code_hash.code_hash()[:16])
        assert len(provenance["sha256"]) == 64


def test_other_code_does_not_find_the_people_and_simulates_them(few, tmp_path, monkeypatch):
    package = tmp_path / "eigenwalker"
    for room in ("simulation", "datasets"):
        (package / room).mkdir(parents=True)
    numbers = package / "simulation" / "people.toml"
    monkeypatch.setattr(code_hash, "_PACKAGE", package)
    monkeypatch.setattr(code_hash, "_DATASETS", package / "datasets")
    hashes = set()
    for content in (b"sd = 1\n", b"sd = 2\n"):
        numbers.write_bytes(content)
        hashes.add(code_hash.code_hash())
    numbers.write_bytes(b"sd = 2\r\n")  # as a checkout on Windows may have it
    assert len(hashes) == 2
    assert code_hash.code_hash() in hashes
    monkeypatch.setattr(built_in, "simulate_built_in", lambda: few)
    monkeypatch.setattr(built_in, "people_file", code_hash.people_file)
    assert built_in._built_in.__wrapped__() is few
