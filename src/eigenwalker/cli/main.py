"""The command line ``eigenwalker``: its commands, each loaded when it is called."""

from __future__ import annotations

import sys
import warnings
from importlib import import_module
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from eigenwalker.cli.options import EXIT_FAILED

COMMANDS = {
    "demo": ("classify_command", "Classify a trait, and write a page to play with the walkers."),
    "serve": ("serve_command", "Serve the interactive page, which then reads captures."),
    "info": ("capture_commands", "Say what is in a file, and what is wrong with it."),
    "convert": ("capture_commands", "Write a capture in another format."),
    "fit": ("population_commands", "Make a population of a folder of captures."),
    "simulate": ("population_commands", "Simulate walkers of known truth, and their captures."),
    "classify": ("classify_command", "Tell a trait from gait, and say how surely."),
    "synthesize": ("synthesize_command", "Film a walker, moved along traits."),
    "stimulus": ("stimulus_command", "Make a stimulus: a walker, transforms, and a view."),
    "compare": ("compare_command", "Say how different walks look."),
    "data": ("data_commands", "List and fetch captures that others published."),
}
"""The module of each command, and its line in the help of all."""


class _LazyGroup(TyperGroup):
    """Loads a command's module only to run it, so that the help of all answers at once."""

    def __init__(self, **settings: Any) -> None:
        super().__init__(**settings)
        self.commands = dict.fromkeys(COMMANDS)  # pyright: ignore[reportAttributeAccessIssue] - names to suggest

    def get_command(self, ctx: Any, cmd_name: str) -> Any:
        if cmd_name not in COMMANDS:
            return None
        module, _ = COMMANDS[cmd_name]
        command = getattr(import_module(f"eigenwalker.cli.{module}"), cmd_name)
        if not isinstance(command, typer.Typer):
            function, command = command, typer.Typer(rich_markup_mode=None, add_completion=False)
            command.command(cmd_name)(function)
        return typer.main.get_command(command)

    def format_commands(self, ctx: Any, formatter: Any) -> None:
        with formatter.section("Commands"):
            formatter.write_dl([(name, line) for name, (_, line) in COMMANDS.items()])


app = typer.Typer(
    cls=_LazyGroup,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
    no_args_is_help=True,
    add_completion=False,
    context_settings={"help_option_names": ["-h", "--help"]},
    help="How people walk: from captures to a model, classifiers, and walkers of any trait.",
)


def main() -> None:
    """Run the command line; errors and warnings are printed as sentences, without a traceback."""
    warnings.showwarning = _print_warning
    try:
        app()
    except (ValueError, OSError) as error:
        print(f"eigenwalker: {error}", file=sys.stderr)
        sys.exit(EXIT_FAILED)


def _print_warning(message: Warning | str, *_: object, **__: object) -> None:
    print(f"eigenwalker: {message}", file=sys.stderr)


@app.callback(invoke_without_command=True)
def _version(
    version: Annotated[bool, typer.Option("--version", help="Say the version and end.")] = False,
) -> None:
    if version:
        from eigenwalker._version import __version__

        print(f"eigenwalker {__version__}")
        raise typer.Exit
