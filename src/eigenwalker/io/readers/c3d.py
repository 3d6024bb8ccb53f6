"""C3D files: the samples of markers, as most laboratories keep them."""

from __future__ import annotations

import re

import numpy as np
import xarray as xr

from eigenwalker.io.capture_file import CaptureFile
from eigenwalker.io.missing_codes import without_codes
from eigenwalker.io.readers.c3d_sections import Header, Parameters, c3d_sections
from eigenwalker.io.to_trajectories import (
    FileFrame,
    labelled_points,
    own_name,
    trajectories_of,
    unit_named,
    with_scalars,
)
from eigenwalker.io.up_axis_and_unit import Unit

looks_like_c3d = re.compile(rb"[^\0]\x50", re.DOTALL).match
_UNLABELLED = re.compile(
    r"\*\d*|u_\d+|new[ _]?\d+|un(labell?ed|named|identified).*|no[ _]?name.*", re.IGNORECASE
)
_NO_POSITION = re.compile(r"(Angles?|Forces?|Moments?|Powers?|GRF)\d*$")
_NO_POSITION_GROUPS = ("ANGLES", "FORCES", "MOMENTS", "POWERS", "SCALARS", "REACTIONS")
_MEASURES = {
    "LEGLENGTH": "leg_length",
    "KNEEWIDTH": "knee_width",
    "ANKLEWIDTH": "ankle_width",
    "ELBOWWIDTH": "elbow_width",
    "WRISTWIDTH": "wrist_width",
    "SHOULDEROFFSET": "shoulder_offset",
}


def read_c3d(file: CaptureFile) -> xr.DataArray:
    """Return the trajectories of the markers in a C3D file; NaN where a marker was not seen.

    Angles, forces, moments, powers and unlabelled points are left out, and named in
    ``attrs["left_out"]``; what a laboratory's model computed as positions stays. Frame 1 of the
    capture is at 0 s, and a file may begin later.
    """
    header, parameters, samples, cut = c3d_sections(file)
    rate_hz = _rate(file, header, parameters)
    positions, names, attrs = _markers(file, samples, parameters)
    positions, codes = without_codes(positions)  # forces and moments set no limit for positions
    attrs |= {"missing_codes": codes} if codes else {}
    walk = trajectories_of(
        file,
        positions,
        names,
        format_name="C3D",
        rate_hz=file.rate_hz or rate_hz,
        start_s=0.0 if file.rate_hz else max(header.first_frame - 1, 0) / rate_hz,
        frame=FileFrame(_unit(parameters), up=_screen_up(parameters)),
    )
    measures = _measures(parameters)
    return with_scalars(walk, measures).assign_attrs(**attrs, **measures, **cut)


def _rate(file: CaptureFile, header: Header, parameters: Parameters) -> float:
    rates = (parameters.number("POINT:RATE"), header.rate_hz)
    sound = [rate for rate in rates if rate is not None and np.isfinite(rate) and rate > 0]
    if not sound or max(sound) > 1.01 * min(sound) or not 0.1 <= sound[0] <= 1e5:
        got = f"{header.rate_hz} and {rates[0]}"
        raise file.error("one frame rate in header and parameters", got)
    return round(sound[0], 6)


def _markers(
    file: CaptureFile, samples: np.ndarray, parameters: Parameters
) -> tuple[np.ndarray, list[str], dict[str, object]]:
    n_points = samples.shape[1]
    labels = parameters.texts("POINT:LABELS")
    if not labels:
        labels = [f"point_{number}" for number in range(1, n_points + 1)]
    labels += ["*"] * (n_points - len(labels))
    others = {name for group in _NO_POSITION_GROUPS for name in parameters.texts(f"POINT:{group}")}

    def is_marker(label: str) -> bool:
        own = own_name(label)
        is_labelled = own and not _UNLABELLED.fullmatch(own)
        return bool(is_labelled) and label not in others and not _NO_POSITION.search(own)

    positions, names, attrs = labelled_points(samples, labels[:n_points], is_marker)
    if not names:
        raise file.error(
            "labelled markers",
            f"{len(labels)} points, all unlabelled or no positions",
            "label them first in the program that captured them",
        )
    return positions, names, attrs


def _screen_up(parameters: Parameters) -> str | None:
    """Return the axis that points up on the screen, which programs fill in without knowing it."""
    screen = "".join(parameters.texts("POINT:Y_SCREEN")[:1]).replace("+", "").strip().lower()
    return screen if re.fullmatch(r"-?[xyz]", screen) else None


def _unit(parameters: Parameters) -> Unit | None:
    return next((u for text in parameters.texts("POINT:UNITS") if (u := unit_named(text))), None)


def _measures(parameters: Parameters) -> dict[str, float]:
    measures: dict[str, float] = {}
    for key, name in _MEASURES.items():
        for side in ("left", "right"):
            number = parameters.number(f"PROCESSING:{side[0].upper()}{key}")
            if number and number > 0:
                measures[f"{side}_{name}_mm"] = number
    return measures
