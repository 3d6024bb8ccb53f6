"""The page of the lab: how far the experiment is, and what is wrong; nothing on it changes data."""

from __future__ import annotations

from html import escape
from typing import Any

_PAGE = """<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta http-equiv="Content-Security-Policy" content="default-src 'none'; style-src 'unsafe-inline'">
<meta http-equiv="refresh" content="10">
<title>{name}</title>
<style>
body {{ font: 16px/1.5 system-ui, sans-serif; max-width: 50rem; margin: 2rem auto }}
table {{ border-collapse: collapse; margin: 1rem 0 }}
caption {{ text-align: start; font-weight: 600 }}
th, td {{ text-align: start; padding: 4px 16px 4px 0; border-bottom: 1px solid #ccc }}
.wrong {{ color: #a40000 }}
.button {{ border: 1px solid; border-radius: 4px; padding: 4px 12px }}
</style>
</head>
<body><main>
<h1>{name}</h1>
{trouble}
{tables}
<p><a class="button" href="{export}" download>Export the data</a> as a ZIP archive of tables,
codebook and materials. The page is read again every 10 s.</p>
</main></body>
</html>
"""


def lab_page(status: dict[str, Any], trouble: str, export: str) -> str:
    """Return the page, from the numbers of `experiment_status`; `export` is where its data are."""
    groups = [
        [name, group["finished_or_under_way"], group["wanted"], _listed(group["sessions"])]
        for name, group in status["groups"].items()
    ]
    counts = [
        ["answers and other reports, on disk", status["answers"]],
        ["refused for good, kept apart", status["refused"]],
        ["trials with dropped frames above the design's share", status["dropped_frames"]],
        ["sessions whose pages could store nothing", status["not_stored"]],
        ["test sessions", status["tests"]],
        ["simulated sessions", status["simulated"]],
        ["withdrawn observers", status["withdrawn"]],
    ]
    sentence = f"Answers cannot be written: {trouble}." if trouble else "Answers are being kept."
    return _PAGE.format(
        name=escape(status["name"]),
        export=escape(export),
        trouble=f'<p{" class=wrong" if trouble else ""} role="status">{escape(sentence)}</p>',
        tables=_table("Groups", ["group", "finished or under way", "wanted", "sessions"], groups)
        + _table("Counts", ["what", "number"], counts),
    )


def _listed(sessions: dict[str, int]) -> str:
    return ", ".join(f"{number} {outcome}" for outcome, number in sessions.items()) or "none"


def _table(title: str, head: list[str], rows: list[list[Any]]) -> str:
    heads = "".join(f'<th scope="col">{escape(each)}</th>' for each in head)
    lines = "".join(
        "<tr>" + "".join(f"<td>{escape(str(cell))}</td>" for cell in row) + "</tr>" for row in rows
    )
    return f"<table><caption>{escape(title)}</caption><tr>{heads}</tr>{lines}</table>\n"
