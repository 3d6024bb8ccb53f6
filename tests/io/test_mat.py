"""MATLAB files: what is in them, in a child process that may die, hang or want too much."""

from __future__ import annotations

import struct
import subprocess
import sys
import zlib

import h5py
import numpy as np
import pytest
from scipy.io import savemat

from eigenwalker.core.trajectories import sampling_rate
from eigenwalker.io.errors import UnreadableFile
from eigenwalker.io.read import read_mocap
from eigenwalker.io.readers.mat import read_mat, read_mat_arrays
from eigenwalker.io.readers.mat_arrays import mat_arrays

NAMES = ["head", "left_ankle"]


@pytest.fixture
def walk() -> np.ndarray:
    return np.random.default_rng(0).normal(size=(7, 2, 3))


@pytest.mark.parametrize("options", [{}, {"do_compression": True}, {"format": "4"}])
def test_arrays_come_back_by_name(tmp_path, options):
    arrays = {"F": np.arange(6.0).reshape(2, 3), "counts": np.array([[1, 2, 3]])}
    savemat(tmp_path / "a.mat", arrays, **options)
    found = read_mat_arrays(tmp_path / "a.mat")
    for name, array in arrays.items():
        np.testing.assert_array_equal(found[name], array)


def test_fields_of_structs_are_found_and_texts_are_not(tmp_path):
    inner = {"pos": np.eye(3), "deep": {"rate": 120.0}, "note": "text"}
    savemat(tmp_path / "a.mat", {"trial": inner, "cells": np.array([1, "a"], dtype=object)})
    found = read_mat_arrays(tmp_path / "a.mat")
    assert sorted(found) == ["trial.deep.rate", "trial.pos"]


def test_files_of_version_7_3_are_read_in_matlabs_order_of_dimensions(tmp_path, walk):
    with h5py.File(tmp_path / "a.mat", "w", userblock_size=512) as file:
        file["walk"] = walk.T
        file.create_group("trial")["rate"] = 120.0
        file["title"] = np.array([[72, 105]], dtype=np.uint16)
        file["title"].attrs["MATLAB_class"] = np.bytes_("char")
    with (tmp_path / "a.mat").open("r+b") as file:
        file.write(b"MATLAB 7.3 MAT-file")
    found = read_mat_arrays(tmp_path / "a.mat")
    assert sorted(found) == ["trial.rate", "walk"]
    np.testing.assert_array_equal(found["walk"], walk)


def test_an_array_becomes_trajectories_as_it_is_described(tmp_path, walk):
    savemat(tmp_path / "a.mat", {"walk": walk})
    read = read_mat(tmp_path / "a.mat", markers=NAMES, rate_hz=50, unit="m")
    np.testing.assert_allclose(read.values, walk * 1000)
    assert sampling_rate(read) == pytest.approx(50)
    assert read.marker.values.tolist() == NAMES
    turned = read_mat(
        tmp_path / "a.mat", "walk", markers=NAMES, rate_hz=50, axes=("right", "up", "backward")
    )
    x, y, z = walk[..., 0], walk[..., 1], walk[..., 2]
    np.testing.assert_allclose(turned.values, np.stack([-z, -x, y], axis=-1))


@pytest.mark.parametrize(
    ("array", "options"),
    [
        (lambda w: w.transpose(1, 2, 0), {"dims": ("marker", "axis", "time")}),
        (lambda w: w.reshape(7, 6), {"dims": ("time", "column")}),
        (lambda w: w.reshape(7, 6).T, {"dims": ("column", "time")}),
        (
            lambda w: w.transpose(0, 2, 1).reshape(7, 6),
            {"dims": ("time", "column"), "layout": "planar"},
        ),
    ],
)
def test_any_order_of_dimensions_and_columns_gives_the_same(tmp_path, walk, array, options):
    savemat(tmp_path / "a.mat", {"walk": array(walk), "other": np.eye(2)})
    read = read_mat(tmp_path / "a.mat", "walk", markers=NAMES, rate_hz=50, **options)
    np.testing.assert_allclose(read.values, walk)


def test_what_does_not_fit_is_told(tmp_path, walk):
    savemat(tmp_path / "a.mat", {"walk": walk, "bad": np.full((7, 2, 3), np.inf)})
    for variable, markers, told in [
        (None, NAMES, r"one array, but got .*'walk': \(7, 2, 3\)"),
        ("steps", NAMES, "an array 'steps'"),
        ("walk", ["head"], r"shape \('time', 1, 3\), but got \(7, 2, 3\)"),
        ("bad", NAMES, "finite numbers"),
    ]:
        with pytest.raises(UnreadableFile, match=told):
            read_mat(tmp_path / "a.mat", variable, markers=markers, rate_hz=50)
    with pytest.raises(ValueError, match="are not known"):
        read_mat(tmp_path / "a.mat", "walk", markers=NAMES, rate_hz=50, dims=("x", "y", "z"))
    with pytest.raises(ValueError, match="no three axes"):
        read_mat(tmp_path / "a.mat", markers=NAMES, rate_hz=50, axes=("left", "right", "up"))


def test_damaged_files_end_in_arrays_or_the_one_error(tmp_path, walk):
    rng = np.random.default_rng(1)
    savemat(tmp_path / "whole.mat", {"walk": walk, "s": {"a": np.eye(3)}})
    whole = (tmp_path / "whole.mat").read_bytes()
    outcomes = set()
    for number in range(6):
        damaged = bytearray(whole)
        for at in rng.integers(128, len(whole), size=3):
            damaged[at] = rng.integers(256)
        if number % 3 == 0:
            del damaged[int(rng.integers(len(whole))) :]
        (tmp_path / "bad.mat").write_bytes(bytes(damaged))
        try:
            read_mat_arrays(tmp_path / "bad.mat")
        except UnreadableFile:
            outcomes.add("refused")
        else:
            outcomes.add("read")
    assert outcomes == {"read", "refused"}


def _bomb(n_bytes: int) -> bytes:
    """A compressed MATLAB file that claims a matrix and swells to so many bytes."""
    header = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<HH", 0x0100, 0x4D49)
    side = n_bytes // 8
    matrix = struct.pack("<IIII", 6, 8, 6, 0)  # flags: an array of doubles
    matrix += struct.pack("<IIii", 5, 8, side, 1)
    matrix += struct.pack("<II", 1, 1) + b"x".ljust(8, b"\0")
    matrix += struct.pack("<II", 9, side * 8)
    packer = zlib.compressobj(9)
    body = packer.compress(struct.pack("<II", 14, len(matrix) + side * 8) + matrix)
    piece = bytes(2**20)
    for _ in range(n_bytes // len(piece)):
        body += packer.compress(piece)
    body += packer.flush()
    return header + struct.pack("<II", 15, len(body)) + body


def test_a_bomb_does_not_go_off(tmp_path):
    (tmp_path / "bomb.mat").write_bytes(_bomb(2**29))
    assert (tmp_path / "bomb.mat").stat().st_size < 2**20
    with pytest.raises(UnreadableFile, match=r"bomb\.mat: expected a MATLAB file"):
        read_mat_arrays(tmp_path / "bomb.mat")


def test_a_child_imports_nothing_from_the_folder_one_is_in(tmp_path, monkeypatch):
    for name in ("numpy", "scipy", "io"):
        (tmp_path / f"{name}.py").write_text("raise SystemExit('fooled')")
    savemat(tmp_path / "a.mat", {"x": np.ones(2)})
    monkeypatch.chdir(tmp_path)
    assert read_mat_arrays("a.mat")["x"].size == 2


def test_a_script_without_a_main_guard_is_not_run_again(tmp_path):
    savemat(tmp_path / "a.mat", {"x": np.ones(2)})
    script = tmp_path / "script.py"
    script.write_text(
        "from eigenwalker.io.readers.mat import read_mat_arrays\n"
        f"print(len(read_mat_arrays({str(tmp_path / 'a.mat')!r})))\n"
    )
    ran = subprocess.run([sys.executable, script], capture_output=True, text=True, check=True)
    assert ran.stdout == "1\n"


def test_the_reader_runs_here_as_it_does_in_the_child(tmp_path, walk):
    savemat(tmp_path / "a.mat", {"walk": walk})
    np.testing.assert_array_equal(mat_arrays(str(tmp_path / "a.mat"))["walk"], walk)


def test_a_matlab_file_read_as_a_capture_says_how_to_read_it(tmp_path, walk):
    savemat(tmp_path / "a.mat", {"walk": walk})
    savemat(tmp_path / "old.mat", {"walk": walk[:, 0]}, format="4")
    for name in ("a.mat", "old.mat"):
        with pytest.raises(UnreadableFile, match=r"a MATLAB file, .* read_mat\(path, variable"):
            read_mocap(tmp_path / name)
