"""Moler's walkers.mat, which is not ours to ship: files made after its layout; mm files."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.io import savemat

from eigenwalker.core import JOINTS, Walker
from eigenwalker.datasets import load_population, read_mm, read_walkers_mat
from eigenwalker.decomposition import decompose_fourier
from eigenwalker.io import UnreadableFile, walker_to_mm

MOLERS_POINTS = [
    *("head", "right_wrist", "right_elbow", "right_shoulder"),
    *("sternum", "left_shoulder", "left_elbow", "left_wrist"),
    *("right_ankle", "right_knee", "right_hip"),
    *("pelvis", "left_hip", "left_knee", "left_ankle"),
]
FREQUENCY_HZ = 120 / 151.5751


def _average(sex: str) -> Walker:
    """The average woman or man of the built-in population, by its first two harmonics."""
    people = load_population()
    rows = people.X[(people.traits["sex"] == sex).to_numpy()]
    walker = people.walker(rows.mean(axis=0))
    time = np.arange(240) / 240 * 2 * walker.period_s
    return decompose_fourier(walker.trajectories(time))


def _as_moler_has_it(walker: Walker) -> np.ndarray:
    """A table as walkers.mat has it, made point by point: x to the right, y forward, z up."""
    postures = [walker.p0, *walker.p]
    table = np.empty((45, 5))
    for column, posture in enumerate(postures):
        for row, name in enumerate(MOLERS_POINTS):
            forward, left, up = posture[walker.markers.index(name)]
            table[[row, 15 + row, 30 + row], column] = -left, forward, up
    return table


@pytest.fixture(scope="module")
def averages() -> dict[str, Walker]:
    return {sex: _average(sex) for sex in ("female", "male")}


@pytest.fixture(scope="module")
def tables(averages) -> dict[str, np.ndarray]:
    return {
        "F": _as_moler_has_it(averages["female"]),
        "M": _as_moler_has_it(averages["male"]),
        "H": np.ones((63, 3)),
    }


def test_the_two_walkers_come_in_our_frame_with_our_names(tmp_path, averages, tables):
    savemat(tmp_path / "walkers.mat", tables, do_compression=True)
    people = read_walkers_mat(tmp_path / "walkers.mat")
    assert people.traits["sex"].tolist() == ["female", "male"]
    assert people.X.shape == (2, 226)
    assert not people.flagged.any()
    assert people.provenance["source"] == "walkers.mat"
    for walker, original in zip(people.walkers, averages.values(), strict=True):
        assert walker.markers == JOINTS.markers
        assert walker.form == "fourier"
        assert walker.frequency_hz == pytest.approx(FREQUENCY_HZ)
        phases = np.linspace(0, 1, 40)
        ours = walker.trajectories(phases / walker.frequency_hz).values
        theirs = original.trajectories(
            original.time_origin_s + phases / original.frequency_hz
        ).values
        moved = ours - theirs
        np.testing.assert_allclose(moved, np.broadcast_to(moved[0, 0], moved.shape), atol=1e-6)


def test_the_walkers_face_forward_stand_on_the_floor_and_go_ahead(tmp_path, averages, tables):
    savemat(tmp_path / "walkers.mat", tables)
    for walker in read_walkers_mat(tmp_path / "walkers.mat").walkers:
        posture = walker.mean_posture
        for part in ("shoulder", "hip", "ankle"):
            left, right = (posture.sel(marker=f"{side}_{part}") for side in ("left", "right"))
            assert left.sel(axis="y") > right.sel(axis="y")
        np.testing.assert_allclose(posture.sel(marker="pelvis").values[:2], 0, atol=1e-6)
        assert 50 < posture.sel(marker="left_ankle", axis="z") < 200
        assert walker.speed_mm_s > 500


@pytest.mark.parametrize(
    ("arrays", "told"),
    [
        ({"F": np.ones((45, 5))}, r"tables F and M of shape \(45, 5\), but got .*'F'"),
        ({"F": np.ones((46, 5)), "M": np.ones((46, 5))}, r"\(46, 5\)"),
        ({"F": np.full((45, 5), np.nan), "M": np.ones((45, 5))}, "not finite or too large"),
        ({"F": np.full((45, 5), 1e9), "M": np.ones((45, 5))}, "not finite or too large"),
    ],
)
def test_other_files_are_refused(tmp_path, arrays, told):
    savemat(tmp_path / "walkers.mat", arrays)
    with pytest.raises(UnreadableFile, match=told):
        read_walkers_mat(tmp_path / "walkers.mat")


def test_files_that_are_no_matlab_files_are_refused(tmp_path):
    (tmp_path / "walkers.mat").write_text("F, M\n")
    with pytest.raises(UnreadableFile, match="a MATLAB file"):
        read_walkers_mat(tmp_path / "walkers.mat")
    (tmp_path / "empty.mat").touch()
    with pytest.raises(UnreadableFile, match="an empty file"):
        read_walkers_mat(tmp_path / "empty.mat")


def test_walkers_in_the_mm_format_are_found_by_their_shape(tmp_path, averages):
    mm = {sex: walker_to_mm(walker) for sex, walker in averages.items()}
    savemat(tmp_path / "mm.mat", {"walkers": mm, "other": np.eye(3)})
    walkers = read_mm(tmp_path / "mm.mat")
    assert sorted(walkers) == ["walkers.female", "walkers.male"]
    for sex, original in averages.items():
        walker = walkers[f"walkers.{sex}"]
        assert walker.frequency_hz == pytest.approx(original.frequency_hz)
        np.testing.assert_allclose(walker.p, original.p, atol=1e-9)


def test_files_without_walkers_in_the_mm_format_are_refused(tmp_path):
    savemat(tmp_path / "mm.mat", {"other": np.eye(3)})
    with pytest.raises(UnreadableFile, match=r"46 rows .* but got \{'other': \(3, 3\)\}"):
        read_mm(tmp_path / "mm.mat")
    savemat(tmp_path / "mm.mat", {"still": np.zeros((46, 5))})
    with pytest.raises(UnreadableFile, match="period"):
        read_mm(tmp_path / "mm.mat")


def test_the_file_is_a_population_to_every_command(tmp_path, tables, run_command):
    savemat(tmp_path / "walkers.mat", tables)
    where = ("--trait", "sex=1", "-o", tmp_path / "s.json")
    assert run_command("stimulus", tmp_path / "walkers.mat", *where)[0] == 0
