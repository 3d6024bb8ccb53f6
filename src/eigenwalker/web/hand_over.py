"""A command's writes, done by the server that has the folder: over loopback, with its key."""

from __future__ import annotations

from typing import Any


def hand_over(address: str, key: str, command: str, arguments: dict[str, Any]) -> Any:
    """Return the result of a command that a running server does."""
    import requests

    url = f"{address.rstrip('/')}/api/command/{command}"
    session = requests.Session()
    session.trust_env = False  # no proxy between this machine and itself
    try:
        answer = session.post(
            url, json=arguments, headers={"authorization": f"Bearer {key}"}, timeout=600
        )
        content = answer.json()
    except (requests.RequestException, ValueError) as error:
        raise OSError(
            f"The server that has this folder does not answer ({type(error).__name__}); "
            "end it, or try again."
        ) from None
    if not answer.ok:
        raise ValueError(content.get("detail", f"The server refused ({answer.status_code})."))
    return content
