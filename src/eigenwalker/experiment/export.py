"""The data of an experiment as a Psych-DS folder: a tidy table, a codebook, and all materials."""

from __future__ import annotations

import json
import re
import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import closing
from itertools import islice
from pathlib import Path
from typing import Any

from eigenwalker._version import __version__
from eigenwalker.experiment import store
from eigenwalker.experiment.columns import (
    COLUMNS,
    FIGURES,
    FRAMES,
    ODD,
    PAIRS,
    QUESTIONS,
    RATING,
    RIGHT,
    SCREENS,
    SESSIONS,
    SETTINGS,
    Column,
)
from eigenwalker.experiment.design import Design
from eigenwalker.experiment.experiment_folder import ANSWERS, VERSIONS, Material
from eigenwalker.experiment.showings import Row, session_rows
from eigenwalker.experiment.table_files import write_codebook, write_table

Tables = dict[str, tuple[Column, ...]]
"""Columns of each table that was written; the table of trials has no name."""


def export_experiment(folder: Path, output: Path, *, frames: bool = False) -> list[str]:
    """Write the data of an experiment into a folder, and return what was written.

    Reads only, also while a server writes; the same answers give the same bytes.
    """
    if output.resolve().is_relative_to(folder.resolve()):
        raise ValueError(
            f"{output} lies inside {folder}, where a withdrawal must leave nothing; "
            "name a folder outside."
        )
    if output.exists() and any(output.iterdir()) and not (output / DESCRIPTION).exists():
        raise ValueError(f"{output} holds other things; name a new folder.")
    with closing(store.read_only(folder / ANSWERS)) as database:
        database.execute("BEGIN")  # one state of the data for all that is read
        used = store.versions_of_sessions(database)
        materials = {each: Material(folder / VERSIONS / each[:16]) for each in used}
        designs = [each.design for each in materials.values()] or [Material(folder).design]
        place = output / "data" / f"study-{re.sub('[^A-Za-z0-9]', '', designs[0].name)}"
        place.parent.mkdir(parents=True, exist_ok=True)
        tables = _tables(designs)
        rows = {
            "": _trials(database, materials),
            "sessions": _sessions(database),
            "screens": _reports(database, "screen"),
            "questions": _questions(database),
        }
        written: list[str] = []
        for name, columns in tables.items():
            path = _path(place, name)
            written += write_table(path, rows[name], [column.name for column in columns])
        if frames:
            tables["frames"] = FRAMES
            written.append(_write_frames(database, place))
        counts = store.counts(database)
    _write_description(output, designs[0], tables, counts)
    write_codebook(
        output / "documentation" / "codebook.csv",
        (
            (name or "trials", c.name, c.meaning, c.unit, c.values, c.source)
            for name, columns in tables.items()
            for c in columns
        ),
    )
    for version, material in materials.items():
        target = output / "materials" / f"version-{version[:16]}"
        if not target.exists():
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copytree(material.folder, target)
    return written


def _path(place: Path, table: str) -> Path:
    """Return the file of a table, under a name that Psych-DS takes."""
    middle = f"_description-{table}" if table else ""
    return place.with_name(f"{place.name}{middle}_data.csv")


def _tables(designs: list[Design]) -> Tables:
    has_questions = any(design.questions for design in designs)
    found = {"": _columns(designs), "sessions": SESSIONS, "screens": SCREENS}
    return {**found, "questions": QUESTIONS} if has_questions else found


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


def _trials(database: sqlite3.Connection, materials: dict[str, Material]) -> Iterator[Row]:
    for session in store.sessions(database):
        material = materials[session["version"]]
        trials = store.trials_of(database, session["session"])
        answers = store.answers_of(database, session["session"])
        whole = {**session, "trials": trials}
        yield from session_rows(whole, answers, material.design, material.walker_names)


def _sessions(database: sqlite3.Connection) -> Iterator[Row]:
    """Yield a row a session: who, when, and to what they agreed."""
    for session in store.sessions(database):
        yield {
            **_who(session),
            **{name: session[name] for name in ("language", "version", "consent_hash")},
            "started_utc": session["consent_utc"],
            "ended_utc": session["ended_utc"],
            "n_items": store.n_confirmed(database, session["session"]),
            "n_refused": store.n_refused(database, session["session"]),
        }


def _who(session: Row) -> Row:
    return {
        "observer": session["observer"],
        "session": session["number"],
        "group": session["group"],
        "test": int(session["observer_kind"] == "test"),
        "simulated": int(session["observer_kind"] == "simulated"),
        "session_outcome": session["outcome"] or "left",
    }


def _reports(database: sqlite3.Connection, kind: str) -> Iterator[Row]:
    """Yield what pages reported of one kind, one row a report."""
    for session in store.sessions(database):
        for content in store.reports_of(database, session["session"], kind):
            yield {**content, "observer": session["observer"], "session": session["number"]}


def _questions(database: sqlite3.Connection) -> Iterator[Row]:
    """Yield the answers to questions, one a row; of a question asked again, all of them."""
    for report in _reports(database, "questions"):
        given = report.get("answers")
        for question, text in (given if isinstance(given, dict) else {}).items():
            yield {**report, "question": question, "question_answer": text}


def _write_frames(database: sqlite3.Connection, place: Path) -> str:
    """Write the times of all frames, one list an answer."""
    import pyarrow as pa  # type: ignore[import]
    import pyarrow.parquet as pq  # type: ignore[import]

    path = place.with_name(f"{place.name}_frames.parquet")
    schema = pa.schema([("answer", pa.string()), ("frame_times_ms", pa.list_(pa.float64()))])
    with pq.ParquetWriter(path, schema) as writer:
        for rows in _batches(store.frame_times(database), 2000):
            times = [[t for t in each["frame_times"] if _is_number(t)] for each in rows]
            columns = [[each["answer"] for each in rows], times]
            writer.write_table(pa.table(columns, schema=schema))
    return str(path)


def _is_number(value: Any) -> bool:
    return isinstance(value, float) or (type(value) is int and abs(value) < 2**1000)


def _batches(rows: Iterator[dict[str, Any]], size: int) -> Iterator[list[dict[str, Any]]]:
    while batch := list(islice(rows, size)):
        yield batch


def _write_description(
    output: Path, design: Design, tables: Tables, counts: dict[str, Any]
) -> None:
    columns = {column.name: column for each in reversed(tables.values()) for column in each}
    measured = [
        {
            "@type": "PropertyValue",
            "name": column.name,
            "description": column.meaning,
            **({"unitText": column.unit} if column.unit else {}),
        }
        for column in sorted(columns.values(), key=lambda column: column.name)
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
