"""The content of a report, apart from how it looks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import matplotlib.figure


@dataclass(frozen=True)
class Text:
    """A paragraph of plain text.

    See Also
    --------
    write_report : Lays blocks out.
    """

    text: str


@dataclass(frozen=True)
class Items:
    """A list of plain text, one point each.

    See Also
    --------
    write_report : Lays blocks out.
    """

    items: Sequence[str]


@dataclass(frozen=True)
class Code:
    """Lines to copy as they stand: a command, a reference.

    See Also
    --------
    write_report : Lays blocks out.
    """

    lines: str


Cell = str | int | float | None


@dataclass(frozen=True)
class Table:
    """A table whose first column names the rows.

    Numbers are set at the right, fractions with three figures; None and NaN are dashes.

    See Also
    --------
    write_report : Lays blocks out.
    """

    caption: str
    columns: Sequence[str]
    rows: Sequence[Sequence[Cell]]

    def __post_init__(self) -> None:
        for row in self.rows:
            if len(row) != len(self.columns):
                raise ValueError(
                    f"The table {self.caption!r} has {len(self.columns)} columns "
                    f"{list(self.columns)}, and a row of {len(row)} cells: {list(row)}."
                )


@dataclass(frozen=True)
class Figure:
    """A matplotlib figure, a caption that says what to see in it, and text for screen readers.

    See Also
    --------
    write_report : Lays blocks out.
    """

    figure: matplotlib.figure.Figure
    caption: str
    alt: str


@dataclass(frozen=True)
class Film:
    """A film in a file (MP4, WebM or GIF), its caption, and text for screen readers.

    See Also
    --------
    write_report : Lays blocks out.
    """

    path: Path
    caption: str
    alt: str


Block = Text | Items | Code | Table | Figure | Film


@dataclass(frozen=True)
class Section:
    """A heading and the blocks under it.

    See Also
    --------
    write_report : Lays blocks out.
    """

    title: str
    blocks: Sequence[Block]


@dataclass(frozen=True)
class Link:
    """The text of a link, and the name of the file in the report's folder to which it leads.

    See Also
    --------
    write_report : Lays blocks out.
    """

    text: str
    file: str

    def __post_init__(self) -> None:
        if self.file != Path(self.file).name or ":" in self.file:
            raise ValueError(f"A report links to files beside it; {self.file!r} is none.")


@dataclass(frozen=True)
class Report:
    """A title, a lead with the main result, sections, and perhaps a link to a page beside it.

    See Also
    --------
    write_report : Makes a page of it.

    Examples
    --------
    >>> data = Section("Data", [Text("Twenty women and twenty men.")])
    >>> Report("Sex from gait", "Three of 40 walkers are misclassified.", [data]).title
    'Sex from gait'
    """

    title: str
    lead: str
    sections: Sequence[Section] = ()
    beside: Link | None = None
