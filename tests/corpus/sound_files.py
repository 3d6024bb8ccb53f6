"""Small sound files of every format that is read, written from a simulated walk.

What the project writes itself comes from its own writers, the rest from the few lines below, which
know the formats from their descriptions and not from our readers.
"""

from __future__ import annotations

import io
import json
import struct
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import NamedTuple

import h5py
import numpy as np
import xarray as xr
from scipy.io import savemat

from eigenwalker.io.readers.pose_json import MEDIAPIPE
from eigenwalker.io.write import write_mocap
from eigenwalker.population.population import Population
from eigenwalker.simulation.people import simulate_population
from eigenwalker.simulation.walk import simulate_walk
from eigenwalker.stimulus.make import make_stimulus

Files = dict[str, bytes]
"""Files that belong together by name; the first is the one to read."""

RATE_HZ = 25


class Kind(NamedTuple):
    """A kind of file: how to make some that are sound, and whether a child process reads it."""

    make: Callable[[xr.DataArray], list[Files]]
    in_child: bool = False


def walk_of(duration_s: float = 0.5, *, rate_hz: float = RATE_HZ, seed: int = 3) -> xr.DataArray:
    """Return a walk of the 15 joints, with a gap, in whole micrometres."""
    walk = simulate_walk(seed=seed, duration_s=duration_s, rate_hz=rate_hz, truth=False)
    values = walk.values.round(3)
    values[3:5, 2] = np.nan
    return xr.DataArray(
        values,
        dims=walk.dims,
        coords={name: walk[name].values for name in walk.dims},
        attrs={"units": "mm"},
    )


def sound_files(kind: str, walk: xr.DataArray | None = None) -> list[Files]:
    """Return sound files of a kind, one or more in its several variants."""
    return KINDS[kind].make(walk_of() if walk is None else walk)


def _filled(walk: xr.DataArray) -> xr.DataArray:
    return walk.interpolate_na("time", fill_value="extrapolate", keep_attrs=True)


def _by_our_writer(suffix: str) -> Callable[[xr.DataArray], list[Files]]:
    def make(walk: xr.DataArray) -> list[Files]:
        with TemporaryDirectory() as folder:
            written = write_mocap(_filled(walk), Path(folder) / f"a{suffix}")
            return [{written.name: written.read_bytes()}]

    return make


def c3d_file(
    walk: xr.DataArray,
    *,
    machine: str = "Intel",
    integers: bool = False,
    labels: Sequence[str] | None = None,
    rate_hz: float | None = None,
    unit: str = "mm",
    n_frames: int | None = None,
    n_points: int | None = None,
) -> bytes:
    """Return a C3D file as the manual describes it, of any machine, declaring what it is told."""
    order = ">" if machine == "MIPS" else "<"
    points = walk.values
    labels = [str(name) for name in walk.marker.values] if labels is None else list(labels)
    rate = 1 / float(np.diff(walk.time.values[:2])[0]) if rate_hz is None else rate_hz
    scale = 0.1 if integers else -0.1
    frames = len(points) if n_frames is None else n_frames
    count = points.shape[1] if n_points is None else n_points

    def words(*numbers: int) -> bytes:
        return struct.pack(f"{order}{len(numbers)}H", *numbers)

    def floats(numbers: object) -> bytes:
        values = np.asarray(numbers, dtype=float).ravel()
        if machine != "DEC":
            return values.astype(f"{order}f4").tobytes()
        halves = (4 * values).astype("<f4").view("<u2").reshape(-1, 2)
        return np.ascontiguousarray(halves[:, ::-1]).tobytes()

    def parameter(name: str, kind: int, shape: tuple[int, ...], raw: bytes) -> bytes:
        body = struct.pack(f"bB{len(shape)}B", kind, len(shape), *shape) + raw + b"\0"
        return struct.pack("bb", len(name), 1) + name.encode() + words(len(body) + 2) + body

    coded = [label.encode("utf-8") for label in labels]
    width = max(map(len, coded), default=0)
    parameters = [
        struct.pack("bb", 5, -1) + b"POINT" + words(3) + b"\0",
        parameter("USED", 2, (), words(count)),
        parameter("FRAMES", 2, (), words(frames)),
        parameter("SCALE", 4, (), floats([scale])),
        parameter("RATE", 4, (), floats([rate])),
        parameter("UNITS", -1, (len(unit),), unit.encode()),
        parameter(
            "LABELS", -1, (width, len(coded)), b"".join(label.ljust(width) for label in coded)
        ),
    ]
    body = b"".join(parameters) + b"\0\0"
    blocks = -(-(4 + len(body)) // 512)
    mark = {"Intel": 84, "DEC": 85, "MIPS": 86}[machine]
    section = (bytes([1, 0x50, blocks, mark]) + body).ljust(blocks * 512, b"\0")
    header = bytes([2, 0x50]) + words(count, 0, 1, frames, 0) + floats([scale])
    header += words(2 + blocks, 1) + floats([rate])
    seen = ~np.isnan(points).any(axis=2, keepdims=True)
    samples = np.where(seen, points, 0.0)
    table = np.concatenate(
        [np.rint(samples / scale) if integers else samples, np.where(seen, 0, -1)], axis=2
    )
    data = table.astype(f"{order}i2").tobytes() if integers else floats(table)
    whole = header.ljust(512, b"\0") + section + data
    return whole.ljust(-(-len(whole) // 512) * 512, b"\0")


def _c3d(walk: xr.DataArray) -> list[Files]:
    ours = _by_our_writer(".c3d")(walk)
    variants = [("Intel", False), ("Intel", True), ("DEC", False), ("MIPS", True)]
    return ours + [
        {"a.c3d": c3d_file(walk, machine=machine, integers=whole)} for machine, whole in variants
    ]


ASF = """:version 1.10
:name small
:units
  mass 1.0
  length 0.45
  angle deg
:root
   order TX TY TZ RX RY RZ
   axis XYZ
   position 0 0 0
   orientation 0 0 0
:bonedata
{bones}:hierarchy
  begin
    root lhipjoint rhipjoint lowerback
    lowerback thorax
    thorax head
    lhipjoint lfemur
    lfemur ltibia
    ltibia lfoot
    rhipjoint rfemur
    rfemur rtibia
    rtibia rfoot
  end
"""
_BONES = {
    "lhipjoint": (2, (0.7, -0.7, 0), 0),
    "lfemur": (7, (0, -1, 0), 3),
    "ltibia": (7, (0, -1, 0), 1),
    "lfoot": (2, (0, 0, 1), 2),
    "rhipjoint": (2, (-0.7, -0.7, 0), 0),
    "rfemur": (7, (0, -1, 0), 3),
    "rtibia": (7, (0, -1, 0), 1),
    "rfoot": (2, (0, 0, 1), 2),
    "lowerback": (4, (0, 1, 0), 3),
    "thorax": (4, (0, 1, 0), 3),
    "head": (4, (0, 1, 0), 3),
}


def acclaim_files(n_frames: int = 12, *, rate_hz: float = RATE_HZ) -> Files:
    """Return a motion and its skeleton: legs that swing below a body that glides forward."""
    bones = "".join(
        f"  begin\n     id {number}\n     name {name}\n     direction {x} {y} {z}\n"
        f"     length {length}\n     axis 0 0 {10 * n_turns} XYZ\n"
        + (f"    dof {' '.join(('rx', 'ry', 'rz')[:n_turns])}\n" if n_turns else "")
        + "  end\n"
        for number, (name, (length, (x, y, z), n_turns)) in enumerate(_BONES.items(), 1)
    )
    lines = [f":FULLY-SPECIFIED\n:DEGREES\n:SAMPLES-PER-SECOND {rate_hz}"]
    for frame in range(n_frames):
        angle = 30 * np.sin(2 * np.pi * 0.9 * frame / rate_hz)
        lines.append(f"{frame + 1}\nroot 0 17.5 {0.8 * frame:.3f} 0 0 0")
        for name, (_, _, n_turns) in _BONES.items():
            turn = angle * {"lfemur": 1, "rfemur": -1}.get(name, 0.1)
            if n_turns:
                lines.append(" ".join([name, *[f"{turn:.4f}", "0", "0.5"][:n_turns]]))
    motion = "\n".join(lines) + "\n"
    return {"07_01.amc": motion.encode(), "07.asf": ASF.format(bones=bones).encode()}


def _y_up_metres(walk: xr.DataArray) -> np.ndarray:
    return walk.values[..., [1, 2, 0]] / 1000


def _words(frame: np.ndarray, digits: int = 6, missing: str = "") -> list[str]:
    return [missing if np.isnan(number) else f"{number:.{digits}f}" for number in frame.ravel()]


def _sto(walk: xr.DataArray) -> list[Files]:
    names = [f"{name}_t{axis}" for name in walk.marker.values for axis in "xyz"]
    head = f"markers\nversion=1\nnRows={len(walk)}\nnColumns={len(names) + 1}\ninDegrees=no\n"
    lines = [head + "endheader", "\t".join(["time", *names])]
    vectors = [f"{head}DataType=Vec3\nUnits=m\nendheader".replace(f"{len(names) + 1}", "16")]
    vectors.append("\t".join(["time", *map(str, walk.marker.values)]))
    for i, frame in enumerate(_y_up_metres(walk)):
        lines.append("\t".join([f"{i / RATE_HZ:.8f}", *_words(frame, missing="nan")]))
        points = (f"~[{','.join(_words(point, missing='NaN'))}]" for point in frame)
        vectors.append("\t".join([f"{i / RATE_HZ:.8f}", *points]))
    return [{"a.sto": ("\n".join(each) + "\n").encode()} for each in (lines, vectors)]


def _vicon(walk: xr.DataArray) -> list[Files]:
    names = ",".join(f"Anna:{name},," for name in walk.marker.values)
    n_columns = 3 * walk.sizes["marker"]
    lines = ["Trajectories", f"{RATE_HZ}", ",," + names]
    lines += [",".join(["Frame", "Sub Frame", *"XYZ" * (n_columns // 3)])]
    lines += [",," + ",".join(["mm"] * n_columns)]
    for number, frame in enumerate(walk.values, 1):
        lines.append(",".join([f"{number}", "0", *_words(frame, 3)]))
    devices = "Devices\r\n100\r\n,,Plate,,\r\nFrame,Sub Frame,Fx,Fy\r\n,,N,N\r\n1,0,2,3\r\n\r\n"
    text = "\r\n".join(lines) + "\r\n"
    return [{"a.csv": text.encode()}, {"a.csv": (devices + text).encode()}]


def _qualisys(walk: xr.DataArray) -> list[Files]:
    names = [str(name) for name in walk.marker.values]
    lines = [
        f"NO_OF_FRAMES\t{len(walk)}",
        "NO_OF_CAMERAS\t12",
        f"NO_OF_MARKERS\t{len(names)}",
        f"FREQUENCY\t{RATE_HZ}",
        "NO_OF_ANALOG\t0",
        "DATA_INCLUDED\t3D",
        "EVENT\tstep\t12\t0.24",
        "\t".join(["MARKER_NAMES", *names]),
        "\t".join(["Frame", "Time", *(f"{name} {axis}" for name in names for axis in "XYZ")]),
    ]
    for i, frame in enumerate(walk.values):
        lines.append("\t".join([f"{i + 1}", f"{i / RATE_HZ:.5f}", *_words(frame, 3, "0.000")]))
    return [{"a.tsv": ("\r\n".join(lines) + "\r\n").encode()}]


def _table_of(names: Sequence[str], values: np.ndarray, *, timed: bool, digits: int = 6) -> str:
    columns = [f"{name}_{axis}" for name in names for axis in "xyz"]
    lines = [",".join(["time_s"] * timed + columns)]
    for i, frame in enumerate(values):
        lines.append(",".join([f"{i / RATE_HZ:.4f}"] * timed + _words(frame, digits)))
    return "\n".join(lines) + "\n"


def _kinect(walk: xr.DataArray) -> list[Files]:
    own = {"sternum": "SpineShoulder", "pelvis": "SpineBase", "head": "Head"}
    names = [
        own.get(name) or "".join(reversed(name.title().split("_")))
        for name in map(str, walk.marker.values)
    ]
    return [{"a.csv": _table_of(names, _y_up_metres(walk), timed=True).encode()}]


def _pose_json(walk: xr.DataArray) -> list[Files]:
    joints = {str(name): at for at, name in enumerate(walk.marker.values)}
    values = _y_up_metres(walk) * [1, -1, -1]
    frames = []
    for i, frame in enumerate(np.where(np.isnan(values), 0.0, values).round(5)):
        points = [frame[joints.get(name, 0)].tolist() for name in MEDIAPIPE]
        frames.append({"time_s": i / RATE_HZ, "landmarks": points})
    named = [
        {name: dict(zip("xyz", frame[at], strict=True)) for name, at in joints.items()}
        for frame in np.where(np.isnan(values), 0.0, values).round(5).tolist()
    ]
    whole = {"rate_hz": RATE_HZ, "unit": "m", "frames": named}
    return [{"a.json": json.dumps(each).encode()} for each in (frames, whole)]


def _data3d(walk: xr.DataArray) -> list[Files]:
    parts = ("shoulder", "elbow", "wrist"), ("hip", "knee", "ankle")
    names = ["head", *(f"{s}_{p}" for three in parts for s in ("left", "right") for p in three)]
    values = _filled(walk).sel(marker=names).values[..., [1, 2, 0]] / (25.4 / 0.45)
    lines = [" ".join(_words(row)) for frame in values for row in frame.T]
    return [{"a.txt": ("\n".join(lines) + "\n").encode()}]


def _described(walk: xr.DataArray) -> list[Files]:
    names = json.dumps([str(name) for name in walk.marker.values])
    told = f'names = {names}\nunit = "mm"\nforward = "x"\nup = "z"\nrate_hz = {RATE_HZ}\n'
    rows = ["\t".join(_words(frame, 3, "nan")) for frame in walk.values]
    timed = "\n".join(f"{i / RATE_HZ:.4f}\t{row}" for i, row in enumerate(rows)) + "\n"
    more = told.replace(f"rate_hz = {RATE_HZ}", "time_column = 1\nskip_columns = 1")
    return [
        {"a.txt": ("\n".join(rows) + "\n").encode(), "a.toml": told.encode()},
        {"a.txt": timed.encode(), "a.toml": more.encode()},
    ]


def mat_file(arrays: Mapping[str, object], **options: object) -> bytes:
    """Return a MATLAB file of version 5, or of 4 with ``format="4"``."""
    written = io.BytesIO()
    savemat(written, dict(arrays), **options)  # pyright: ignore[reportArgumentType] - as told
    return written.getvalue()


def hdf5_mat_file(arrays: Mapping[str, np.ndarray]) -> bytes:
    """Return a MATLAB file of version 7.3, which is HDF5 behind 512 bytes."""
    written = io.BytesIO()
    with h5py.File(written, "w", userblock_size=512) as file:
        for name, array in arrays.items():
            file[name] = array.T
    return b"MATLAB 7.3 MAT-file".ljust(512, b"\0") + written.getvalue()[512:]


def _mat(walk: xr.DataArray) -> list[Files]:
    arrays = {"walk": walk.values, "trial": {"rate": 25.0, "note": "a walk"}}
    plain = {"walk": walk.values}
    return [
        {"a.mat": content}
        for content in (
            mat_file(arrays),
            mat_file(arrays, do_compression=True),
            mat_file({"walk": walk.values.reshape(len(walk), -1)}, format="4"),
            hdf5_mat_file(plain),
        )
    ]


def _population(walk: xr.DataArray) -> list[Files]:
    del walk
    with TemporaryDirectory() as folder:
        path = Path(folder) / "people.nc"
        people: Population = simulate_population(2, 2, seed=1)
        people.save(path)
        return [{path.name: path.read_bytes()}]


def _stimulus(walk: xr.DataArray) -> list[Files]:
    del walk
    shown = make_stimulus(simulate_population(1, 1, seed=1).walkers[0]).then("mirror")
    return [{"a.json": shown.to_json().encode()}]


def _bml(walk: xr.DataArray) -> list[Files]:
    del walk
    rng = np.random.default_rng(0)
    tables = {}
    for key, scale in (("walker", 300), ("gender", 5)):
        blocks = rng.normal(scale=scale, size=(5, 46)).round(3)
        blocks[:, 45] = (126, 0, 11, 0, 0) if key == "walker" else (-1, 0, 0.3, 0, 0)
        tables[key] = blocks.ravel().tolist()
    return [{"axes.json": json.dumps({"tables": {"raw": tables}}).encode()}]


KINDS = {
    "c3d": Kind(_c3d),
    "bvh": Kind(_by_our_writer(".bvh")),
    "amc": Kind(lambda walk: [acclaim_files(len(walk))]),
    "trc": Kind(_by_our_writer(".trc")),
    "sto": Kind(_sto),
    "vicon_csv": Kind(_vicon),
    "qualisys_tsv": Kind(_qualisys),
    "pose_json": Kind(_pose_json),
    "csv": Kind(_by_our_writer(".csv")),
    "kinect": Kind(_kinect),
    "data3d": Kind(_data3d),
    "described": Kind(_described),
    "netcdf": Kind(_by_our_writer(".nc")),
    "population": Kind(_population),
    "stimulus": Kind(_stimulus),
    "bml": Kind(_bml),
    "mat": Kind(_mat, in_child=True),
}
"""Every kind of file that is read, some by several readers."""
