"""Tables of the export: a CSV and a Parquet file that grow by batches of rows."""

from __future__ import annotations

import csv
import json
import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import islice
from operator import itemgetter
from pathlib import Path
from typing import Any

BATCH = 20_000
"""Rows that are written at once."""
MEASURED = ("_ms", "_deg", "_mm", "_hz", "_cm", "_cm_step", "_ratio")
"""Ends of the names of columns of numbers."""
NUMBERS = ("level", "setting", "setting_start")
WHOLE = (
    *("observer", "session", "block", "trial", "attempt", "repeated", "interrupted"),
    *("practice", "test", "simulated", "rating", "page_hidden", "focus_lost", "n_items"),
    *("frames_shown", "frames_planned", "frames_dropped", "correct", "catch", "n_refused"),
    *("width_px", "height_px", "touch", "clock_isolated", "stored"),
)
TEXTS = ("distance_settings_mm",)
_FORMULA = r"^[=+\-@\t\r]"
_A_NUMBER = r"^[+-]\d+(\.\d+)?([eE][+-]?\d+)?$"


def write_table(path: Path, rows: Iterable[Mapping[str, Any]], names: Sequence[str]) -> list[str]:
    """Write rows as CSV and Parquet, and return both paths.

    What pages report may be anything: what is no number is left out of a column of numbers, and
    no text is one that a spreadsheet runs as a formula.
    """
    import pyarrow as pa  # type: ignore[import]
    import pyarrow.parquet as pq  # type: ignore[import]

    kinds = {name: _kind(pa, name) for name in names}
    schema, empty = pa.schema(kinds.items()), dict.fromkeys(names)
    in_order, left = itemgetter(*names), iter(rows)
    binary = path.with_suffix(".parquet")
    with path.open("wb") as file, pq.ParquetWriter(binary, schema) as parquet:
        file.write((",".join(names) + "\n").encode())
        while batch := [in_order({**empty, **row}) for row in islice(left, BATCH)]:
            columns = zip(*batch, strict=True)
            arrays = [_array(pa, list(c), kinds[n]) for n, c in zip(names, columns, strict=True)]
            table = pa.Table.from_arrays(arrays, schema=schema)
            parquet.write_table(table)
            _write_csv(table, file)
    return [str(path), str(binary)]


def _kind(pa: Any, name: str) -> Any:
    if name in WHOLE or name in TEXTS:
        return pa.int64() if name in WHOLE else pa.string()
    return pa.float64() if name.endswith(MEASURED) or name in NUMBERS else pa.string()


def _array(pa: Any, values: list[Any], kind: Any) -> Any:
    """Return a column, in one go where all values are what they should be."""
    from pyarrow import compute  # type: ignore[import]

    pc: Any = compute
    try:
        if kind == pa.int64() and float in set(map(type, values)):
            raise TypeError("numbers with fractions would be cut")
        array = pa.array(values, kind)
    except (pa.ArrowException, ValueError, TypeError, OverflowError):
        clean = _text if kind == pa.string() else _whole if kind == pa.int64() else _number
        array = pa.array([None if value is None else clean(value) for value in values], kind)
    if kind != pa.string():
        return array
    formulas = pc.and_not(
        pc.match_substring_regex(array, _FORMULA), pc.match_substring_regex(array, _A_NUMBER)
    )
    if not pc.any(formulas).as_py():
        return array
    return pc.if_else(formulas, pc.binary_join_element_wise("'", array, ""), array)


def _text(value: Any) -> str:
    text = str(value) if isinstance(value, str | int | float) else json.dumps(value)
    return text.encode("utf-8", "replace").decode()


def _number(value: Any) -> float | None:
    if isinstance(value, bool) or not isinstance(value, int | float):
        return None
    return float(value) if abs(value) < 2**1000 and not math.isnan(value) else None


def _whole(value: Any) -> int | None:
    if isinstance(value, int):
        return int(value) if abs(value) < 2**63 else None
    number = _number(value)
    return (
        int(number) if number is not None and number.is_integer() and abs(number) < 2**53 else None
    )


def _write_csv(table: Any, file: Any) -> None:
    """Write rows, with quotes only where a text of the batch needs them."""
    import pyarrow as pa  # type: ignore[import]
    import pyarrow.csv as pacsv  # type: ignore[import]

    def written(style: str) -> Any:
        buffer = pa.BufferOutputStream()
        options = pacsv.WriteOptions(include_header=False, quoting_style=style)
        pacsv.write_csv(table, buffer, options)
        return buffer.getvalue()

    try:
        rows = written("none")  # refuses what needs quotes
    except pa.ArrowInvalid:
        rows = written("needed")
    file.write(rows)


def write_codebook(path: Path, lines: Iterable[Sequence[str]]) -> None:
    """Write what each column means."""
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(["table", "column", "meaning", "unit", "values", "source"])
        writer.writerows(lines)
