"""Captures that can be read and are not for use: wrong units, rates, sides, and no walks."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import xarray as xr

from corpus.bad_file import BadFile, person, written
from corpus.sound_files import c3d_file, sound_files
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.io.write import write_mocap


def _changed(change: Callable[[np.ndarray], np.ndarray | None], **options: object) -> xr.DataArray:
    walk = person()
    values = walk.values.copy()
    new = change(values)
    return walk.copy(data=values if new is None else new)


def _c3d(
    change: Callable[[np.ndarray], np.ndarray | None] = lambda values: values, **options: object
) -> Callable[[Path], Path]:
    return written(lambda: {"a.c3d": c3d_file(_changed(change), **options)})  # pyright: ignore[reportArgumentType] - as told


def wrong_units() -> list[BadFile]:
    """Return walks of which the unit is not the one that is told: off by 1000, 10, 2.54."""
    giant = r"From feet to head the body measures .* which no walking person does: the unit m is"
    dwarf = r"From feet to head the body measures 1\.\d+ mm, which no walking person does"

    def written_as(suffix: str, unit: str, told: str) -> Callable[[Path], Path]:
        def make(folder: Path) -> Path:
            path = write_mocap(person(), folder / f"a{suffix}", unit=unit)
            text = path.read_text()
            old, new = {".trc": (f"\t{unit}\t", f"\t{told}\t")}.get(
                suffix, (f"unit: {unit};", f"unit: {told};")
            )
            assert old in text
            path.write_text(text.replace(old, new, 1))
            return path

        return make

    described = 'names = {}\nunit = "{}"\nforward = "x"\nup = "z"\nrate_hz = 50\n'

    def table(unit: str) -> Callable[[Path], Path]:
        def make(folder: Path) -> Path:
            np.savetxt(folder / "a.txt", person().values.reshape(len(person()), -1), fmt="%.3f")
            told = described.format([str(n) for n in person().marker.values], unit)
            (folder / "a.toml").write_text(told)
            return folder / "a.txt"

        return make

    cases = [
        ("C3D in mm, told m", _c3d(unit="m"), giant),
        ("C3D in m, told mm", _c3d(lambda values: values / 1000), dwarf),
        ("C3D in mm, told cm", _c3d(unit="cm"), "no walking person does: the unit cm is wrong"),
        ("C3D in mm, told in", _c3d(unit="in"), "no walking person does: the unit in is wrong"),
        ("TRC in mm, told m", written_as(".trc", "mm", "m"), giant),
        ("TRC in m, told mm", written_as(".trc", "m", "mm"), dwarf),
        ("TRC in in, told cm", written_as(".trc", "in", "cm"), "if this is no small child"),
        ("TRC in cm, told in", written_as(".trc", "cm", "in"), "which no walking person does"),
        ("CSV in mm, told m", written_as(".csv", "mm", "m"), giant),
        ("CSV in m, told mm", written_as(".csv", "m", "mm"), dwarf),
        ("description in m of mm", table("m"), giant),
        ("description in um of mm", table("um"), dwarf),
        (
            "STO in mm, which tells no unit",
            _from_kind("sto", r"", 1000),
            "names no unit of length",
        ),
    ]
    return [BadFile(name, make, said, "flagged") for name, make, said in cases if make is not None]


def _from_kind(kind: str, _: str, factor: float) -> Callable[[Path], Path]:
    """Return how to write a walk of another size in a format."""
    return written(lambda: sound_files(kind, _slow(_changed(lambda values: values * factor)))[0])


def _slow(walk: xr.DataArray) -> xr.DataArray:
    """Return every second frame: the small makers of files know 25 Hz only."""
    return walk[::2]


def wrong_sides() -> list[BadFile]:
    """Return walks of which left and right are not those of the walker."""
    mirror = JOINTS.mirror()
    knees = [JOINTS.index("left_knee"), JOINTS.index("right_knee")]
    backwards = "Knees bend backwards: left is called right, or the capture is mirrored"

    def renamed(values: np.ndarray) -> np.ndarray:
        return values[:, mirror]

    def knees_only(values: np.ndarray) -> None:
        values[100:, knees] = values[100:, knees[::-1]]

    return [
        BadFile("left called right", _c3d(renamed), backwards, "flagged"),
        BadFile("mirrored left to right", _c3d(lambda v: v * [1, -1, 1]), backwards, "flagged"),
        BadFile("mirrored front to back", _c3d(lambda v: v * [-1, 1, 1]), backwards, "flagged"),
        BadFile(
            "knees exchanged from the middle on",
            _c3d(knees_only),
            "(change places|exchanged|swapped|changed)",
            "flagged",
        ),
    ]


def wrong_names() -> list[BadFile]:
    """Return walks whose markers are called alike, otherwise, or not at all."""
    names = [str(name) for name in person().marker.values]
    lacking = r"No known marker set gives the joints .*'{}'"

    def called(*pairs: tuple[str, str]) -> list[str]:
        return [dict(pairs).get(name, name) for name in names]

    def labelled(labels: Sequence[str]) -> Callable[[Path], Path]:
        return _c3d(labels=labels)

    return [
        BadFile(
            "two markers of one name",
            written(lambda: {"a.c3d": c3d_file(_with_another_head(), labels=[*names, "head"])}),
            "Several markers are called alike, and the first of them is taken: head",
            "flagged",
        ),
        BadFile(
            "one name for left and right",
            labelled(called(("left_knee", "knee"), ("right_knee", "knee"))),
            lacking.format("left_knee"),
            "flagged",
        ),
        BadFile(
            "a marker without a name",
            labelled(called(("left_ankle", ""))),
            lacking.format("left_ankle"),
            "flagged",
        ),
        BadFile(
            "names of nothing known",
            labelled([f"Fühler {n} 行走" for n in range(15)]),
            "No known marker set",
            "flagged",
        ),
        BadFile(
            "very long names",
            labelled([f"{n:0>120}" for n in range(15)]),
            "No known mark",
            "flagged",
        ),
        BadFile(
            "names that clear the screen",
            labelled([f"\x1b[2J{n}" for n in range(15)]),
            r"\[2J0",
            "flagged",
        ),
        BadFile(
            "names of 5000 letters",
            written(lambda: {"a.trc": _trc_with_names(["x" * 5000 + str(n) for n in range(15)])}),
            "No known marker set",
            "flagged",
        ),
        BadFile(
            "names of 3000 parts",
            written(lambda: {"a.trc": _trc_with_names(["a_" * 3000 + str(n) for n in range(15)])}),
            "No known marker set",
            "flagged",
        ),
        BadFile(
            "two people",
            labelled(
                [f"Anna:{name}" for name in names[:8]] + [f"Ben:{name}" for name in names[:7]]
            ),
            "markers of several people",
            "flagged",
        ),
    ]


def _with_another_head() -> xr.DataArray:
    walk = person()
    values = np.concatenate([walk.values, walk.values[:, :1] + 300], axis=1)
    return label_trajectories(values, markers=[*walk.marker.values, "other"], rate_hz=50)


def _trc_with_names(names: Sequence[str]) -> bytes:
    content = next(iter(sound_files("trc")[0].values()))
    lines = content.split(b"\n")
    lines[3] = b"Frame#\tTime\t" + b"\t\t\t".join(name.encode() for name in names) + b"\t\t"
    return b"\n".join(lines)


def no_walks() -> list[BadFile]:
    """Return captures of something else than a steady walk on level ground."""
    place = {name: JOINTS.index(name) for name in JOINTS.markers}
    rng = np.random.default_rng(0)

    def hidden(name: str, start: int, end: int) -> Callable[[np.ndarray], None]:
        def hide(values: np.ndarray) -> None:
            values[start:end, place[name]] = np.nan

        return hide

    def jumping(values: np.ndarray) -> None:
        values[100:140, place["head"]] += [0, 0, 400]

    def frozen(values: np.ndarray) -> None:
        values[:, place["left_ankle"]] = values[0, place["left_ankle"]]

    def drifting(values: np.ndarray) -> None:
        values[:, place["left_wrist"]] += np.linspace(0, 900, len(values))[:, None]

    steps = np.linspace(0, 1, len(person()))[:, None, None]
    cases = [
        ("standing still", _c3d(lambda v: v[:1] + rng.normal(size=v.shape)), "steady walk"),
        ("one posture only", _c3d(lambda v: np.repeat(v[:1], len(v), axis=0)), "steady walk"),
        ("noise", _c3d(lambda v: v + rng.normal(scale=150, size=v.shape)), "steady walk|length"),
        ("only noise", _c3d(lambda v: rng.normal(scale=900, size=v.shape)), "steady walk|feet"),
        ("upstairs", _c3d(lambda v: v + steps * [0, 0, 3000]), "no level walk|steady walk"),
        ("downstairs", _c3d(lambda v: v - steps * [0, 0, 3000]), "no level walk|steady walk"),
        ("a gap of a second", _c3d(hidden("left_knee", 100, 150)), "left_knee"),
        ("a marker never seen", _c3d(hidden("left_knee", 0, 250)), "No known marker set"),
        ("a jumping head", _c3d(jumping), "Markers jump: .*head|change length"),
        ("a foot nailed to the floor", _c3d(frozen), "change length"),
        ("a wrist that leaves the arm", _c3d(drifting), "change length"),
        ("ten times too fast", _c3d(rate_hz=500.0), "strides a second is not the pace|steady"),
        ("five times too slow", _c3d(rate_hz=10.0), "strides a second is not the pace|steady"),
        ("on the side", _c3d(_on_the_side), "leans|feet|steady"),
        ("ten frames", written(lambda: {"a.c3d": c3d_file(person()[:10])}), "steady walk|strides"),
        ("two frames", written(lambda: {"a.c3d": c3d_file(person()[:2])}), "steady walk|frames"),
    ]  # fmt: skip
    one = written(lambda: {"a.c3d": c3d_file(person()[:1], rate_hz=50.0)})
    return [
        *(BadFile(name, make, said, "flagged") for name, make, said in cases),
        BadFile("one frame", one, "two frames or more", "flagged"),
        BadFile(
            "all missing",
            _c3d(lambda values: np.full_like(values, np.nan)),
            "never seen|No known marker set",
            "flagged",
        ),
    ]


def _on_the_side(values: np.ndarray) -> np.ndarray:
    """A body that lies: no axis is clearly upwards."""
    turn = np.array([[1, 0, 0], [0, 0.6, -0.8], [0, 0.8, 0.6]])
    return values @ turn.T
