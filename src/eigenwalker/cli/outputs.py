"""What commands write: never over an input, nor over a file that they did not make.

A file is known as made by a command by its line in ``.eigenwalker`` in its folder: the command, and
size and time of the file as the command left it. One that was changed since counts as somebody's.
"""

from __future__ import annotations

import functools
import inspect
import json
import os
import re
import sys
from collections.abc import Iterator, Mapping
from contextlib import suppress
from itertools import islice
from pathlib import Path
from typing import Annotated, Any, get_type_hints

import typer

from eigenwalker.cli.options import check_folder, option

RECORD = ".eigenwalker"
"""File in a folder that says which files of it were made by which command."""
OUTPUT = "output"
"""Parameter of commands that names what is written."""
MORE_OUTPUTS = {"fit": "table", "simulate": "captures", "info": "write_mapping"}
"""Other such parameters, by the command."""
FOLDERS = ("classify", "compare", "demo", "captures")
"""Commands whose output is a folder, and parameters that name one."""
BESIDE = {
    "parameters": (".csv", ("-persons.csv", "-codebook.csv", ".json", ".html", ".svg", ".pdf")),
    "predict": (".csv", (".json",)),
    "stimulus": (".py", (".npz",)),
}
"""Suffixes of outputs, and ends of the names of what is written beside them."""
DEFAULTS = {"stimulus": "stim.json", "synthesize": "walker.mp4"}
"""Outputs of commands that decide them by how they are called."""
SAME = {"synthesize": "stimulus"}
"""Commands that are another by a second name."""
NOT_GUARDED = ("data", "plan", "run", "new", "plugin")
"""Commands whose folders grow by design, and are checked by themselves."""
MAX_BYTES = 10_000_000
MAX_NAMED = 3
MAX_FILES = 100_000
"""More in a folder are not looked at one by one."""

_Made = dict[str, list[Any]]


def guarded(command: Any, name: str) -> Any:
    """Return a command that refuses outputs that are inputs or somebody's.

    It gets the option ``--force``, which replaces them all the same. `command` is a function, or a
    group of such.
    """
    if name in NOT_GUARDED:
        return command
    if isinstance(command, typer.Typer):
        for each in command.registered_commands:
            function = each.callback
            if function is not None:
                below = each.name or function.__name__.rstrip("_").replace("_", "-")
                each.callback = guarded(function, below)
        return command
    parameters = inspect.signature(command).parameters
    written = {OUTPUT, MORE_OUTPUTS.get(name, OUTPUT)} & set(parameters)
    if not written or hasattr(command, "is_guarded"):
        return command
    has_force = "force" in parameters

    @functools.wraps(command)
    def checked(*args: Any, **values: Any) -> Any:
        force = values["force"] if has_force else values.pop("force", False)
        if name in DEFAULTS and values.get("output") is None:
            is_set = values.get("conditions") is not None
            values["output"] = Path("stimuli" if is_set else DEFAULTS[name])
        named = {each: Path(values[each]) for each in written if values.get(each) is not None}
        for parameter, output in named.items():
            is_folder = _is_folder(output, name, parameter, values)
            _check_name(output, name, is_folder=is_folder, option=_option(parameter))
        outputs = [*named.values(), *files_beside(named.get(OUTPUT), name)]
        given = (value for key, value in values.items() if key not in written)
        inputs = [path for value in given for path in _paths(value)]
        made_by = SAME.get(name, name)
        if len({os.path.realpath(output) for output in outputs}) < len(outputs):
            raise ValueError(f"{outputs[0]} is named for two outputs; name one file for each.")
        for output in () if force else outputs:
            _check_free(output, inputs, made_by)
        before = {output: _state(output) for output in outputs}
        try:
            result = command(*args, **values)
            if made_by == "stimulus" and not values.get("conditions"):
                _remove_older(outputs[0], before[outputs[0]], made_by)
            return result
        finally:
            for output in outputs:
                with suppress(OSError):  # a folder where nothing else can be written either
                    _record(output, before[output], made_by)

    hints = get_type_hints(command, include_extras=True)
    if not has_force:
        hints["force"] = Annotated[bool, option("Replace what is there, also an input.", "--force")]
    signature = [each.replace(annotation=hints[key]) for key, each in parameters.items()]
    if not has_force:
        kind = inspect.Parameter.KEYWORD_ONLY
        force = inspect.Parameter("force", kind, default=False, annotation=hints["force"])
        signature.append(force)
    wrapper: Any = checked
    wrapper.__signature__ = inspect.Signature(signature)
    wrapper.__annotations__ = hints
    wrapper.is_guarded = True
    return wrapper


def _paths(value: object) -> Iterator[Path]:
    """Return the files and folders that are there among the values of an option."""
    if isinstance(value, list | tuple):
        for each in value:
            yield from _paths(each)
    elif isinstance(value, str | Path) and 0 < len(str(value)) < 4096:
        with suppress(OSError, ValueError):
            if Path(value).exists():
                yield Path(value)


def _is_folder(output: Path, name: str, parameter: str, values: Mapping[str, Any]) -> bool:
    """Whether an output is a folder whatever it is called; sets and crowds of stimuli are such."""
    if parameter != OUTPUT or name not in DEFAULTS:
        return (name if parameter == OUTPUT else parameter) in FOLDERS
    is_crowd = values.get("crowd") is not None
    return values.get("conditions") is not None or (is_crowd and not output.suffix)


def files_beside(output: Path | None, name: str) -> list[Path]:
    """Return the files that are written beside an output."""
    suffix, ends = BESIDE.get(SAME.get(name, name), ("", ()))
    if output is None or output.suffix.lower() != suffix:
        return []
    return [output.with_name(f"{output.stem}{end}") for end in ends]


def _remove_older(output: Path, before: Mapping[str, list[int]], made_by: str) -> None:
    """Remove numbered files of an earlier call: its last pictures are no part of this film."""
    if not output.is_dir():
        return
    made, now = _made(output), _state(output)
    written = {re.sub(r"\d+", "#", name) for name in now if now[name] != before.get(name)}
    for name, state in before.items():
        is_left = now.get(name) == state and re.sub(r"\d+", "#", name) in written
        if is_left and made.get(name) == [made_by, *state]:
            (output / name).unlink()


def _option(parameter: str) -> str:
    return "-o" if parameter == OUTPUT else f"--{parameter.replace('_', '-')}"


def _check_name(output: Path, name: str, *, is_folder: bool, option: str) -> None:
    """Refuse names that are no file or folder of their own."""
    makes_stimuli = name in DEFAULTS
    what = "a file or a folder of its own"
    if makes_stimuli:
        from eigenwalker.stimulus.write_stimulus import SUFFIXES

        what = f"a file that ends in {', '.join(filter(None, SUFFIXES))}"
    if output in (Path(), Path("..")) or str(output) in ("/", "~"):
        raise ValueError(f"{option} {str(output)!r} names no file to write; name {what}.")
    if is_folder:
        check_folder(output, option)
        return
    with_slash = any(
        word.endswith(("/", os.sep)) and Path(word.rpartition("=")[2]) == output
        for word in sys.argv
    )
    if makes_stimuli and not (output.suffix or output.is_dir() or with_slash):
        raise ValueError(
            f"-o {output} has no suffix; name {what}. For a folder of pictures, one a frame, write "
            f"{output}{os.sep}"
        )


def _check_free(output: Path, inputs: list[Path], made_by: str) -> None:
    """Refuse an output that is an input, or that this kind of command did not make."""
    if not output.exists():
        return
    for path in inputs:
        if path.is_file() and os.path.samefile(path, output):
            raise ValueError(
                f"{output} is read by this command, and would be replaced; name another file to "
                "write, or give --force to replace it."
            )
    made = _made(output if output.is_dir() else Path(os.path.realpath(output)).parent)
    foreign = [
        name for name, state in _state(output).items() if made.get(name) != [made_by, *state]
    ]
    if not foreign:
        return
    if output.is_dir():
        more = f" and {len(foreign) - MAX_NAMED} more" if len(foreign) > MAX_NAMED else ""
        raise ValueError(
            f"{output} holds files that eigenwalker {made_by} did not make, or that were changed "
            f"since: {', '.join(sorted(foreign)[:MAX_NAMED])}{more}. Name an empty or a new "
            "folder, or give --force to write into it."
        )
    raise ValueError(
        f"{output} is there, and was not made by eigenwalker {made_by}, or was changed since; name "
        "another file, or give --force to replace it."
    )


def _state(output: Path) -> dict[str, list[int]]:
    """Return size and time of an output, or of the files in one that is a folder, by name."""
    if not output.is_dir():
        files = {Path(os.path.realpath(output)).name: output} if output.exists() else {}
    else:
        below = islice((path for path in output.rglob("*") if path.is_file()), MAX_FILES)
        files = {path.relative_to(output).as_posix(): path for path in below}
    stats = {name: path.stat() for name, path in files.items() if not _is_hidden(name)}
    return {name: [stat.st_size, stat.st_mtime_ns] for name, stat in stats.items()}


def _is_hidden(name: str) -> bool:
    return any(part.startswith(".") for part in Path(name).parts)


def _made(folder: Path) -> _Made:
    """Return which files of a folder were made by which command, as its record says."""
    try:
        with (folder / RECORD).open("rb") as file:
            entries = json.loads(file.read(MAX_BYTES))
    except (OSError, ValueError, RecursionError):
        return {}
    return entries if isinstance(entries, dict) else {}


def _record(output: Path, before: Mapping[str, list[int]], made_by: str) -> None:
    """Keep which files of an output the command made or replaced."""
    new = {name: state for name, state in _state(output).items() if before.get(name) != state}
    if not new:
        return
    folder = output if output.is_dir() else Path(os.path.realpath(output)).parent
    made = {name: entry for name, entry in _made(folder).items() if (folder / name).exists()}
    made |= {name: [made_by, *state] for name, state in new.items()}
    from eigenwalker.core.atomic_write import atomic_write

    with atomic_write(folder / RECORD) as unfinished:
        unfinished.write_text(json.dumps(made, indent=0, sort_keys=True), encoding="utf-8")
