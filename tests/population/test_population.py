"""Populations: tables of features, size, parts, one file."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pandas as pd
import pytest
import xarray as xr
from scipy.io import netcdf_file

import eigenwalker as ew
from eigenwalker.decomposition import decompose_fourier, decompose_pca
from eigenwalker.gait import in_place
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.population.population import FLAG, Population
from eigenwalker.simulation import simulate_captures


@pytest.fixture(scope="module")
def captures() -> list[tuple[xr.DataArray, pd.Series]]:
    return list(simulate_captures(6, 6, seed=3, truth=False))


@pytest.fixture(scope="module")
def walks(captures) -> list[xr.DataArray]:
    return [in_place(capture) for capture, _ in captures]


@pytest.fixture(scope="module")
def people(captures, walks) -> Population:
    traits = pd.DataFrame([person for _, person in captures]).reset_index(drop=True)
    traits = traits.infer_objects()[["sex", "age_years", "weight_kg", "height_mm"]]
    return Population([decompose_pca(walk) for walk in walks], traits)


def test_built_in_population_is_the_papers_in_size() -> None:
    people = ew.load_population()
    assert people.X.shape == (40, 229)
    assert people.traits["sex"].value_counts().to_dict() == {"female": 20, "male": 20}
    assert not people.flagged.any()


def test_size_is_the_least_squares_factor_of_equation_12(people) -> None:
    mean = people.part("p0").mean(axis=0)
    for size, posture in zip(people.sizes, people.part("p0"), strict=True):
        oracle = np.linalg.lstsq(mean[:, None], posture, rcond=None)[0]
        assert size == pytest.approx(oracle[0])
    assert people.sizes.mean() == pytest.approx(1)


def test_normalising_size_divides_postures_and_nothing_else(people) -> None:
    normal = people.size_normalised()
    for part in ("p0", "p1", "p4"):
        np.testing.assert_allclose(normal.part(part) * people.sizes[:, None], people.part(part))
    for part in ("frequency", "phases"):
        np.testing.assert_allclose(normal.part(part), people.part(part))
    np.testing.assert_allclose(normal.sizes, 1, atol=0.01)


def test_a_vector_walks_as_its_walker_does(people) -> None:
    times = np.linspace(0, 2, 30)
    for number in (0, 7):
        walker = people.walkers[number]
        np.testing.assert_allclose(
            people.walker(people.X[number]).trajectories(times),
            replace(walker, time_origin_s=0).trajectories(times),
            atol=1e-9,
        )


def test_a_walker_of_ones_own_finds_its_place(people, walks) -> None:
    np.testing.assert_allclose(people.vector(decompose_pca(walks[4])), people.X[4], atol=1e-6)
    with pytest.raises(ValueError, match="decompose it the same way"):
        people.vector(decompose_fourier(walks[4]))


def test_half_way_between_two_walkers_lies_half_way(people) -> None:
    morph = people.walker((people.X[1] + people.X[2]) / 2)
    np.testing.assert_allclose(
        morph.p0, (people.walkers[1].p0 + people.walkers[2].p0) / 2, atol=1e-9
    )


def test_hybrids_have_the_structure_of_one_and_the_dynamics_of_another(people) -> None:
    mixed = people.walker(people.hybrid(structure=people.X[0], dynamics=people.X[9]))
    np.testing.assert_array_equal(mixed.p0, people.walkers[0].p0)
    np.testing.assert_array_equal(mixed.p, people.walkers[9].p)
    assert mixed.frequency_hz == people.walkers[9].frequency_hz


@pytest.mark.parametrize("decompose", [decompose_pca, decompose_fourier])
def test_a_saved_population_comes_back_as_it_was(decompose, tmp_path) -> None:
    captures = list(simulate_captures(3, 3, seed=1))
    traits = pd.DataFrame([person for _, person in captures]).reset_index(drop=True)
    traits = traits.infer_objects().assign(
        note=["a/b", "", "ünïcode", "x" * 300, None, "5"], **{"odd / name": np.arange(6)}
    )
    before = Population(
        [decompose(walk) for walk, _ in captures], traits, provenance={"source": "a test"}
    )
    before.save(tmp_path / "people.nc")
    after = Population.load(tmp_path / "people.nc")
    np.testing.assert_array_equal(after.X, before.X)
    assert after.feature_names == before.feature_names
    assert after.provenance == before.provenance
    assert list(after.traits) == list(before.traits)
    assert after.traits["note"].tolist() == ["a/b", "", "ünïcode", "x" * 300, "", "5"]
    np.testing.assert_array_equal(after.posture_correlations(), before.posture_correlations())
    for one, other in zip(before.walkers, after.walkers, strict=True):
        assert one.time_origin_s == other.time_origin_s
        assert one.fit is not None
        assert other.fit is not None
        assert one.fit.fourier_r2 == other.fit.fourier_r2
        np.testing.assert_array_equal(one.fit.variance_share, other.fit.variance_share)
    assert [path.name for path in tmp_path.iterdir()] == ["people.nc"]


@pytest.mark.parametrize("share", [0.0, 0.1, 0.5, 0.9, 0.99])
def test_a_population_file_cut_short_is_refused(people, tmp_path, share) -> None:
    people.save(tmp_path / "whole.nc")
    content = (tmp_path / "whole.nc").read_bytes()
    cut = tmp_path / "cut.nc"
    cut.write_bytes(content[: int(share * len(content))])
    with pytest.raises(UnreadableFile, match=r"cut\.nc: expected a population file"):
        Population.load(cut)


def test_files_that_hold_no_population_are_refused(tmp_path) -> None:
    with pytest.raises(UnreadableFile, match="nothing of that name"):
        Population.load(tmp_path / "none.nc")
    (tmp_path / "text.nc").write_text("file,sex\n")
    with pytest.raises(UnreadableFile, match="eigenwalker fit"):
        Population.load(tmp_path / "text.nc")
    xr.Dataset({"x": ("time", [1.0])}).to_netcdf(tmp_path / "other.nc", engine="scipy")
    with pytest.raises(UnreadableFile, match="expected a population file"):
        Population.load(tmp_path / "other.nc")


def test_a_population_of_a_newer_version_asks_for_an_update(people, tmp_path) -> None:
    people.save(tmp_path / "new.nc")
    with netcdf_file(tmp_path / "new.nc", "a") as file:
        file.format_version = 99
    with pytest.raises(UnreadableFile, match=r"version 99; update eigenwalker"):
        Population.load(tmp_path / "new.nc")


@pytest.mark.parametrize(
    ("name", "spoil", "said"),
    [
        ("harmonics", lambda values: values * 0 + 1, "not 1, 1, 2, 2"),
        ("reference_axes", lambda values: values * np.nan, "reference_axes must"),
        ("phases", lambda values: values + 1, "first phase"),
        ("fit_fourier", lambda values: values * np.inf, "fit_fourier must"),
        ("frequency_hz", lambda values: values * 0, "must be above 0"),
    ],
)
def test_a_population_file_with_a_spoilt_part_is_refused(
    people, tmp_path, name, spoil, said
) -> None:
    path = tmp_path / "people.nc"
    people.save(path)
    with warnings.catch_warnings(), netcdf_file(path, "a", mmap=False) as file:
        warnings.simplefilter("ignore")
        variable = file.variables[name]
        variable[:] = spoil(variable[:].copy())
    with pytest.raises(UnreadableFile, match=said):
        Population.load(path)


@pytest.mark.parametrize("number", [np.inf, -np.inf, 1e300])
def test_traits_that_no_statistics_can_be_made_of_are_refused(people, tmp_path, number) -> None:
    traits = people.traits.assign(age_years=20.0)
    traits.loc[1, "age_years"] = number
    said = "trait 'age_years' of row 2 is"
    with pytest.raises(ValueError, match=said):
        Population(people.walkers, traits)
    path = replace(people, traits=people.traits.assign(age_years=20.0)).save(tmp_path / "people.nc")
    with warnings.catch_warnings(), netcdf_file(path, "a", mmap=False) as file:
        warnings.simplefilter("ignore")
        (column,) = [
            each for each in file.variables.values() if getattr(each, "trait", b"") == b"age_years"
        ]
        column[1] = number
    with pytest.raises(UnreadableFile, match=said):
        Population.load(path)


def test_selecting_and_adding_keep_the_numbers_of_those_who_stay(people) -> None:
    fewer = people.drop([0, 5])
    np.testing.assert_allclose(fewer.part("p1"), np.delete(people.part("p1"), [0, 5], axis=0))
    newcomers = [people.walkers[0], people.walkers[5]]
    more = fewer.add(newcomers, people.traits.iloc[[0, 5]])
    np.testing.assert_allclose(more.part("p1")[:10], fewer.part("p1"))
    np.testing.assert_allclose(more.part("p1")[10:], people.part("p1")[[0, 5]], atol=1e-6)
    assert more.traits["sex"].tolist() == [*fewer.traits["sex"], *people.traits["sex"].iloc[[0, 5]]]


def test_flagged_walkers_stay_but_shape_no_average(people, walks) -> None:
    noise = np.random.default_rng(0).normal(scale=800, size=walks[0].shape)
    strange = decompose_pca((walks[0] + noise).assign_attrs(units="mm"))
    walkers = [*(decompose_pca(walk) for walk in walks), strange]
    traits = pd.concat([people.traits, people.traits[:1]], ignore_index=True)
    flags = [""] * 12 + ["said by the quality report"]
    together = Population(walkers, traits.assign(**{FLAG: flags}))
    assert together.flagged.tolist() == [False] * 12 + [True]
    np.testing.assert_allclose(together.average, people.average, atol=1e-6)
    np.testing.assert_allclose(together.sizes[:12], people.sizes)
    assert len(together.unflagged()) == 12


def test_no_one_can_change_the_table_by_accident(people) -> None:
    for table in (people.X, people.average, people.sizes):
        with pytest.raises(ValueError, match="read-only"):
            table[0] = 1e9


def test_as_many_traits_as_walkers_are_asked_for(people) -> None:
    with pytest.raises(ValueError, match="12 walkers and 11 rows"):
        Population(people.walkers, people.traits.iloc[:11])


@pytest.mark.parametrize(
    ("content", "came"),
    [
        (b"\x89HDF\r\n\x1a\n" + bytes(99), "a NetCDF-4 or HDF5 file"),
        (None, "a NetCDF file that holds no walkers of eigenwalker"),
        (b"Dear colleague", 'a text that begins with "Dear colleague"'),
    ],
)
def test_what_is_no_population_is_called_what_it_is(tmp_path, content, came):
    path = tmp_path / "weather.nc"
    if content is None:
        xr.Dataset({"t2m": ("time", np.zeros(3))}).to_netcdf(path, engine="scipy")
    else:
        path.write_bytes(content)
    with pytest.raises(UnreadableFile) as refusal:
        Population.load(path)
    assert str(refusal.value) == (
        f"weather.nc: expected a population file, but got {came}; make one with 'eigenwalker fit' "
        "or Population.save."
    )


def test_the_average_walker_has_the_mean_speed_of_the_walkers():
    people = ew.simulate_population(3, 3, seed=5)
    speeds = [walker.speed_mm_s for walker in people.walkers]
    assert people.walker(people.average).speed_mm_s == pytest.approx(np.mean(speeds), rel=1e-9)
    flagged = people.traits.assign(flag=["", "wrong joints", "", "", "", ""])
    some = ew.Population(people.walkers, flagged)
    others = np.delete(speeds, 1)
    assert some.walker(some.average).speed_mm_s == pytest.approx(others.mean(), rel=1e-9)
