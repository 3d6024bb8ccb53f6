"""``eigenwalker experiment``: from a design to the answers of observers."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager, nullcontext
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from eigenwalker.cli.options import Seed, load_people, option, progress_bar

if TYPE_CHECKING:
    from fastapi import FastAPI

    from eigenwalker.experiment.service import Service

experiment = typer.Typer(
    no_args_is_help=True,
    rich_markup_mode=None,
    add_completion=False,
    help="Experiments in the browser: designs, links for observers, their answers.",
)
Folder = Annotated[Path, typer.Argument(help="Folder of the experiment.")]
LINKS, PORT = "links.csv", 8640
MAX_CONCURRENT = 4000
"""Requests: all observers of a large class at once."""


@experiment.command()
def new(
    folder: Folder,
    design: Annotated[
        str,
        option(
            "troje2002, wdp2002, prazak2010, caricature, manipulation:NAME, detection, "
            "same_different, odd_one_out, adjustment, or a file (.toml)."
        ),
    ] = "troje2002",
    population: Annotated[
        Path | None, option("Population file (.nc); left out, the built-in one.")
    ] = None,
    seed: Annotated[int, option("The same seed gives the same walkers and orders.")] = 1,
    walkers: Annotated[
        int | None, option("How many walkers of the population; left out, as in the design.")
    ] = None,
) -> None:
    """Make the folder of an experiment: design.toml, texts, and all stimuli."""
    from eigenwalker.experiment.experiment_folder import new_experiment

    people = load_people(population, with_flagged=False)
    with progress_bar("Making stimuli") as progress:
        made = new_experiment(folder, design, people, seed=seed, walkers=walkers, progress=progress)
    print(f"{folder}: {len(made.walkers)} walkers, {len(made.stimulus_names())} stimuli")
    print(f"Next: eigenwalker experiment check {folder}")


@experiment.command()
def stimuli(
    folder: Folder,
    population: Annotated[
        Path | None, option("Population file (.nc); left out, the built-in one.")
    ] = None,
) -> None:
    """Make all stimuli anew, after the design was changed."""
    from eigenwalker.experiment.experiment_folder import remake_stimuli

    _checked_folder(folder)
    people = load_people(population, with_flagged=False)
    with progress_bar("Making stimuli") as progress:
        made = remake_stimuli(folder, people, progress)
    print(f"{folder}: {len(made.walkers)} walkers, {len(made.stimulus_names())} stimuli")


@experiment.command()
def check(
    folder: Folder,
    seeds: Annotated[
        int, typer.Option(help="How many seeds to draw all orders of.", min=1, max=100_000)
    ] = 1,
    output: Annotated[
        Path | None, option("File (.csv) for the trials of all observers.", "-o", "--output")
    ] = None,
) -> None:
    """Say all that can be known before anyone is invited: faults, order, balance, length."""
    from eigenwalker.experiment.check import check_experiment

    print(check_experiment(_checked_folder(folder), n_seeds=seeds, order=output))


@experiment.command()
def invite(
    folder: Folder,
    number: Annotated[int, typer.Option(help="How many personal links.", min=1, max=10_000)] = 1,
    base_url: Annotated[
        str | None,
        option("Address that links begin with; left out, that of 'run', on this machine."),
    ] = None,
    shared: Annotated[
        bool, option("One open link for all, in place of personal links.", "--open")
    ] = False,
    output: Annotated[
        Path | None, option("File of links; left out, links.csv in the folder.", "-o", "--output")
    ] = None,
) -> None:
    """Write links for observers into a file, once; only their hashes are kept."""
    _refuse_faults(folder)
    from eigenwalker.experiment.writer_lock import link_address

    path = output or folder / LINKS
    base = base_url or link_address(folder) or f"http://127.0.0.1:{PORT}"
    kind = "open" if shared else "personal"
    keys = _do(folder, "invite", number=1 if shared else number, kind=kind)
    is_new = not path.exists()
    with path.open("a", encoding="utf-8") as file:
        if is_new:
            path.chmod(0o600)
            file.write("kind,link\n")
        file.writelines(f"{kind},{base.rstrip('/')}/s/{key}\n" for key in keys)
    print(f"{len(keys)} {kind} {'link' if len(keys) == 1 else 'links'}: {path}")


@experiment.command()
def run(
    folder: Folder,
    host: Annotated[
        str, option("Where to listen; anything but this machine lets others in.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port.", min=0, max=65535)] = PORT,
    public_url: Annotated[
        str, option("Address behind a proxy with HTTPS: https://lab.example")
    ] = "",
    backup: Annotated[
        bool, option("Copy the answers into the folder 'backups' every hour.", "--backup")
    ] = False,
) -> None:
    """Serve the experiment to observers. Ctrl-C ends it; the same command goes on."""
    _refuse_faults(folder)
    _serve(folder, host, port, public_url, preview=False, backup=backup)


@experiment.command()
def preview(
    folder: Folder,
    port: Annotated[int, typer.Option(help="Port.", min=0, max=65535)] = 0,
) -> None:
    """Show the page; what is answered there is marked as a test for good."""
    _refuse_faults(folder)
    _serve(folder, "127.0.0.1", port, "", preview=True)


@experiment.command()
def withdraw(
    folder: Folder, code: Annotated[str, typer.Argument(help="Code that the observer has.")]
) -> None:
    """Delete all that an observer gave, to the last byte in the folder."""
    print(f"{_do(folder, 'withdraw', code=code)} answers were deleted, in all of {folder}.")
    print("Exports and copies that lie elsewhere are not reached; delete them, and export again.")


@experiment.command()
def status(folder: Folder, as_json: Annotated[bool, option("As JSON.", "--json")] = False) -> None:
    """Say how far the experiment is: groups, sessions, answers."""
    import json

    from eigenwalker.experiment.status import experiment_status, status_lines

    found = experiment_status(_checked_folder(folder))
    print(json.dumps(found, indent=1) if as_json else status_lines(found))


@experiment.command()
def export(
    folder: Folder,
    output: Annotated[Path, option("Folder to write into.", "-o", "--output")],
    frames: Annotated[bool, option("The times of all frames too.", "--frames")] = False,
) -> None:
    """Write the data as tidy tables with a codebook and all materials; also while it runs."""
    from eigenwalker.experiment.export import export_experiment

    for path in export_experiment(_checked_folder(folder), output, frames=frames):
        print(path)


@experiment.command()
def rescue(
    folder: Folder, files: Annotated[list[Path], typer.Argument(help="Files that pages saved.")]
) -> None:
    """Take answers that observers handed over as files, and say of each what became of it."""
    from eigenwalker.experiment.rescue import read_rescue_file

    for path in files:
        print(path)
        print("\n".join(_do(folder, "rescue", content=read_rescue_file(path))))


@experiment.command()
def simulate(
    folder: Folder,
    observers: Annotated[int, typer.Option(help="How many.", min=1, max=10_000)] = 24,
    seed: Seed = 1,
    sensitivity: Annotated[
        float, typer.Option(help="d' a standard deviation along the trait.", min=0.01, max=100)
    ] = 1.5,
    view_loss: Annotated[
        float, typer.Option(help="Share of it that is lost in profile.", min=0, max=0.99)
    ] = 0.5,
    bias: Annotated[float, typer.Option(help="Spread of biases, in d'.", min=0, max=10)] = 0.3,
    lapse: Annotated[float, typer.Option(help="Share of answers by chance.", min=0, max=1)] = 0.02,
    missed: Annotated[
        float, typer.Option(help="Share of showings without an answer.", min=0, max=0.9)
    ] = 0.01,
) -> None:
    """Have simulated observers answer; they are marked, and count in no group."""
    model = {
        "sensitivity": sensitivity,
        "view_loss": view_loss,
        "bias_sd": bias,
        "lapse": lapse,
        "missed": missed,
    }
    print(f"Truth: {_do(folder, 'simulate', number=observers, seed=seed, model=model)}")


def _serve(
    folder: Path, host: str, port: int, public_url: str, *, preview: bool, backup: bool = False
) -> None:
    from eigenwalker.experiment.backup import hourly_backup
    from eigenwalker.experiment.experiment_folder import Material
    from eigenwalker.experiment.observer_page import observer_page
    from eigenwalker.experiment.writer_lock import reachable
    from eigenwalker.web.run import address_of, listening_socket, run

    page = observer_page(Material(folder).design)
    with _writing(folder) as service, listening_socket(host, port) as bound:
        address = address_of(bound, host)
        with reachable(folder, address, public_url) as command_key:
            app = observer_app(
                service, page, host=host, public_url=public_url, command_key=command_key
            )

            def announce() -> None:
                print(f"Serving {public_url or address}  (Ctrl-C ends it)", flush=True)
                kind, path = ("preview", "s") if preview else ("lab", "lab")
                key = service.invite(1, kind=kind)[0]
                print(f"{kind.capitalize()} page: {address}{path}/{key}", flush=True)

            say = partial(print, flush=True)
            with hourly_backup(folder, say) if backup else nullcontext():
                run(
                    app,
                    bound,
                    when_ready=announce,
                    on_exit=lambda: None,
                    max_concurrent=MAX_CONCURRENT,
                )


def observer_app(
    service: Service, page: str, *, host: str, public_url: str, command_key: str
) -> FastAPI:
    """Return the application that serves an experiment to observers, and takes commands."""
    from eigenwalker.experiment.link_keys import same
    from eigenwalker.experiment.service import Closed, Gone, NotAllowed, received
    from eigenwalker.web.session_routes import session_app

    def do_command(key: str, name: str, arguments: dict[str, Any]) -> Any:
        if not same(key, command_key) or name not in COMMANDS:
            raise NotAllowed
        return getattr(service, name)(**arguments)

    return session_app(
        _Pages(service, received),
        page,
        host=host,
        public_url=public_url,
        refusals={Closed: 409, Gone: 410, NotAllowed: 403},
        commands=do_command,
    )


COMMANDS = ("invite", "withdraw", "rescue", "simulate")
"""What other commands hand to a running server."""


class _Pages:
    """The service, with answers in the form that pages read."""

    def __init__(self, service: Service, received: Any) -> None:
        self.welcome, self.start = service.welcome, service.start
        self.stimuli, self.end = service.stimuli, service.end
        self.lab_page, self.lab_export = service.lab_page, service.lab_export
        self.page_version, self.page = service.page_version, service.page
        self._submit, self._received = service.submit_answers, received

    async def answers(self, key: str, session: int, items: Any) -> Any:
        import asyncio

        return self._received(await asyncio.wrap_future(self._submit(key, session, items)))


@contextmanager
def _writing(folder: Path) -> Iterator[Service]:
    """Yield the experiment, of which this process is then the only writer."""
    from eigenwalker.experiment.answer_writer import AnswerWriter
    from eigenwalker.experiment.experiment_folder import ANSWERS
    from eigenwalker.experiment.service import Service
    from eigenwalker.experiment.writer_lock import only_writer

    with only_writer(folder), AnswerWriter(folder / ANSWERS) as writer:
        yield Service(folder, writer)


def _do(folder: Path, command: str, **arguments: Any) -> Any:
    """Do a command that writes: here, or by the server that has the folder."""
    from eigenwalker.experiment.writer_lock import Occupied, running_server
    from eigenwalker.web.hand_over import hand_over

    _checked_folder(folder)
    try:
        with _writing(folder) as service:
            return getattr(service, command)(**arguments)
    except Occupied:
        server = running_server(folder)
        if server is None:
            raise
    return hand_over(*server, command, arguments)


def _checked_folder(folder: Path) -> Path:
    from eigenwalker.experiment.experiment_folder import DESIGN

    if not (folder / DESIGN).is_file():
        raise ValueError(
            f"{folder} holds no {DESIGN}; make one with 'eigenwalker experiment new {folder}'."
        )
    return folder


def _refuse_faults(folder: Path) -> None:
    from eigenwalker.experiment.experiment_folder import Material

    if faults := Material(_checked_folder(folder)).faults():
        print("\n".join(faults), file=sys.stderr)
        raise ValueError(f"{folder} is not ready: {len(faults)} faults, above.")
