"""``eigenwalker info`` and ``eigenwalker convert``: describe or convert one file."""

from __future__ import annotations

import json
import textwrap
from pathlib import Path
from typing import Annotated

import typer

from eigenwalker.cli.capture_options import Reading, reads_captures
from eigenwalker.cli.option_names import in_options
from eigenwalker.cli.options import RestPose, SkeletonNames, option

LONGEST_IN_LINE = 24
"""Letters up to which entries of a list are printed one after the other."""


@reads_captures
def info(
    file: Annotated[Path, typer.Argument(help="A capture, or a population file (.nc).")],
    as_json: Annotated[bool, option("Print JSON.", "--json")] = False,
    write_mapping: Annotated[
        Path | None,
        option("Begin a mapping of the markers of FILE, to be put right by hand (.toml)."),
    ] = None,
    *,
    reading: Reading,
) -> None:
    """Say what is in a file, and what is wrong with it."""
    from eigenwalker.study.inspect import file_facts, inspect_file
    from eigenwalker.study.messages import inspection_in_words

    _check_info(file, reading, as_json=as_json, begins_mapping=write_mapping is not None)
    if write_mapping is not None:
        _write_mapping(file, write_mapping, reading)
        return
    if as_json:
        facts = inspect_file(file, **reading)
        if isinstance(problems := facts.get("problems"), list):
            facts["problems"] = [in_options(each) for each in problems]
        print(json.dumps(facts, indent=2, ensure_ascii=False, allow_nan=False))
        return
    facts = inspection_in_words(file_facts(file, **reading))
    lines = {name: _in_options(value) for name, value in facts.items()}
    width = max(len(name) for name in lines) + 2
    for name, value in lines.items():
        print(f"{name:<{width}}{_laid_out(value, width)}")


@reads_captures
def convert(
    capture: Annotated[Path, typer.Argument(help="A capture, of any format that is read.")],
    output: Annotated[Path, typer.Argument(help="File to write: .bvh, .c3d, .csv, .nc or .trc.")],
    joints: Annotated[
        bool, option("Write joints, not markers; .bvh always holds joints.", "--joints")
    ] = False,
    skeleton: SkeletonNames = "plain",
    rest_pose: RestPose = "t",
    *,
    reading: Reading,
) -> None:
    """Write a capture in another format."""
    from eigenwalker.io.read import read_mocap
    from eigenwalker.io.write import write_mocap
    from eigenwalker.markers.virtual_markers import virtual_markers

    mapping = reading.pop("mapping")
    walk = read_mocap(capture, **reading)
    if joints or output.suffix.lower() == ".bvh":
        walk = virtual_markers(walk, joints="full", mapping=mapping)
    elif mapping is not None:
        raise ValueError("--mapping has no effect on markers: add --joints, or write .bvh.")
    written = write_mocap(walk, output, skeleton=skeleton, rest_pose=rest_pose)
    print(f"Written: {written}")


def _check_info(file: Path, reading: Reading, *, as_json: bool, begins_mapping: bool) -> None:
    """Refuse options that would have no effect."""
    if begins_mapping and (as_json or reading["mapping"]):
        idle = "--json" if as_json else "--mapping"
        raise ValueError(f"{idle} has no effect with --write-mapping; leave one of them out.")
    if file.suffix.lower() == ".nc" and any(reading[name] for name in reading if name != "partial"):
        from eigenwalker.population.population_file import looks_like_population

        if file.is_file() and looks_like_population(file):
            idle = next(each for name, each in OPTIONS.items() if reading[name])
            raise ValueError(f"{idle} is for captures; {file.name} is a population.")


OPTIONS = {"unit": "--unit", "rate_hz": "--rate", "subject": "--subject", "mapping": "--mapping"}


def _write_mapping(capture: Path, output: Path, reading: Reading) -> None:
    from eigenwalker.core.atomic_write import atomic_write
    from eigenwalker.io.read import read_mocap
    from eigenwalker.markers.mapping import mapping_to_begin_with
    from eigenwalker.study.marker_hints import marker_hints

    if output.suffix.lower() != ".toml":
        raise ValueError(f"--write-mapping {output}: a mapping is a .toml file.")
    del reading["mapping"]  # it is what is begun
    captured = read_mocap(capture, **reading)
    hints = marker_hints(captured)
    note = (
        "Left and right are by the direction of walking."
        if hints.sides_known
        else "The markers stay where they are: left and right may be exchanged in what is guessed."
    )
    markers = [str(name) for name in captured.marker.values]
    text = mapping_to_begin_with(markers, capture.name, hints.places, hints.joints, note)
    with atomic_write(output) as unfinished:
        unfinished.write_text(text, encoding="utf-8")
    n_named = sum(not line.startswith("#") and " = " in line for line in text.splitlines())
    n_near = text.count("# by its place")
    print(
        f"Mapping to be put right: {output}; {n_named} lines by names, {n_near} by places (take "
        f"the # away from those that are right). Then give it as --mapping {output}."
    )


def _in_options(value: str | list[str]) -> str | list[str]:
    return in_options(value) if isinstance(value, str) else [in_options(each) for each in value]


def _laid_out(value: str | list[str], indent: int) -> str:
    """Lay out one fact: short entries in running lines, sentences on lines of their own."""
    if isinstance(value, str):
        return value
    if all(len(entry) <= LONGEST_IN_LINE for entry in value):
        value = textwrap.wrap(", ".join(value), 100 - indent)
    return f"\n{' ' * indent}".join(value)
