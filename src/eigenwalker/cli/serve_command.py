"""``eigenwalker serve``: the interactive page, with Python behind it."""

from __future__ import annotations

import sys
from typing import Annotated

import typer

from eigenwalker.cli.classify_command import model_names
from eigenwalker.cli.options import (
    KeepSize,
    MappingFile,
    OpenPage,
    People,
    WithFlagged,
    is_published,
    load_people,
    open_in_browser,
    option,
)


def serve(
    people: People = None,
    port: Annotated[
        int | None, typer.Option(help="Port; left out, one that is free.", min=0, max=65535)
    ] = None,
    host: Annotated[
        str, option("Where to listen; anything but this machine lets others in.")
    ] = "127.0.0.1",
    open_page: OpenPage = True,
    keep_size: KeepSize = False,
    with_flagged: WithFlagged = False,
    mapping: MappingFile = None,
) -> None:
    """Serve the interactive page, which then reads your captures and makes films.

    Only this machine is answered, unless --host says otherwise. Ctrl-C ends it.
    """
    from eigenwalker.explorer.app import make_app
    from eigenwalker.web.host_check import LOOPBACK
    from eigenwalker.web.run import address_of, listening_socket, run

    def announce() -> None:
        print(f"Serving {address}  (Ctrl-C ends it)", flush=True)
        if open_page:
            open_in_browser(address)

    try:
        with listening_socket(host, port) as bound:
            address = address_of(bound, host)
            app = make_app(
                load_people(people, with_flagged),
                host=host,
                mapping=mapping,
                keep_size=keep_size or is_published(people),
                **model_names(people),
            )
            if host not in LOOPBACK:
                warning = "Everyone who can reach this machine can use it; there is no password."
                print(warning, file=sys.stderr)
            run(app, bound, when_ready=announce, on_exit=app.state.task_runner.close)
    except KeyboardInterrupt:
        return
