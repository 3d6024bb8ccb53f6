"""Known-bad files of binary formats: C3D, NetCDF, MATLAB, populations."""

from __future__ import annotations

import io
import struct
import zlib
from collections.abc import Callable
from pathlib import Path

import h5py
import numpy as np
import xarray as xr

from corpus.bad_file import BadFile, Door, changed, cut, written
from corpus.sound_files import c3d_file, hdf5_mat_file, mat_file, sound_files, walk_of


def _c3d(**options: object) -> Callable[[Path], Path]:
    return written(lambda: {"a.c3d": c3d_file(walk_of(), **options)})  # pyright: ignore[reportArgumentType] - as told


def _with(number: float) -> Callable[[Path], Path]:
    def files() -> dict[str, bytes]:
        walk = walk_of()
        walk.values[:, 5] = number
        return {"a.c3d": c3d_file(walk)}

    return written(files)


def bad_c3d() -> list[BadFile]:
    """Return C3D files that are cut short or do not fit themselves."""
    found = []
    for at in (2, 300, 511, 600, 900):
        found.append(BadFile(f"C3D cut at {at} bytes", cut("c3d", lambda _, at=at: at), "C3D|cut"))
    for share in (0.5, 0.7, 0.9):
        for variant, machine in enumerate(("Intel", "Intel integers", "DEC", "MIPS integers"), 1):
            end = cut("c3d", lambda content, s=share: int(s * len(content)), variant=variant)
            found.append(BadFile(f"C3D ({machine}) cut at {share:.0%}", end, "file is cut short"))
    strange = written(lambda: {"a.c3d": _replaced(515, b"\x09")})
    return [
        *found,
        *(
            BadFile(f"C3D at {rate:g} Hz", _c3d(rate_hz=rate), "one frame rate in header")
            for rate in (0.0, -25.0, 1e9, float("nan"), float("inf"))
        ),
        BadFile("C3D that declares 65535 frames", _c3d(n_frames=65535), "65535 frames, as it decl"),
        BadFile("C3D that declares 0 frames", _c3d(n_frames=0), "one frame or more"),
        BadFile("C3D of no points", _c3d(n_points=0), "number of points in its header"),
        BadFile("C3D of 60000 points", _c3d(n_points=60000), "the file is cut short"),
        BadFile("C3D with an infinite position", _with(np.inf), "finite positions"),
        BadFile("C3D with a position of 1e30", _with(1e30), "finite positions"),
        BadFile("C3D of a strange machine", strange, r"\(84 to 86\)"),
        BadFile("C3D whose labels are blanks", _c3d(labels=[" "] * 15), "labelled markers"),
        BadFile(
            "C3D whose points are unlabelled",
            _c3d(labels=[f"*{number}" for number in range(15)]),
            "labelled markers.*label them first",
        ),
        BadFile(
            "C3D of angles", _c3d(labels=[f"P{n}Angles" for n in range(15)]), "or no positions"
        ),
        BadFile("C3D of zeros", written({"a.c3d": b"\x02\x50" + bytes(4000)}), r"\(84 to 86\)"),
    ]


def _replaced(at: int, put: bytes) -> bytes:
    content = c3d_file(walk_of())
    return content[:at] + put + content[at + len(put) :]


def _netcdf(
    change: Callable[[xr.Dataset], xr.Dataset], kind: str = "netcdf"
) -> Callable[[Path], Path]:
    """Return how to write a NetCDF file of ours in which something is changed."""

    def files() -> dict[str, bytes]:
        content = next(iter(sound_files(kind)[0].values()))
        with xr.open_dataset(io.BytesIO(content), engine="scipy") as opened:
            dataset = change(opened.load())
        return {"a.nc": bytes(dataset.to_netcdf(engine="scipy", format="NETCDF3_64BIT"))}

    return written(files)


def _set_position(number: float) -> Callable[[xr.Dataset], xr.Dataset]:
    def change(dataset: xr.Dataset) -> xr.Dataset:
        dataset["position"].values[3, 2, 1] = number
        return dataset

    return change


def bad_netcdf() -> list[BadFile]:
    """Return NetCDF files that are damaged, or hold something else than they should."""
    shares = (0.05, 0.2, 0.5, 0.9, 0.99)
    huge = b"CDF\x02" + struct.pack(">II", 0, 10) + struct.pack(">II", 2, 2**31 - 1)
    bomb = changed("netcdf", rb"time\x00\x00\x00.", b"time\x7f\xff\xff\xf0")
    said = "expected trajectories as write_mocap writes them"
    cuts = [
        BadFile(
            f"{kind} cut at {share:.0%}",
            cut(kind, lambda content, share=share: int(share * len(content))),
            "expected (trajectories|a population file)",
            door=door,
        )
        for kind, door in (("netcdf", "capture"), ("population", "population"))
        for share in shares
    ]
    return [
        *cuts,
        BadFile("NetCDF of 2 billion dimensions", written({"a.nc": huge + bytes(99)}), said),
        BadFile("NetCDF that declares 2 billion frames", bomb, said),
        BadFile("NetCDF with an infinite position", _netcdf(_set_position(np.inf)), "infinite or"),
        BadFile("NetCDF with a position of 1e200", _netcdf(_set_position(1e200)), "infinite or"),
        BadFile(
            "NetCDF of temperatures",
            _netcdf(lambda _: xr.Dataset({"t2m": ("time", np.zeros(3))})),
            "open it with xarray|walkers or trajectories|expected",
        ),
        BadFile(
            "NetCDF of version 99",
            _netcdf(lambda dataset: dataset.assign_attrs(format_version=99)),
            "version 1 of the format, but got version 99; update eigenwalker",
        ),
        BadFile(
            "NetCDF whose times go back",
            _netcdf(lambda dataset: dataset.assign_coords(time=-dataset["time"])),
            "times that do not go on",
        ),
        BadFile(
            "NetCDF whose times are uneven",
            _netcdf(lambda dataset: dataset.assign_coords(time=dataset["time"] ** 2 + 1)),
            "not evenly spaced|do not go on",
        ),
        BadFile(
            "NetCDF in metres",
            _netcdf(
                lambda dataset: dataset.assign(position=dataset["position"].assign_attrs(units="m"))
            ),
            "axes or units are none of ours",
        ),
        BadFile(
            "NetCDF with a marker twice",
            _netcdf(lambda dataset: dataset.assign_coords(marker=["head"] * 15)),
            r"come twice: \['head'\]",
        ),
        BadFile(
            "population of a newer version",
            _netcdf(lambda dataset: dataset.assign_attrs(format_version=99), kind="population"),
            "version 1 of the format, but got version 99",
            door="population",
        ),
        BadFile(
            "population without walkers",
            _netcdf(lambda dataset: dataset.isel(walker=slice(0)), kind="population"),
            "no walkers",
            door="population",
        ),
        BadFile(
            "population with infinities",
            _netcdf(lambda dataset: dataset.assign(p0=dataset["p0"] * np.inf), kind="population"),
            "finite",
            door="population",
        ),
        BadFile(
            "trajectories for a population",
            written(lambda: sound_files("netcdf")[0]),
            "a population file",
            door="population",
        ),
    ]  # fmt: skip


def _mat(array: np.ndarray, **options: object) -> Callable[[Path], Path]:
    return written(lambda: {"a.mat": mat_file({"walk": array}, **options)})


def _bomb(n_bytes: int) -> bytes:
    """A compressed MATLAB file of some kB that claims a matrix of so many bytes, and has 32 MB."""
    side = n_bytes // 8
    flags = struct.pack("<IIII", 6, 8, 6, 0)
    dims = struct.pack("<IIii", 5, 8, side, 1)
    name = struct.pack("<HH4s", 1, 4, b"walk")
    body = flags + dims + name + struct.pack("<II", 9, n_bytes)
    inner = struct.pack("<II", 14, len(body) + n_bytes) + body
    press = zlib.compressobj(9)
    pressed = press.compress(inner)
    for _ in range(32):
        pressed += press.compress(bytes(1 << 20))
    pressed += press.flush()
    header = b"MATLAB 5.0 MAT-file".ljust(124) + struct.pack("<HH", 0x0100, 0x4D49)
    return header + struct.pack("<II", 15, len(pressed)) + pressed


def _hdf5_bomb() -> bytes:
    """A MATLAB file of version 7.3, of some kB, with 8 GB of a matrix that was never written."""
    written_to = io.BytesIO()
    with h5py.File(written_to, "w", userblock_size=512) as file:
        file.create_dataset("walk", shape=(10**9,), dtype="f8", chunks=(10**6,), compression="gzip")
    return b"MATLAB 7.3 MAT-file".ljust(512, b"\0") + written_to.getvalue()[512:]


def bad_mat() -> list[BadFile]:
    """Return MATLAB files that are damaged, too large, or of other things."""
    walk = walk_of().values
    infinite = walk.copy()
    infinite[2] = np.inf
    whole = mat_file({"walk": walk})
    pressed = mat_file({"walk": walk}, do_compression=True)
    modern = hdf5_mat_file({"walk": walk})
    shape = r"an array of shape \('time', 15, 3\), but got"
    cases: list[tuple[str, Callable[[Path], Path], str, Door]] = [
        ("MAT cut in half", written({"a.mat": whole[: len(whole) // 2]}), "a MATLAB file", "mat"),
        ("MAT cut in its header", written({"a.mat": whole[:100]}), "MATLAB|one array", "mat"),
        ("pressed MAT cut", written({"a.mat": pressed[:-200]}), "a MATLAB file", "mat"),
        ("MAT 7.3 cut", written({"a.mat": modern[:-2000]}), "a MATLAB file", "mat"),
        ("MAT of noise", written({"a.mat": bytes(range(256)) * 20}), "a MATLAB file", "mat"),
        ("MAT that is text", written({"a.mat": b"walk = [1 2 3];\n" * 9}), "a MATLAB file", "mat"),
        ("MAT of another shape", _mat(walk[:, :9]), shape, "mat"),
        ("MAT on its side", _mat(walk.T), shape, "mat"),
        ("MAT of text", _mat(np.array(["a", "b"])), "an array 'walk', but got {}", "mat"),
        ("MAT with infinity", _mat(infinite), "finite numbers", "mat"),
        ("MAT of one number", _mat(np.eye(1)), shape, "mat"),
        ("MAT of 1.5 GiB", written(lambda: {"a.mat": _bomb(3 << 29)}), "shape|GiB", "mat"),
        ("MAT 7.3 of 8 GB", written(lambda: {"a.mat": _hdf5_bomb()}), "shape|GiB", "mat"),
        ("MAT without a word on it", _mat(walk), "MATLAB file, which does not; read an", "capture"),
        ("walkers.mat of others", _mat(walk), "tables F and M", "walkers.mat"),
        (
            "walkers.mat of infinities",
            written(lambda: {"a.mat": mat_file(dict.fromkeys("FM", np.full((45, 5), np.inf)))}),
            "F in millimetres",
            "walkers.mat",
        ),
    ]  # fmt: skip
    return [BadFile(name, make, said, door=door) for name, make, said, door in cases]


def bad_bml() -> list[BadFile]:
    """Return tables of the BML that are none."""
    cases = [
        ("cut", cut("bml", lambda content: len(content) // 2), "a JSON file"),
        ("of nothing", written({"axes.json": b"{}"}), "a list 'walker' of 230 numbers"),
        ("with a number too few", changed("bml", r'(?<="walker": \[)[^,]+, ', ""), "230 numbers"),
        ("with text", changed("bml", r'(?<="walker": \[)[^,]+', '"a"'), "230 numbers"),
        ("with infinity", changed("bml", r'(?<="walker": \[)[^,]+', "Infinity"), "too large"),
        ("with NaN", changed("bml", r'(?<="gender": \[)[^,]+', "NaN"), "too large"),
        ("of someone who stands still", changed("bml", r"\b126\.0", "0.0"), "that can walk"),
    ]
    return [BadFile(f"BML tables {what}", make, said, door="bml") for what, make, said in cases]
