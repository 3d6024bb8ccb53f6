"""What is typed, checked before a command runs: numbers are finite, nothing is empty or twice."""

from __future__ import annotations

import inspect
import math
from typing import Any, get_args

import typer

LARGEST = 10**18
"""Size of a whole number up to which it fits into a computer's own."""


def checked_values(command: Any) -> Any:
    """Return a command, or a group of commands, that refuses such values with the option's name."""
    for each in getattr(command, "commands", {}).values():
        checked_values(each)
    if not hasattr(command, "commands"):
        parse, types = command.parse_args, _types(command.callback)

        def parse_args(ctx: Any, args: list[str]) -> list[str]:
            if not ctx.resilient_parsing:
                _check(command, types, ctx, args)
            return parse(ctx, args)

        command.parse_args = parse_args
    return command


def _types(function: Any) -> dict[str, set[Any]]:
    """Return of each parameter the types that its annotation is made of."""

    def parts(annotation: Any) -> set[Any]:
        below = get_args(annotation)
        return set().union(*map(parts, below)) if below else {annotation}

    parameters = inspect.signature(function, eval_str=True).parameters.values()
    return {
        each.name: {p for p in parts(each.annotation) if isinstance(p, type)} for each in parameters
    }


def _check(command: Any, types: dict[str, set[Any]], ctx: Any, args: list[str]) -> None:
    values, _, order = command.make_parser(ctx).parse_args(args=list(args))
    for parameter in dict.fromkeys(order):
        given = values.get(parameter.name)
        texts = (
            [given] if isinstance(given, str) else given if isinstance(given, list | tuple) else []
        )
        once = parameter.param_type_name == "option" and not parameter.multiple and texts
        if once and order.count(parameter) > 1:
            raise typer.BadParameter("it is given twice; give it once.", ctx, parameter)
        low, high = (getattr(parameter, end, None) for end in ("min", "max"))
        for text in texts:
            if problem := _problem(text, types.get(parameter.name, set())):
                raise typer.BadParameter(problem, ctx, parameter)
            if low is not None and high is not None and not low <= float(text) <= high:
                expected = f"expected a number from {low} to {high}, got {text!r}."
                raise typer.BadParameter(expected, ctx, parameter)


def _problem(text: str, types: set[Any]) -> str:
    """Return what is wrong with a text where one of these types is due; empty if nothing is."""
    expected = "a whole number" if int in types else "a number" if float in types else ""
    if not text.strip():
        return f"expected {expected or 'a value'}, got nothing."
    if not expected:
        return ""
    try:
        number = int(text) if int in types else float(text)
    except ValueError:
        hint = ", with a decimal point" if "," in text else ""
        return f"expected {expected}{hint}, got {text!r}."
    if "_" in text or not math.isfinite(number) or (int in types and abs(number) > LARGEST):
        return f"expected {expected}, got {text!r}."
    return ""
