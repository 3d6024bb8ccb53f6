"""The command line for the interactive page with Python behind it: ``eigenwalker serve``."""

from __future__ import annotations

import os
import sys
from pathlib import Path
from typing import Annotated

import typer

BUILT_IN_TITLE = "How people walk"


def serve(
    people: Annotated[
        Path | None,
        typer.Argument(help="Population file (.nc); left out, the built-in simulated population."),
    ] = None,
    port: Annotated[
        int | None, typer.Option(help="Port; left out, one that is free.", min=0, max=65535)
    ] = None,
    host: Annotated[
        str,
        typer.Option(help="Where to listen; anything but this machine lets others in."),
    ] = "127.0.0.1",
    open_page: Annotated[
        bool, typer.Option("--open/--no-open", help="Open the page if there is a screen.")
    ] = True,
    with_flagged: Annotated[
        bool, typer.Option("--with-flagged", help="Count flagged walkers too.")
    ] = False,
) -> None:
    """Serve the interactive page, which then reads your captures and makes films.

    Only this machine is answered, unless --host says otherwise. Ctrl-C ends it.
    """
    from eigenwalker.datasets.built_in import BUILT_IN, load_population
    from eigenwalker.explorer.app import make_app
    from eigenwalker.web.host_check import LOOPBACK
    from eigenwalker.web.run import address_of, listening_socket, run

    if people is None:
        print(f"Using {BUILT_IN}.", file=sys.stderr)
    try:
        with listening_socket(host, port) as bound:
            population = load_population(people)
            population = population.trusting_all() if with_flagged else population
            app = make_app(population, host=host, **model_names(people))
            address = address_of(bound, host)
            if host not in LOOPBACK:
                said = "Whoever can reach this machine can use it; there is no password."
                print(said, file=sys.stderr)

            def tell() -> None:
                print(f"Serving {address}  (Ctrl-C ends it)", flush=True)
                if open_page and has_screen():
                    typer.launch(address)

            run(app, bound, when_ready=tell, on_exit=app.state.workshop.close)
    except KeyboardInterrupt:
        return


def model_names(people: Path | None) -> dict[str, str]:
    """Return title and source of a model made of a population's file, or of the built-in one."""
    if people is None:
        return {"title": BUILT_IN_TITLE, "source": ""}
    return {"title": people.stem, "source": people.name}


def has_screen() -> bool:
    """Return whether there is a screen to show a page on."""
    return sys.platform in ("win32", "darwin") or bool(
        os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY")
    )
