"""A set of stimuli from a table: ``eigenwalker stimulus --conditions conditions.csv -o set/``."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from difflib import get_close_matches
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from eigenwalker.cli.options import progress_bar, sized_people
from eigenwalker.cli.outputs import files_beside
from eigenwalker.cli.stimulus_options import typed_options

if TYPE_CHECKING:
    import pandas as pd
    import typer

    from eigenwalker.stimulus.rig_choices import RigChoices
    from eigenwalker.stimulus.stimulus import Stimulus

MANIFEST = "stimuli.csv"
"""The table, with the file of each row, that stands beside the stimuli."""
NAMES = ("name", "file")
"""Columns that name the stimuli, rather than an option."""
_MOST_ROWS = 10_000
_NOT_IN_ROWS = ("conditions", "output", "people", "mapping", "crowd", "help")
_ON, _OFF = ("1", "true", "yes", "x", "on"), ("0", "false", "no", "off")
Make = Callable[[dict[str, Any], bool, Callable[..., Any]], "tuple[Stimulus, RigChoices]"]


class _Row(NamedTuple):
    file: Path
    options: dict[str, Any]
    where: str


def write_set(context: typer.Context, table: Path, folder: Path, make: Make) -> None:
    """Write one stimulus a row into a folder, and the table that says which is which.

    All rows are made before one is written; what is wrong in a row is refused with its place.
    """
    from functools import cache

    from eigenwalker.stimulus.write_stimulus import write_stimulus

    if folder.suffix:
        raise ValueError(f"-o {folder}: a table of conditions makes a folder; name one, as set/.")
    if context.params["crowd"] is not None:
        raise ValueError("--crowd makes one file of many people; it goes without --conditions.")
    cells = _cells(table)
    rows = list(_rows(context, cells, table, folder))
    people, made = cache(sized_people), []
    new = not folder.exists()
    folder.mkdir(parents=True, exist_ok=True)
    for row in rows:
        try:
            made.append(make(row.options, False, people))
        except (ValueError, OSError) as error:
            if new:
                folder.rmdir()
            raise ValueError(f"{row.where}: {error}") from error
    with progress_bar("Writing") as progress:
        for number, (row, (stimulus, rig)) in enumerate(zip(rows, made, strict=True), start=1):
            write_stimulus(stimulus, row.file, rig=rig)
            progress(number, len(rows))
    print(f"{len(rows)} stimuli: {folder}\nWhich is which: {_write_manifest(cells, rows, folder)}")


def _cells(table: Path) -> pd.DataFrame:
    from eigenwalker.study.traits_file import read_traits_file

    try:
        cells = read_traits_file(table)
    except ValueError as error:
        raise ValueError(str(error).replace("traits table", "table of conditions")) from error
    if len(cells) > _MOST_ROWS:
        raise ValueError(f"{table} has {len(cells)} rows; a set has {_MOST_ROWS} stimuli at most.")
    return cells


def _rows(context: typer.Context, cells: pd.DataFrame, table: Path, folder: Path) -> Iterator[_Row]:
    import typer

    # click's UsageError, wherever typer has click from:
    refusals: Any = typer.BadParameter.__bases__
    typed = typed_options(context)
    columns = _options_of(context.command, [str(name) for name in cells], table)
    named = next((name for name in map(str, cells) if name.lower() in NAMES), None)
    lines, files = cells.attrs["line"], set[str]()
    for number, (line, row) in enumerate(zip(lines, cells.to_dict("records"), strict=True)):
        where = f"{table.name}, line {line}"
        file = _file(row[named] if named else f"stimulus_{number + 1:03d}", folder, where)
        if file.name.lower() == MANIFEST:
            raise ValueError(
                f"{where}: {MANIFEST} says which stimulus is which; name it otherwise."
            )
        written = {file.name.lower()} | {
            beside.name.lower() for beside in files_beside(file, "stimulus")
        }
        if files & written:
            raise ValueError(f"{where}: another row is called {file.name!r} too; name each once.")
        files |= written
        words = [
            word for name, option in columns.items() for word in _words(row[name], option, where)
        ]
        try:
            own = context.command.make_context(str(context.info_name), words, parent=context.parent)
        except refusals as error:
            raise ValueError(f"{where}: {error.format_message()}") from error
        options = {**own.params, **typed, **typed_options(own), "output": file, "conditions": None}
        options |= {name: list(v) or None for name, v in options.items() if isinstance(v, tuple)}
        for name in ("people", "mapping"):
            options[name] = options[name] and Path(options[name])
        options |= {"quiet": True, "typed": {*typed, *typed_options(own)} - {"conditions"}}
        yield _Row(file, options, f"{where} ({file.name})")


def _options_of(command: Any, headings: list[str], table: Path) -> dict[str, Any]:
    """Return the option that each column is about."""
    known = {
        word.lstrip("-").replace("-", "_"): option
        for option in command.params
        if option.name not in _NOT_IN_ROWS
        for word in option.opts
        if word.startswith("--")
    }
    columns = {}
    for heading in headings:
        plain = heading.strip().lstrip("-").lower().replace("-", "_").replace(" ", "_")
        if plain in NAMES:
            continue
        if plain not in known:
            near = get_close_matches(plain, [*known, *NAMES], n=1)
            guess = f"did you mean {near[0]!r}?" if near else f"options are {sorted(known)}."
            raise ValueError(
                f"{table.name}: the column {heading!r} is no option of stimulus; {guess}"
            )
        columns[heading] = known[plain]
    return columns


def _words(cell: str, option: Any, where: str) -> list[str]:
    """Return a cell as the words that would be typed; empty cells leave the option out."""
    name = next(word for word in option.opts if word.startswith("--"))
    if not cell:
        return []
    if option.is_flag:
        if cell.lower() not in (*_ON, *_OFF):
            raise ValueError(f"{where}: {name} is yes or no, got {cell!r}.")
        return [name] if cell.lower() in _ON else []
    values = cell.split(";") if option.multiple else [cell]
    return [word for value in values if value.strip() for word in (name, value.strip())]


def _file(name: str, folder: Path, where: str) -> Path:
    """Return the file of a stimulus: JSON, unless its name says something else."""
    from eigenwalker.stimulus.write_stimulus import SUFFIXES

    if not name or name.startswith(".") or Path(name).name != name or set(name) & set('\\/:*?"<>|'):
        raise ValueError(f"{where}: {name!r} is no name for a file; use letters, digits, - and _.")
    return folder / (name if Path(name).suffix.lower() in SUFFIXES else f"{name}.json")


def _write_manifest(cells: pd.DataFrame, rows: list[_Row], folder: Path) -> Path:
    from eigenwalker.core.atomic_write import write_table

    others = [column for column in cells if str(column).lower() != "file"]
    table = cells[others].copy()
    table.insert(0, "file", [row.file.name for row in rows])
    return write_table(table, folder / MANIFEST, index=False)
