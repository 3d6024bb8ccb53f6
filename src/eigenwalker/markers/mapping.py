"""A mapping from markers with names of one's own to joints and landmarks, in Python or as TOML."""

from __future__ import annotations

import re
import tomllib
import unicodedata
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from difflib import get_close_matches
from pathlib import Path
from typing import Any

from eigenwalker.core.skeleton import JOINTS
from eigenwalker.markers.marker_sets import SIDES, known_sets, marker_names

MAX_BYTES = 1_000_000
TABLES = ("joints", "skin")
"""Tables of a mapping: joints by their markers, and landmarks on the skin by theirs."""
_PARTS = {
    "head": ("head", "kopf", "tete", "nose", "skull", "vertex"),
    "sternum": ("sternum", "chest", "thorax", "clav", "neck", "brust", "torso", "spine2"),
    "pelvis": ("pelvis", "sacrum", "sacr", "root", "becken", "hips", "bassin", "waist"),
    "shoulder": ("shoulder", "sho", "acromion", "schulter", "epaule", "upperarm"),
    "elbow": ("elbow", "elb", "ellbogen", "coude", "lowerarm", "forearm"),
    "wrist": ("wrist", "wri", "handgelenk", "poignet", "hand"),
    "hip": ("hip", "huefte", "hufte", "hanche", "trochanter", "upperleg", "femur"),
    "knee": ("knee", "kne", "knie", "genou", "lowerleg", "tibia"),
    "ankle": ("ankle", "ank", "malleolus", "knoechel", "cheville", "foot", "fuss"),
}
"""Parts of names by which joints are guessed, the surest first."""
_SIDES = {
    "left": ("left", "links", "gauche", "li", "l"),
    "right": ("right", "rechts", "droit", "re", "r"),
}


@dataclass(frozen=True)
class MarkerMapping:
    """The markers of joints and of landmarks on the skin, and where they are written.

    Attributes
    ----------
    joints : mapping of str to tuple of str
        Joint (``"left_knee"``) to the markers whose mean it is.
    skin : mapping of str to tuple of str
        Landmark of a known marker set (``"LASI"``) to the markers that stand for it.
    source : str
        Name of the file it comes from.
    lines : mapping of str to int
        Lines of that file, for messages.

    See Also
    --------
    read_mapping : From a TOML file.
    eigenwalker.virtual_markers : Takes a mapping.
    """

    joints: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    skin: Mapping[str, tuple[str, ...]] = field(default_factory=dict[str, tuple[str, ...]])
    source: str = ""
    lines: Mapping[str, int] = field(default_factory=dict[str, int])

    def where(self, target: str) -> str:
        """Return where the markers of a joint or landmark are named, for messages."""
        line = self.lines.get(target)
        return f" (line {line} of {self.source})" if line else ""

    def as_dict(self) -> dict[str, Any]:
        """Return it in types of JSON, as `as_mapping` takes it."""
        return asdict(self)

    def __bool__(self) -> bool:
        return bool(self.joints or self.skin)


def targets() -> dict[str, tuple[str, ...]]:
    """Return the joints and the landmarks on the skin that a mapping may name."""
    extras = {name for known in known_sets() for name in known.extras}
    skin = {name for known in known_sets() for name in known.landmarks}
    joints = (*JOINTS.markers, *sorted(extras - set(JOINTS.markers)))
    return {"joints": joints, "skin": tuple(sorted(skin))}


def as_mapping(given: MarkerMapping | Mapping[str, Any] | str | Path | None) -> MarkerMapping:
    """Return a mapping that is given as it is, as a dict, or as the path of a TOML file.

    A dict without the tables ``joints`` and ``skin`` is one of joints.
    """
    if given is None or isinstance(given, MarkerMapping):
        return given or MarkerMapping()
    if isinstance(given, str | Path):
        return read_mapping(Path(given))
    if set(given) - {*TABLES, "source", "lines"}:
        given = {"joints": given}
    tables = {name: _table(name, given.get(name, {}), {}, "mapping") for name in TABLES}
    return MarkerMapping(
        **tables, source=str(given.get("source", "")), lines=dict(given.get("lines", {}))
    )


def read_mapping(path: Path) -> MarkerMapping:
    r"""Return the mapping of marker names in a TOML file.

    Parameters
    ----------
    path : path
        A file with tables ``[joints]`` and ``[skin]``, as ``eigenwalker info FILE --write-mapping``
        starts one.

    Raises
    ------
    ValueError
        With the line, for what a mapping cannot have.

    See Also
    --------
    eigenwalker.virtual_markers : Takes the mapping, or the path itself.

    Examples
    --------
    >>> from pathlib import Path
    >>> path = Path(getfixture("tmp_path")) / "names.toml"
    >>> _ = path.write_text('[joints]\nleft_ankle = "ANKLE_L"')
    >>> read_mapping(path).joints
    {'left_ankle': ('ANKLE_L',)}
    """
    try:
        if path.stat().st_size > MAX_BYTES:
            raise ValueError(f"it has more than {MAX_BYTES // 1000} kB")
        text = path.read_bytes().decode("utf-8-sig")
        data = tomllib.loads(text)
    except OSError as error:
        raise ValueError(f"The mapping {path} could not be read: {error.strerror}.") from error
    except UnicodeDecodeError as error:
        raise ValueError(f"The mapping {path} is no text in UTF-8; write it as TOML.") from error
    except (ValueError, RecursionError) as error:
        raise ValueError(
            f"The mapping {path} is no TOML: {str(error).rstrip('.')}. A line is such as "
            'left_ankle = "LANK" or pelvis = ["LASI", "RASI"].'
        ) from error
    lines = _lines(text)
    if unknown := [name for name in data if name not in TABLES]:
        raise ValueError(
            f"{path.name} has {unknown[0]!r} in line {lines.get(unknown[0], 1)}, outside of "
            "[joints] and [skin]; put those headings above the lines."
        )
    tables = {name: _table(name, data.get(name, {}), lines, path.name) for name in TABLES}
    mapping = MarkerMapping(**tables, source=path.name, lines=lines)
    if not mapping:
        raise ValueError(
            f"The mapping {path.name} has no effect: it names no marker. Take the # away from the "
            "lines that are to count."
        )
    return mapping


def is_mapping(path: Path) -> bool:
    """Return whether a TOML file has a table of a mapping, sound or not."""
    beginning = path.read_bytes()[:MAX_BYTES]
    return re.search(rb"(?m)^\s*\[(joints|skin)\]", beginning) is not None


def mapping_to_begin_with(
    markers: Sequence[str],
    source: str,
    places: Mapping[str, str] | None = None,
    near: Mapping[str, str] | None = None,
    note: str = "",
) -> str:
    """Return the text of a mapping for markers, with guesses, to be put right by hand.

    `places` says in words where each marker is, `near` which is nearest to a joint, and `note`
    what to know of both.
    """
    names = marker_names(tuple(markers))
    nearest = max(known_sets(), key=lambda known: known.share_found(names))
    found = {
        table: {
            target: hit.markers for target, entry in entries.items() if (hit := names.find(entry))
        }
        for table, entries in (
            ("joints", {**nearest.joints, **nearest.extras}),
            ("skin", nearest.landmarks),
        )
    }
    guesses = {joint: guess for joint in JOINTS.markers if (guess := _guess(joint, markers))}
    on_skin = len(found["skin"]) > 0.5 * len(nearest.landmarks) > 0
    lines = [
        f"# The markers of {source}: which joint or landmark is which.",
        '# A line is a marker, or several whose midpoint is meant: pelvis = ["LASI", "RASI"].',
        "# Lines that begin with # do not count. What is marked as a guess should be looked at.",
        *(f"# {line}" for line in filter(None, [note])),
        *_markers_in_words(markers, places or {}),
        "",
        "[joints]",
        "# Centres of joints, or markers that stand for them. Left out, they are computed.",
    ]
    for joint in targets()["joints"]:
        if joint in found["joints"]:
            lines.append(f"{joint} = {_value(found['joints'][joint])}  # as {nearest.name} has it")
        elif joint in guesses and not on_skin:
            lines.append(f"{joint} = {_value([guesses[joint]])}  # guess")
        elif not on_skin and joint in (near or {}):
            lines.append(f"# {joint} = {_value([(near or {})[joint]])}  # by its place; is it?")
        else:
            lines.append(f'# {joint} = ""')
    lines += ["", "[skin]", "# Markers on the skin, from which the centres of joints are computed."]
    for landmark in targets()["skin"]:
        markers_of = found["skin"].get(landmark)
        known = (
            f"{landmark} = {_value(markers_of)}  # as {nearest.name} has it" if markers_of else ""
        )
        lines.append(known or f'# {landmark} = ""')
    return "\n".join(lines) + "\n"


def _markers_in_words(markers: Sequence[str], places: Mapping[str, str]) -> list[str]:
    if not places:
        return [f"# Markers of the file: {', '.join(markers)}"]
    lines = (f"#   {marker}: {places.get(marker, 'seldom seen')}" for marker in markers)
    return ["# Markers of the file:", *lines]


def _value(markers: Sequence[str]) -> str:
    quoted = ['"' + re.sub(r'(["\\])', r"\\\1", marker) + '"' for marker in markers]
    return quoted[0] if len(quoted) == 1 else f"[{', '.join(quoted)}]"


def _guess(joint: str, markers: Iterable[str]) -> str:
    """Return the marker whose name says best that it is a joint; empty if none does."""
    side, _, part = joint.rpartition("_")
    ranked: list[tuple[int, int, str]] = []
    for marker in markers:
        plain = unicodedata.normalize("NFKD", marker).encode("ascii", "ignore").decode()
        spaced = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", plain)
        words = re.findall(r"[^\W\d_]+", spaced.casefold())
        sides = {name for name in SIDES for word in words if word in _SIDES[name]}
        whole = "".join(words)
        if not sides and whole[:1] in "lr":
            sides, whole = {"left" if whole[0] == "l" else "right"}, whole[1:]
        rank = next((at for at, word in enumerate(_PARTS[part]) if word in whole), None)
        if rank is not None and sides == ({side} if side else set()):
            ranked.append((rank, len(marker), marker))
    return min(ranked)[2] if ranked else ""


def _lines(text: str) -> dict[str, int]:
    """Return the line on which each key stands first."""
    lines: dict[str, int] = {}
    for number, line in enumerate(text.splitlines(), start=1):
        if hit := re.match(r"\s*\"?([\w.-]+)\"?\s*=", line):
            lines.setdefault(hit[1], number)
    return lines


def _table(
    name: str, table: object, lines: Mapping[str, int], source: str
) -> dict[str, tuple[str, ...]]:
    if not isinstance(table, Mapping):
        raise ValueError(f"{name} of the {source} is no table of markers; write [{name}] above it.")
    known = targets()[name]
    found: dict[str, tuple[str, ...]] = {}
    for target, markers in table.items():
        where = f" in line {lines[target]}" if target in lines else ""
        if target not in known:
            near = get_close_matches(str(target), known, n=1)
            hint = f"did you mean {near[0]!r}?" if near else f"give some of {list(known)}."
            raise ValueError(f"{source} names {str(target)[:60]!r}{where} under {name}; {hint}")
        words = [markers] if isinstance(markers, str) else markers
        if not isinstance(words, Sequence) or not all(isinstance(word, str) for word in words):
            raise ValueError(f"{source}: {target}{where} is no marker, nor a list of markers.")
        if not words or not all(words):
            raise ValueError(f"{source}: {target}{where} names no marker; fill it in or remove it.")
        found[str(target)] = tuple(words)
    return found
