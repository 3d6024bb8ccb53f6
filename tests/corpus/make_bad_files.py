"""The corpus of known-bad files: what is wrong with each, and what must be said of it.

    python tests/corpus/make_bad_files.py FOLDER

writes them all, each into a folder of its own, with a table of what is expected. Its test is
``tests/test_bad_files.py``.
"""

from __future__ import annotations

import csv
import re
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

from corpus.bad_binary import bad_bml, bad_c3d, bad_mat, bad_netcdf
from corpus.bad_file import BadFile
from corpus.bad_places import no_files, wrong_contents, wrong_tables
from corpus.bad_text import cut_short, no_numbers, wrong_counts, wrong_grammar, wrong_rates
from corpus.bad_walks import no_walks, wrong_names, wrong_sides, wrong_units

BAD_FILES: tuple[BadFile, ...] = (
    *cut_short(),
    *no_numbers(),
    *wrong_counts(),
    *wrong_rates(),
    *wrong_grammar(),
    *bad_c3d(),
    *bad_netcdf(),
    *bad_mat(),
    *bad_bml(),
    *wrong_contents(),
    *no_files(),
    *wrong_tables(),
    *wrong_units(),
    *wrong_sides(),
    *wrong_names(),
    *no_walks(),
)


def main(folder: Path) -> None:
    """Write all bad files into a folder, each into one of its own, and the table of them."""
    folder.mkdir(parents=True)
    with (folder / "expected.tsv").open("w", encoding="utf-8", newline="") as file:
        table = csv.writer(file, delimiter="\t")
        table.writerow(["folder", "file", "what is wrong", "ending", "door", "said"])
        for number, bad in enumerate(BAD_FILES):
            where = folder / f"{number:03d}_{re.sub(r'[^a-z0-9]+', '_', bad.name.lower())}"
            where.mkdir()
            made = bad.make(where)
            table.writerow([where.name, made.name, bad.name, bad.ending, bad.door, bad.said])
    print(f"{len(BAD_FILES)} bad files in {folder}")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
