"""The options of all commands that read captures, declared once."""

from __future__ import annotations

import functools
import inspect
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any, get_type_hints

from eigenwalker.cli.options import MappingFile, option

Reading = dict[str, Any]
"""Arguments of `read_mocap`, and ``mapping``, by their names in Python."""
Jobs = Annotated[int, option("Processes; -1 for all cores.")]
LowPass = Annotated[float | None, option("Cut-off in Hz of a low-pass filter, for noisy captures.")]
TraitsTable = Annotated[
    Path | None, option("CSV or XLSX with a column 'file' (relative to FOLDER) and the traits.")
]
Unit = Annotated[
    str | None, option("Unit of length, for files that name none: mm, cm, m, in, asf.")
]
Partial = Annotated[
    str, option("'keep' takes the whole frames of files that are cut short, and flags them.")
]


def _options(
    unit: Unit = None,
    rate: Annotated[float | None, option("Frames a second, for files that name none.")] = None,
    partial: Partial = "refuse",
    subject: Annotated[str | None, option("One person of files that hold several.")] = None,
    mapping: MappingFile = None,
) -> None: ...


def _check(reading: Reading) -> None:
    """Read the mapping, and refuse values that no capture could be read with."""
    from eigenwalker.io.read import checked_arguments
    from eigenwalker.markers.mapping import as_mapping

    checked_arguments(**{k: v for k, v in reading.items() if k not in ("subject", "mapping")})
    if reading["mapping"] is not None:
        reading["mapping"] = as_mapping(reading["mapping"]).as_dict()


def reads_captures(command: Callable[..., None], default: str = "") -> Callable[..., None]:
    """Return a command with these options in place of its parameter ``reading``, a dict of them.

    `default` is what Python's names of unit and rate begin with.
    """
    kind = inspect.Parameter.KEYWORD_ONLY
    options = inspect.signature(_options, eval_str=True).parameters

    @functools.wraps(command)
    def with_options(**values: Any) -> None:
        reading = {name: values.pop(name) for name in options}
        rate_and_unit = {"rate_hz": reading.pop("rate"), "unit": reading.pop("unit")}
        reading |= {f"{default}{name}": value for name, value in rate_and_unit.items()}
        _check(reading)
        command(**values, reading=reading)

    own, hints = inspect.signature(command).parameters, get_type_hints(command, include_extras=True)
    parameters = [each.replace(annotation=hints[name]) for name, each in own.items()]
    parameters[list(own).index("reading") :] = options.values()
    wrapper: Any = with_options
    wrapper.__signature__ = inspect.Signature([each.replace(kind=kind) for each in parameters])
    wrapper.__annotations__ = {each.name: each.annotation for each in parameters}
    return wrapper
