"""The command line ``eigenwalker``: its commands, each loaded when it is called."""

from __future__ import annotations

import gc
import os
import sys
import warnings
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any

from eigenwalker.cli.exit_codes import EXIT_FAILED
from eigenwalker.cli.printing import print_without_fail, printing_error

COMMANDS = {
    "demo": ("classify_command", "Classify a trait, and write a page to play with the walkers."),
    "serve": ("serve_command", "Serve the interactive page, which then reads captures."),
    "info": ("capture_commands", "Say what is in a file, and what is wrong with it."),
    "parameters": ("parameters_command", "Measure the gait of all captures of a folder."),
    "predict": ("predict_command", "Tell a trait of new captures, and how sure that is."),
    "convert": ("capture_commands", "Write a capture in another format."),
    "fit": ("population_commands", "Make a population of a folder of captures."),
    "simulate": ("population_commands", "Simulate walkers of known truth, and their captures."),
    "classify": ("classify_command", "Tell a trait from gait, and say how surely."),
    "stimulus": ("stimulus_command", "Make a walker, and write it as a stimulus, a film, a rig."),
    "synthesize": ("stimulus_command", "The same as stimulus; a film, if no file is named."),
    "plugin": ("plugin_command", "Write a page for jsPsych that shows stimuli and asks."),
    "compare": ("compare_command", "Say how different walks look."),
    "experiment": ("experiment_commands", "Run an experiment in the browser, and export answers."),
    "data": ("data_commands", "List and fetch captures that others published."),
    "cite": ("cite_command", "Print what to cite: the program, its papers, a data set."),
}
"""The module of each command, and its line in the help of all."""

COMPLETION = ("--install-completion", "--show-completion")
HELP = """\
Usage: eigenwalker [OPTIONS] COMMAND [ARGS]...

  How people walk: from captures to a model, classifiers, and walkers of any
  trait.

Options:
  --version             Show the version, and that of Python; exit.
  --install-completion  Complete words in this shell by the tab key.
  --show-completion     Print what does so, to be copied.
  -h, --help            Show this message and exit.

Commands:
""" + "\n".join(f"  {name:<12}{line}" for name, (_, line) in COMMANDS.items())
"""Printed by itself: without the library of options the help of all is there at once."""


PRINTING = ("cite", "classify", "compare", "data", "info")
"""Commands whose result is what they print."""


def main() -> None:
    """Run the command line; errors and warnings are printed as sentences, without a traceback."""
    print_without_fail()
    _start_quickly()
    name, *words = sys.argv[1:] or [""]
    try:
        _run(name, words)
        code: Any = 0
    except SystemExit as ended:
        code = ended.code
    if error := printing_error():
        print(f"eigenwalker: not all could be printed: {error.strerror}.", file=sys.stderr)
        code = code or (EXIT_FAILED if name in PRINTING else 0)
    sys.exit(code)


def _start_quickly() -> None:
    """Look for garbage less often than while a library is loaded, and for no plugins of pydantic.

    That is a sixth of the time that a stimulus takes.
    """
    gc.set_threshold(200_000, 20, 20)
    os.environ.setdefault("PYDANTIC_DISABLE_PLUGINS", "__all__")


def _run(name: str, words: list[str]) -> None:
    completes = name in COMPLETION or "_EIGENWALKER_COMPLETE" in os.environ
    if name in ("-h", "--help", "") and not completes:
        print(HELP.replace("eigenwalker", called_as(), 1))
        sys.exit(0 if name else EXIT_FAILED)
    if name == "--version":
        import platform

        from eigenwalker._version import __version__

        system = f"{platform.system()} {platform.machine()}"
        print(f"eigenwalker {__version__} (Python {platform.python_version()}, {system})")
    elif completes:
        completed_commands()(args=[name, *words], prog_name="eigenwalker")
    elif name not in COMMANDS:
        sys.exit(_explain_unknown(name))
    else:
        from eigenwalker.cli.option_names import use_options_of

        command = load_command(name)
        use_options_of(command)
        say_once = cache(_say)
        warnings.showwarning = lambda message, *_, **__: say_once(str(message))
        warnings.filterwarnings("ignore", ".* encountered in ", RuntimeWarning)  # of numpy
        try:
            command(args=words, prog_name=f"{called_as()} {name}")
        except (ValueError, OSError, TypeError) as error:
            if isinstance(error, TypeError) and not _is_of_an_argument(error):
                raise
            _say(error)
            sys.exit(EXIT_FAILED)


def _is_of_an_argument(error: TypeError) -> bool:
    """Return whether a check of an argument raised an error, not a mistake of the program."""
    frame = error.__traceback__
    while frame is not None and frame.tb_next is not None:
        frame = frame.tb_next
    return frame is not None and frame.tb_frame.f_globals["__name__"].endswith("core.arguments")


def called_as() -> str:
    """Return how the program was called."""
    return "python -m eigenwalker" if Path(sys.argv[0]).name == "__main__.py" else "eigenwalker"


def completed_commands() -> Any:
    """Return all commands as one, which completes words in shells."""
    import typer

    program = typer.Typer(rich_markup_mode=None)
    for name in COMMANDS:
        command = _command_object(name)
        if isinstance(command, typer.Typer):
            program.add_typer(command, name=name)
        else:
            program.command(name)(command)
    return typer.main.get_command(program)


def _command_object(name: str) -> Any:
    from eigenwalker.cli.outputs import guarded

    return guarded(getattr(import_module(f"eigenwalker.cli.{COMMANDS[name][0]}"), name), name)


def load_command(name: str) -> Any:
    """Return the command of that name, as click runs it; only its own module is imported."""
    import typer

    from eigenwalker.cli.option_check import checked_values

    command = _command_object(name)
    if not isinstance(command, typer.Typer):
        function, command = command, typer.Typer(rich_markup_mode=None, add_completion=False)
        command.command(name)(function)
    command = typer.main.get_command(command)
    command.context_settings["help_option_names"] = ["-h", "--help"]
    return checked_values(command)


def _explain_unknown(word: str) -> int:
    from difflib import get_close_matches

    what = "option" if word.startswith("-") else "command"
    near = get_close_matches(word, [*COMMANDS, *COMPLETION, "--help", "--version"], n=1)
    guess = f" Did you mean '{near[0]}'?" if near else ""
    usage = HELP.partition("\n")[0].replace("eigenwalker", called_as())
    print(
        f"{usage}\nTry '{called_as()} -h' for help.\n\nError: No such {what} '{word}'.{guess}",
        file=sys.stderr,
    )
    return EXIT_FAILED


def _say(message: object) -> None:
    from eigenwalker.cli.option_names import in_options

    print(f"eigenwalker: {in_options(str(message))}", file=sys.stderr)
