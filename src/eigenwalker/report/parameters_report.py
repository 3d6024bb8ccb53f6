"""The page of gait parameters: means by class, each capture, and what the columns mean."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from eigenwalker.core.atomic_write import atomic_write
from eigenwalker.plotting.parameter_figure import figure_parameters
from eigenwalker.plotting.style import CLASSES
from eigenwalker.population.persons import PERSON
from eigenwalker.report.blocks import Block, Report, Section, Table, Text
from eigenwalker.report.html_report import render_report
from eigenwalker.report.result_files import figure_files, made_with
from eigenwalker.report.words import TABLES, WORDS, figure
from eigenwalker.study.parameter_table import PERCENT, ParameterTable

MAX_LISTED = 200
"""Captures that the page lists; the table has all."""


def write_parameters_report(
    table: ParameterTable,
    path: str | Path,
    *,
    title: str = "Gait parameters",
    results: Sequence[str] = (),
    with_flagged: bool = False,
) -> Path:
    """Write gait parameters as a page, and its figure as SVG and PDF beside it.

    Parameters
    ----------
    table : ParameterTable
        Of captures.
    path : path
        Ends in ``.html``; the figures have the same name with another suffix.
    title : str
        Heading of the page.
    results : sequence of str
        Sentences at its top.
    with_flagged : bool
        Whether flagged captures count in means.

    Returns
    -------
    Path

    See Also
    --------
    eigenwalker.study.parameter_table : Measures a folder.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     _ = ew.write_mocap(ew.simulate_walk(seed=1), f"{folder}/anna.c3d")
    ...     table = ew.study.parameter_table(folder, n_jobs=1)
    ...     page = write_parameters_report(table, f"{folder}/parameters.html")
    ...     sorted(each.name for each in page.parent.glob("parameters.*"))
    ['parameters.html', 'parameters.pdf', 'parameters.svg']
    """
    path = Path(path)
    stem = path.with_name(path.name.removesuffix(path.suffix))
    counted = table.files["status"].isin(["used", "flagged"] if with_flagged else ["used"])
    files = table.files[counted]
    values = _values(files)
    trait = _grouping(files, table)
    blocks: list[Block] = [Text("No capture could be measured.")]
    if values and len(files):
        groups = [] if trait is None else files[trait].astype(str).tolist()
        drawn = figure_parameters(values, groups=groups)
        of = "all captures" if trait is None else f"captures by {trait}"
        blocks = [figure(drawn, "parameters", of=of), _means(values, groups)]
        figure_files(drawn, stem)
    sections = [
        Section("By capture" if trait is None else f"By {trait}", blocks),
        Section("Each capture", [_listed(table)]),
        Section("What the columns mean", [_meanings(table)]),
        Section("Made with", [made_with()]),
    ]
    page = render_report(Report(title, " ".join(results), sections))
    with atomic_write(path) as unfinished:
        unfinished.write_text(page, encoding="utf-8")
    return path


def _values(files: pd.DataFrame) -> dict[str, pd.Series]:
    """Return the parameters that are known, by title with unit."""
    values = {}
    for name, (title, factor, _) in WORDS["gait"].items():
        if name in files and files[name].notna().any():
            by = factor / PERCENT if title.endswith("%)") or "(% of" in title else factor
            values[title] = by * files[name].astype(float)
    return values


def _grouping(files: pd.DataFrame, table: ParameterTable) -> str | None:
    """Return the first trait in words by which captures fall into a few groups; None without."""
    book = table.codebook.set_index("column")["meaning"]
    for name in map(str, files):
        values = files[name]
        is_trait = str(book.get(name, "")).startswith("trait") and name != PERSON
        words = is_trait and not pd.api.types.is_numeric_dtype(values) and values.notna().all()
        if words and 2 <= values.nunique() <= min(len(CLASSES), len(values) // 2):
            return name
    return None


def _means(values: dict[str, pd.Series], groups: list[str]) -> Table:
    decimals = {title: number for title, _, number in WORDS["gait"].values()}
    rows, names = [], sorted(set(groups)) or ["all"]
    for title, column in values.items():
        of = pd.Series(groups or ["all"] * len(column), index=column.index)
        cells = []
        for name in names:
            known = column[of == name].dropna()
            spread = f" (SD {known.std():.{decimals[title]}f})" if len(known) > 1 else ""
            mean = f"{known.mean():z.{decimals[title]}f}"
            cells.append(f"{mean}{spread}" if len(known) else None)
        rows.append([title, *cells])
    counts = {name: groups.count(name) or len(next(iter(values.values()))) for name in names}
    heads = [f"{name} ({counts[name]})" for name in names]
    return Table(TABLES["parameters"], ["", *heads], rows)


def _listed(table: ParameterTable) -> Table:
    """Return the captures with what came of them, and their main parameters."""
    shown = table.files.head(MAX_LISTED)
    main = {"cadence_steps_min": "steps a minute", "speed_mm_s": "speed (mm/s)"}
    rows = [
        [str(row["file"]), str(row["status"]), *(_number(row.get(name)) for name in main),
         "" if pd.isna(row["reason"]) else str(row["reason"])]
        for _, row in shown.iterrows()
    ]  # fmt: skip
    more = len(table.files) - len(shown)
    caption = "Captures, and why some are flagged or refused"
    caption += f"; {more} more are in the table" if more else ""
    return Table(caption, ["capture", "status", *main.values(), "reason"], rows)


def _number(value: object) -> float | None:
    return None if value is None or pd.isna(value) else float(value)  # type: ignore[arg-type]


def _meanings(table: ParameterTable) -> Table:
    rows = table.codebook[["column", "unit", "meaning"]].fillna("").astype(str)
    return Table("Columns of the table", [*map(str, rows)], rows.to_numpy().tolist())
