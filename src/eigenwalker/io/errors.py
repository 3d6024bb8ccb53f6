"""The one error for a file that cannot be read."""

from __future__ import annotations

MAX_PART = 400
"""Letters of each part of a message: no file makes it longer than some 1500."""
EXPORT_AGAIN = "export or copy the file again"


class UnreadableFile(ValueError):  # noqa: N818 - the name says what is wrong
    """A file does not hold what its reader needs.

    Readers raise this error and no other, whatever is wrong with a file, so that one bad file among
    many can be reported and the rest read.

    Parameters
    ----------
    source : str
        Name of the file.
    expected : str
        What a sound file would hold.
    got : str
        What stands there instead.
    advice : str
        What the owner of the file can do.

    See Also
    --------
    read_mocap

    Examples
    --------
    >>> error = UnreadableFile("a.bvh", "207 frames", "120", "export the file again")
    >>> print(error)
    a.bvh: expected 207 frames, but got 120; export the file again.
    """

    def __init__(self, source: str, expected: str, got: str, advice: str = EXPORT_AGAIN) -> None:
        super().__init__(source, expected, got, advice)
        self.source = source
        self.expected = expected
        self.got = got
        self.advice = advice

    def __str__(self) -> str:
        source, expected, got = map(_shortened, (self.source, self.expected, self.got))
        return printable(f"{source}: expected {expected}, but got {got}; {self.advice}.")


def _shortened(text: str) -> str:
    return text if len(text) <= MAX_PART else f"{text[: MAX_PART - 4]} ..."


def printable(text: str) -> str:
    r"""Return a text in one line, without characters that control a terminal."""
    return "".join(
        letter if letter.isprintable() else " " if letter.isspace() else "\N{REPLACEMENT CHARACTER}"
        for letter in text
    )
