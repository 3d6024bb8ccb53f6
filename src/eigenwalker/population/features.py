"""A walker as a vector of named features, and back.

The layout follows from what is free in a walker: with 15 markers and two harmonics the eigenposture
form has 5 * 45 + 4 = 229 numbers (postures, frequency, three phases), the Fourier form
5 * 45 + 1 = 226.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from eigenwalker.core.arguments import check_numbers
from eigenwalker.core.trajectories import AXES
from eigenwalker.core.walker import Form, Walker

NAMED_PARTS = {
    "all": "every feature (229 in the eigenposture form)",
    "structure": "p0, the mean posture",
    "dynamics": "p1, p2, ..., the phases and the frequency",
    "postures": "p0, p1, p2, ...: positions (range-specific)",
    "timing": "the frequency and the phases: time (domain-specific)",
}
"""Parts that gather several blocks; blocks themselves are p0, p1, ..., frequency and phases."""


@dataclass(frozen=True)
class FeatureLayout:
    """The order of the numbers in a feature vector.

    ``(p0, p1, p2, ..., frequency, phase2, phase3, ...)``: each posture is x, y, z of one
    marker after the other, in mm; the frequency is in Hz, phases are in radians. The first phase is
    always 0, so it is not a feature.

    Parameters
    ----------
    markers : tuple of str
        Marker names.
    harmonics : tuple of int
        Harmonic of each posture p1, p2, ...
    form : {"eigenposture", "fourier"}
        Whether phases are features.
    fixed_phases : tuple of float
        In the Fourier form, the phases that every walker shares.

    See Also
    --------
    Population.layout : that of a population.

    References
    ----------
    Troje (2002), the 229 numbers of a walk.

    Examples
    --------
    >>> layout = FeatureLayout(ew.JOINTS.markers, (1, 1, 2, 2))
    >>> len(layout.names), layout.names[0], layout.names[-1]
    (229, 'p0.head.x', 'phase4')
    >>> len(layout.columns("structure")), len(layout.columns("p1+p2+p3"))
    (45, 135)
    """

    markers: tuple[str, ...]
    harmonics: tuple[int, ...]
    form: Form = "eigenposture"
    fixed_phases: tuple[float, ...] = ()

    @classmethod
    def of(cls, walker: Walker) -> FeatureLayout:
        """Return the layout of a walker."""
        fixed = tuple(walker.phases.tolist()) if walker.form == "fourier" else ()
        return cls(walker.markers, tuple(walker.harmonics.tolist()), walker.form, fixed)

    @cached_property
    def blocks(self) -> dict[str, slice]:
        """Columns of each block: p0, p1, ..., frequency and, where they are free, phases."""
        size = len(self.markers) * len(AXES)
        names = [f"p{i}" for i in range(len(self.harmonics) + 1)]
        blocks = {name: slice(i * size, (i + 1) * size) for i, name in enumerate(names)}
        end = len(names) * size
        blocks["frequency"] = slice(end, end + 1)
        if self.form == "eigenposture":
            blocks["phases"] = slice(end + 1, end + len(self.harmonics))
        return blocks

    @cached_property
    def names(self) -> tuple[str, ...]:
        """Feature names, such as ``p1.left_knee.z`` in mm, ``frequency_hz``, ``phase2`` in rad."""
        postures = [
            f"p{i}.{marker}.{axis}"
            for i in range(len(self.harmonics) + 1)
            for marker in self.markers
            for axis in AXES
        ]
        free = range(2, len(self.harmonics) + 1) if self.form == "eigenposture" else ()
        return (*postures, "frequency_hz", *(f"phase{i}" for i in free))

    def __len__(self) -> int:
        return len(self.names)

    def columns(self, part: str) -> np.ndarray:
        """Return the columns of a part of the features.

        Parameters
        ----------
        part : str
            A name among `NAMED_PARTS`, a block (``"p0"``, ``"frequency"``, ``"phases"``), or
            several joined by ``+``, such as ``"p1+p2+p3"``.

        Returns
        -------
        array of int, in increasing order
        """
        gathered = {
            "all": list(self.blocks),
            "structure": ["p0"],
            "dynamics": [name for name in self.blocks if name != "p0"],
            "postures": [name for name in self.blocks if name.startswith("p") and name != "phases"],
            "timing": [name for name in self.blocks if name in ("frequency", "phases")],
        }
        chosen: set[int] = set()
        names = [name.strip() for name in part.split("+")]
        if twice := {name for name in names if names.count(name) > 1}:
            raise ValueError(f"The part {part!r} names {min(twice)!r} twice; name it once.")
        for name in names:
            for block in gathered.get(name, [name]):
                if block not in self.blocks:
                    raise ValueError(
                        f"There is no part {block!r}; there are {[*gathered, *self.blocks]}, and "
                        "sums of them such as 'p1+p2'."
                    )
                chosen.update(range(len(self))[self.blocks[block]])
        return np.array(sorted(chosen), dtype=int)

    def vector(self, walker: Walker) -> np.ndarray:
        """Return the features of a walker of this layout, its phases between -pi and pi."""
        if FeatureLayout.of(walker) != self:
            raise ValueError(
                f"The walker has {_describe(FeatureLayout.of(walker))}, where "
                f"{_describe(self)} are expected; decompose it the same way."
            )
        free = walker.phases[1:] if self.form == "eigenposture" else np.zeros(0)
        wrapped = wrap_phase(free)
        return np.concatenate([walker.p0.ravel(), walker.p.ravel(), [walker.frequency_hz], wrapped])

    def walker(self, vector: np.ndarray) -> Walker:
        """Return the walker that a feature vector describes."""
        vector = check_numbers(vector, "vector", "feature")
        if vector.shape != (len(self),):
            raise ValueError(
                f"Expected a vector of {len(self)} features, got shape {vector.shape}."
            )
        size = len(self.markers) * len(AXES)
        postures = vector[: (len(self.harmonics) + 1) * size].reshape(-1, len(self.markers), 3)
        phases = self.fixed_phases
        if self.form == "eigenposture":
            phases = (0.0, *vector[self.blocks["phases"]])
        return Walker(
            markers=self.markers,
            p0=postures[0],
            p=postures[1:],
            harmonics=np.array(self.harmonics),
            phases=np.array(phases),
            frequency_hz=vector[self.blocks["frequency"]].item(),
            form=self.form,
        )


def wrap_phase(angle: np.ndarray, *, around: np.ndarray | float = 0.0) -> np.ndarray:
    """Return angles as those within pi of a centre."""
    return around + np.mod(angle - around + np.pi, 2 * np.pi) - np.pi


def circular_mean(angles: np.ndarray) -> np.ndarray:
    """Return the mean direction of angles over the first dimension."""
    return np.angle(np.exp(1j * angles).mean(axis=0))


def _describe(layout: FeatureLayout) -> str:
    return (
        f"{len(layout.markers)} markers ({layout.markers[0]} ...), harmonics {layout.harmonics} "
        f"in the {layout.form} form"
    )
