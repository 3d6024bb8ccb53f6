"""What was done to make a stimulus: texts for its file, and the line that the terminal prints."""

from __future__ import annotations

import hashlib
import shlex
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from eigenwalker._version import __version__

if TYPE_CHECKING:
    from eigenwalker.population.population import Population

LONGEST = 2000
"""Letters of one text in a stimulus file."""


def of_a_walker(population: Population, options: dict[str, Any]) -> dict[str, str]:
    """Return the provenance of a stimulus whose walker is made from a population."""
    from eigenwalker.analysis.contrast import trait_contrast
    from eigenwalker.cli.options import is_published, parse_trait_steps
    from eigenwalker.datasets.built_in import BUILT_IN

    path, start = options["people"], options["start_from"]
    steps = [parse_trait_steps(text) for text in options["trait"] or ()]
    about = {
        "population": BUILT_IN if path is None else Path(path).name,
        "population_sha256": population_sha256(path),
        "started_from": {"average": "the average walker"}.get(start, _start_text(start)),
        "information": options["information"] or "full",
        "size": "kept" if options["keep_size"] or is_published(path) else "divided out",
    }
    if steps or options["morph_to"]:
        contrasts = [trait_contrast(population, trait) for trait, _ in steps]
        about |= {
            "trait": "; ".join(trait for trait, _ in steps),
            "standard_deviations": "; ".join(f"{sds:+g}" for _, sds in steps),
            "towards": "; ".join(
                contrast.positive if sds >= 0 else contrast.negative
                for contrast, (_, sds) in zip(contrasts, steps, strict=True)
            ),
            "morph_to": "; ".join(options["morph_to"] or ()),
            "kind": "published" if is_published(path) else options["kind"],
            "part": options["part"],
            "components": "" if is_published(path) else str(options["components"]),
            "adjust": "; ".join(options.get("adjust") or ()) or "nothing",
        }
    about |= {"source": about["population"], "command": command()}
    return {name: text[:LONGEST] for name, text in about.items() if text}


def of_a_file(path: Path, earlier: Mapping[str, str]) -> dict[str, str]:
    """Return the provenance of a stimulus that is made from one in a file."""
    about = {**earlier, "made_from": f"{path.name}, sha256 {_sha256(path.read_bytes())}"}
    before = earlier.get("command") or earlier.get("call")
    about["command"] = f"{before}; then {command()}" if before else command()
    about["program"] = f"eigenwalker {__version__}"
    return {name: text[-LONGEST:] for name, text in about.items()}


def command() -> str:
    """Return what was typed."""
    typed = " ".join(["eigenwalker", *map(shlex.quote, sys.argv[1:])])
    return typed.encode("utf-8", "replace").decode()[:LONGEST]


def population_sha256(path: Path | None) -> str:
    """Return the hash of a population's file; of the built-in one, of its features to 1e-6."""
    from eigenwalker.datasets.built_in import load_population

    if path is not None:
        return _sha256(Path(path).read_bytes())
    return _sha256(load_population().X.round(6).astype("<f8").tobytes())


def walker_line(about: Mapping[str, str]) -> str:
    """Return who walks, as one line: traits, information, and what it started from."""
    if "population" not in about:
        return f"Walker: as in {about['made_from'].partition(',')[0]}"
    columns = [about.get(name, "").split("; ") for name in ("trait", "standard_deviations")]
    poles = about.get("towards", "").split("; ")
    parts = [
        f"{trait} {steps.lstrip('+-')} SD towards {pole}"
        for trait, steps, pole in zip(*columns, poles, strict=True)
        if trait
    ]
    if parts:
        of = f" of {about['components']} eigenwalkers" if "components" in about else ""
        parts.append(f"{about['kind']} axis{of}, part {about['part']}")
    if about["information"] != "full":
        parts.append(f"{about['information']} only")
    return "Walker: " + ", ".join([*parts, f"from {about['started_from']}"])


def _start_text(start: str) -> str:
    if start.isdecimal():
        return f"walker {start} of the population"
    path = Path(start)
    return f"{path.name}, sha256 {_sha256(path.read_bytes())}" if path.is_file() else path.name


def _sha256(content: bytes) -> str:
    return hashlib.sha256(content).hexdigest()
