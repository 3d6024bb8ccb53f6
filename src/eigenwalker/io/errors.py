"""The one error that a file which cannot be read ends in."""

from __future__ import annotations

AGAIN = "export or copy the file again"


class UnreadableFile(ValueError):  # noqa: N818 - the name says what is wrong
    """A file does not hold what a reader needs.

    Whatever is wrong with a file, readers raise this and nothing else, so that one bad file among
    many can be reported and the rest read.

    Parameters
    ----------
    source : str
        Name of the file.
    expected : str
        What a sound file would hold.
    came : str
        What stood there instead.
    advice : str
        What the owner of the file can do.

    Examples
    --------
    >>> error = UnreadableFile("a.bvh", "207 frames", "120", "export the file again")
    >>> print(error)
    a.bvh: expected 207 frames, but got 120; export the file again.

    """

    def __init__(self, source: str, expected: str, came: str, advice: str = AGAIN) -> None:
        super().__init__(source, expected, came, advice)
        self.source = source
        self.expected = expected
        self.came = came
        self.advice = advice

    def __str__(self) -> str:
        return printable(
            f"{self.source}: expected {self.expected}, but got {self.came}; {self.advice}."
        )


def printable(text: str) -> str:
    r"""Return a text in one line, without what a terminal would act on.

    Names in files, and of files, may hold anything.

    Examples
    --------
    >>> printable("left\x1b[2Jknee\n")
    'left�[2Jknee '

    """
    return "".join(
        letter if letter.isprintable() else " " if letter.isspace() else "\N{REPLACEMENT CHARACTER}"
        for letter in text
    )
