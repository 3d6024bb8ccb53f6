"""The data of an experiment as a Psych-DS folder: a tidy table, a codebook, and all materials."""

from __future__ import annotations

import csv
import json
import re
import shutil
import sqlite3
from collections.abc import Iterator, Sequence
from contextlib import closing
from itertools import islice
from operator import itemgetter
from pathlib import Path
from typing import Any

from eigenwalker._version import __version__
from eigenwalker.experiment import store
from eigenwalker.experiment.columns import (
    COLUMNS,
    FIGURES,
    ODD,
    PAIRS,
    QUESTIONS,
    RATING,
    RIGHT,
    SETTINGS,
    Column,
)
from eigenwalker.experiment.design import Design
from eigenwalker.experiment.experiment_folder import ANSWERS, VERSIONS, Material
from eigenwalker.experiment.showings import session_rows

_FORMULA = ("=", "+", "-", "@", "\t", "\r")
FROM_PAGES = ("response", "response_by", "outcome", "started_utc", "answer", "level", "stimulus")
"""Columns whose text comes from pages; none may be run as a formula by a spreadsheet."""
BATCH = 20_000
"""Rows that are written to Parquet at once."""


def export_experiment(folder: Path, output: Path, *, frames: bool = False) -> list[str]:
    """Write the data of an experiment into a folder, and return what was written.

    Reads only, also while a server writes; the same answers give the same bytes.
    """
    if output.exists() and any(output.iterdir()) and not (output / DESCRIPTION).exists():
        raise ValueError(f"{output} holds other things; name a new folder.")
    with closing(store.read_only(folder / ANSWERS)) as database:
        database.execute("BEGIN")  # one state of the data for all that is read
        materials = {
            row["version"]: Material(folder / VERSIONS / row["version"][:16])
            for row in store.versions(database)
        }
        used = {row["version"] for row in store.sessions(database)}
        designs = [materials[version].design for version in used] or [Material(folder).design]
        columns = _columns(designs)
        name = re.sub("[^A-Za-z0-9]", "", designs[0].name)
        table = output / "data" / f"study-{name}_data.csv"
        table.parent.mkdir(parents=True, exist_ok=True)
        written = _write_table(table, _all_rows(database, materials), [c.name for c in columns])
        if any(design.questions for design in designs):
            written.append(_write_questions(database, table.parent, name))
            columns = tuple({c.name: c for c in (*columns, *QUESTIONS)}.values())
        counts = store.counts(database)
        if frames:
            written.append(_write_frames(database, output / "data", name))
    _write_description(output, designs[0], columns, counts)
    _write_codebook(output / "documentation" / "codebook.csv", columns)
    for version in sorted(used):
        target = output / "materials" / f"version-{version[:16]}"
        if not target.exists():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copytree(materials[version].folder, target)
    return written


DESCRIPTION = "dataset_description.json"


def _columns(designs: list[Design]) -> tuple[Column, ...]:
    tasks = {block.task for design in designs for block in design.blocks}
    added = [(RIGHT, {"choice", "same_different", "odd_one_out", "detection"})]
    if any(getattr(block, "catch", None) for design in designs for block in design.blocks):
        added = [(RIGHT, tasks)]
    added += [
        (RATING, {"rating"}),
        (FIGURES, {"similar_pair", "same_different", "odd_one_out"}),
        (PAIRS, {"similar_pair"}),
        (ODD, {"odd_one_out"}),
        (SETTINGS, {"adjustment"}),
    ]
    return (*COLUMNS, *(column for columns, of in added if of & tasks for column in columns))


def _all_rows(database: Any, materials: dict[str, Material]) -> Iterator[dict[str, Any]]:
    for session in list(store.sessions(database)):
        material = materials[session["version"]]
        answers = store.answers_of(database, session["session"])
        yield from session_rows(session, answers, material.design, material.walker_names)


def _write_table(path: Path, rows: Iterator[dict[str, Any]], names: list[str]) -> list[str]:
    """Write rows as CSV, and as Parquet where its library is installed."""
    parquet = _ParquetTable(path.with_suffix(".parquet"), names)
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(names)
        empty, in_order = dict.fromkeys(names), itemgetter(*names)
        for row in rows:
            for name in FROM_PAGES:
                row[name] = _no_formula(row[name])
            values = in_order({**empty, **row})
            writer.writerow(values)
            parquet.add(values)
    parquet.close()
    return [str(path), str(parquet.path)]


def _no_formula(value: Any) -> Any:
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value


class _ParquetTable:
    """A Parquet file that grows by batches of rows."""

    MEASURED = ("_ms", "_deg")
    NUMBERS = ("level", "setting", "setting_start")
    WHOLE = (
        *("observer", "session", "block", "trial", "attempt", "repeated", "interrupted"),
        *("practice", "test", "simulated", "rating", "page_hidden", "focus_lost"),
        *("frames_shown", "frames_planned", "frames_dropped", "correct", "catch"),
    )

    def __init__(self, path: Path, names: list[str]) -> None:
        self.path, self._names = path, names
        self._rows: list[Sequence[Any]] = []
        import pyarrow as pa  # type: ignore[import]
        import pyarrow.parquet  # type: ignore[import]

        kinds = {
            **{name: pa.float64() for name in names if name.endswith(self.MEASURED)},
            **dict.fromkeys(self.NUMBERS, pa.float64()),
            **dict.fromkeys(self.WHOLE, pa.int64()),
        }
        self._pa = pa
        self._schema = pa.schema([(name, kinds.get(name, pa.string())) for name in names])
        self._writer: Any = pyarrow.parquet.ParquetWriter(path, self._schema)

    def add(self, values: Sequence[Any]) -> None:
        self._rows.append(values)
        if len(self._rows) >= BATCH:
            self._flush()

    def _flush(self) -> None:
        columns = zip(*self._rows, strict=True) if self._rows else [[] for _ in self._names]
        arrays = [
            self._pa.array(
                [
                    str(v) if v is not None and field.type == self._pa.string() else v
                    for v in column
                ],
                type=field.type,
            )
            for column, field in zip(columns, self._schema, strict=True)
        ]
        self._writer.write_table(self._pa.Table.from_arrays(arrays, schema=self._schema))
        self._rows = []

    def close(self) -> None:
        self._flush()
        self._writer.close()


def _write_questions(database: sqlite3.Connection, folder: Path, name: str) -> str:
    """Write the answers to questions, one a row; of a question asked again, all of them."""
    path = folder / f"study-{name}_questions_data.csv"
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow([column.name for column in QUESTIONS])
        for session in list(store.sessions(database)):
            for item in store.answers_of(database, session["session"]):
                given = item["content"].get("answers") if item["kind"] == "questions" else None
                for question, text in (given if isinstance(given, dict) else {}).items():
                    row = [session["observer"], session["number"], question, text]
                    writer.writerow([_no_formula(value) for value in row])
    return str(path)


def _write_frames(database: Any, folder: Path, name: str) -> str:
    """Write the times of all frames, one list an answer."""
    import pyarrow as pa  # type: ignore[import]
    import pyarrow.parquet as pq  # type: ignore[import]

    path = folder / f"study-{name}_frames.parquet"
    schema = pa.schema([("answer", pa.string()), ("frame_times_ms", pa.list_(pa.float64()))])
    with pq.ParquetWriter(path, schema) as writer:
        for rows in _batches(store.frame_times(database), 2000):
            columns = [[row[name] for row in rows] for name in ("answer", "frame_times")]
            writer.write_table(pa.table(columns, schema=schema))
    return str(path)


def _batches(rows: Iterator[dict[str, Any]], size: int) -> Iterator[list[dict[str, Any]]]:
    while batch := list(islice(rows, size)):
        yield batch


def _write_description(
    output: Path, design: Design, columns: tuple[Column, ...], counts: dict[str, Any]
) -> None:
    measured = [
        {
            "@type": "PropertyValue",
            "name": column.name,
            "description": column.meaning,
            **({"unitText": column.unit} if column.unit else {}),
        }
        for column in columns
    ]
    content = {
        "@context": "https://schema.org/",
        "@type": "Dataset",
        "name": design.name,
        "description": (
            f"Answers of observers in the experiment {design.name}, seed {design.seed}: one row "
            f"for each time a trial was shown. {counts['withdrawn']} observers withdrew, and "
            "their answers are deleted."
        ),
        "variableMeasured": measured,
        "creativeWorkStatus": f"exported by eigenwalker {__version__}",
    }
    text = json.dumps(content, indent=2, ensure_ascii=False) + "\n"
    (output / DESCRIPTION).write_text(text, encoding="utf-8")


def _write_codebook(path: Path, columns: tuple[Column, ...]) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["column", "meaning", "unit", "values", "source"])
        writer.writerows([c.name, c.meaning, c.unit, c.values, c.source] for c in columns)
