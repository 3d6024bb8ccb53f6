"""Results to take away from a report: tables as CSV and JSON, figures as SVG and PDF."""

from __future__ import annotations

import json
import platform
import shlex
import sys
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib.metadata import version
from pathlib import Path
from typing import Any

import matplotlib as mpl
import matplotlib.figure
import pandas as pd

from eigenwalker._version import __version__
from eigenwalker.core.atomic_write import atomic_write, write_table
from eigenwalker.report.blocks import Code, Figure, Report, Table

FIGURES = (".svg", ".pdf")
_LIBRARIES = ("numpy", "scipy", "scikit-learn", "xarray")


def write_json(content: Mapping[str, Any], path: Path) -> Path:
    """Write tables and facts as one JSON file, which says its program; return its path.

    Tables are lists of rows; what is not known is null.
    """
    made = {"program": f"eigenwalker {__version__}", "date": datetime.now(UTC).date().isoformat()}
    plain = {name: _plain(value) for name, value in content.items()}
    with atomic_write(path) as unfinished:
        text = json.dumps({**made, **plain}, indent=1, ensure_ascii=False, allow_nan=False)
        unfinished.write_text(text + "\n", encoding="utf-8", errors="backslashreplace")
    return path


def _plain(value: Any) -> Any:
    if isinstance(value, pd.DataFrame):
        return json.loads(value.to_json(orient="records", double_precision=12))
    if isinstance(value, float) and value != value:
        return None
    return value


def write_figures(figures: Mapping[str, matplotlib.figure.Figure], folder: Path) -> list[Path]:
    """Write figures by name as SVG and PDF into a folder; return their paths."""
    folder.mkdir(parents=True, exist_ok=True)
    paths = []
    for name, drawn in figures.items():
        plain = "-".join("".join(c if c.isalnum() else " " for c in name).split())
        paths += figure_files(drawn, folder / plain)
    return paths


def figure_files(drawn: matplotlib.figure.Figure, stem: Path) -> list[Path]:
    """Write a figure as SVG and PDF; return their paths."""
    paths = []
    for suffix in FIGURES:
        path = stem.with_name(f"{stem.name}{suffix}")
        fonts: Any = {"svg.hashsalt": "eigenwalker", "svg.fonttype": "none", "pdf.fonttype": 42}
        metadata = {".svg": {"Date": None}, ".pdf": {"CreationDate": None}}[suffix]
        with mpl.rc_context(fonts), atomic_write(path) as unfinished:
            drawn.savefig(unfinished, metadata=metadata)
        paths.append(path)
    return paths


def made_with(*lines: str) -> Code:
    """Return what a result was made with: command, program, versions, date; then other lines."""
    typed = Path(sys.argv[0]).name in ("eigenwalker", "eigenwalker.exe", "__main__.py")
    call = shlex.join(["eigenwalker", *sys.argv[1:]]) if typed else "called from Python"
    libraries = ", ".join(f"{name} {version(name)}" for name in _LIBRARIES)
    return Code(
        "\n".join(
            [
                call,
                f"eigenwalker {__version__}, Python {platform.python_version()}, {libraries}",
                datetime.now(UTC).date().isoformat(),
                *lines,
            ]
        )
    )


def write_blocks(report: Report, folder: Path) -> None:
    """Write the tables of a report as CSV and JSON, and its figures as SVG and PDF, beside it."""
    figures: dict[str, matplotlib.figure.Figure] = {}
    tables: dict[str, pd.DataFrame] = {}
    for section in report.sections:
        for number, block in enumerate(section.blocks, start=1):
            name = f"{section.title} {number}".lower().replace(" ", "-")
            if isinstance(block, Figure):
                figures[name] = block.figure
            elif isinstance(block, Table):
                tables[name] = pd.DataFrame(
                    [list(row) for row in block.rows], columns=list(block.columns)
                )
    (folder / "tables").mkdir(parents=True, exist_ok=True)
    write_tables(tables, folder / "tables")
    write_figures(figures, folder / "figures")
    lead = {"title": report.title, "results": report.lead}
    write_json(lead | tables, folder / "results.json")


def write_tables(tables: Mapping[str, pd.DataFrame], folder: Path) -> list[Path]:
    """Write tables by name as CSV into a folder; return their paths."""
    return [
        write_table(table, folder / f"{name}.csv", index=False) for name, table in tables.items()
    ]
