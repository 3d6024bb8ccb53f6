"""What to cite, as BibTeX: the program, the papers it stands on, and the data sets by name."""

from __future__ import annotations

import re
from importlib.resources import files

from eigenwalker._version import __version__

PROGRAM = "eigenwalker"


def bibtex(name: str = PROGRAM) -> str:
    """Return the BibTeX entries of the program and its papers, or those of a data set.

    Parameters
    ----------
    name : str
        A data set: ``"bandai-namco"``, ``"cmu"``, ``"delussanet"``, ``"pycgm"``, ``"bml"`` (Troje's
        tables) or ``"moler"`` (walkers.mat); left out, the program and the papers it stands on.

    Returns
    -------
    str
        Entries one below the other, each of which names by ``keywords`` what it is for.

    Raises
    ------
    ValueError
        If there is no such data set.

    See Also
    --------
    fetch_captures : fetch a data set, with its licence.

    Examples
    --------
    >>> print(bibtex("delussanet").splitlines()[0])
    @article{delussanet2008interaction,
    """
    text = files("eigenwalker.datasets").joinpath("citations.bib").read_text(encoding="utf-8")
    _, *entries = text.replace("VERSION", __version__).split("\n\n")
    keywords = [re.findall(r"[\w-]+", entry.rpartition("keywords")[2]) for entry in entries]
    if name not in (known := sorted(set().union(*keywords) - {PROGRAM})) and name != PROGRAM:
        raise ValueError(f"There is nothing to cite for {name!r}; there are {known}.")
    chosen = [entry for entry, words in zip(entries, keywords, strict=True) if name in words]
    return "\n\n".join(entry.strip() for entry in chosen) + "\n"
