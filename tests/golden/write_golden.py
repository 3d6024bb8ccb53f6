"""Write the golden files: stimuli, and where Python puts their dots.

    python tests/golden/write_golden.py

Each transform has a file of its own. The browser's tests read them too, and must find the same
positions within 1e-6 mm. They change only when a definition changes.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from eigenwalker.core.trajectories import label_trajectories
from eigenwalker.core.walker import Walker
from eigenwalker.stimulus import drawing
from eigenwalker.stimulus.figure import Figure, WalkerPart
from eigenwalker.stimulus.make import make_stimulus
from eigenwalker.stimulus.mannequin import body_heights
from eigenwalker.stimulus.random_streams import normals, permutation, random_words, uniforms
from eigenwalker.stimulus.stimulus import Stimulus

FOLDER = Path(__file__).parent
KEPT = json.loads((FOLDER / "figures.json").read_text(encoding="utf-8"))
TIMES_S = (0.0, 0.1, 0.35, 1.0, 1.9375)


def person(number: int) -> Walker:
    """A simulated walker, kept in a file so that simulations may change."""
    return WalkerPart(**KEPT[str(number)]).to_walker()


def captured(*, repeat: bool) -> Figure:
    """Nine frames of three joints at 20 Hz, with a gap."""
    kept = KEPT["walk"]
    values = np.array(kept["samples"], dtype=float)
    return Figure(
        label_trajectories(values, markers=kept["markers"], rate_hz=kept["rate_hz"]), repeat=repeat
    )


def stimuli() -> dict[str, Stimulus]:
    """All cases by name."""
    walker = person(7)
    plain = make_stimulus(walker, duration_s=2.0)
    legs = ["left_ankle", "right_ankle", "left_knee", "right_knee"]
    return {
        "plain": plain,
        "view": make_stimulus(walker, azimuth_deg=-57.5, elevation_deg=20, duration_s=2.0),
        "perspective": make_stimulus(
            walker, azimuth_deg=80, elevation_deg=-10, eye_distance_mm=2500
        ),
        "sized": plain.sized(5, viewing_distance_mm=570, px_per_cm=38),
        "trajectories": make_stimulus(captured(repeat=False), duration_s=2.0),
        "trajectories_repeat": make_stimulus(captured(repeat=True), duration_s=2.0),
        "figures": make_stimulus(
            [
                walker,
                Figure(person(30), position_mm=(200.0, 900.0, 0.0), heading_deg=-35.0),
            ]
        ).then("mirror", figures=[1]),
        "invert": plain.then("invert"),
        "mirror": plain.then("mirror"),
        "rotate": plain.then("rotate", axis="y", angle_deg=40),
        "rotate_sight": plain.then("rotate", axis="sight", angle_deg=180),
        "rotate_vector": plain.then("rotate", axis=[1, -2, 0.5], angle_deg=10, speed_deg_s=90),
        "resize": plain.then("resize", factor=0.9),
        "translate": plain.then("translate", offset_mm=[10, 20, -30], velocity_mm_s=[500, 0, 4]),
        "overground": plain.then("overground"),
        "speed": plain.then("speed", factor=1.7),
        "reverse": plain.then("reverse"),
        "start": plain.then("start", phase_deg=123),
        "freeze": plain.then("freeze", time_s=0.3),
        "phase_scramble": plain.then("phase_scramble", seed=11),
        "delay": plain.then("delay", parts="arms", phase_deg=60),
        "morph": plain.then("morph", walker=person(31), start_s=0.2, end_s=1.5),
        "occlude": plain.then("occlude", parts="lower_body"),
        "arm_swing": plain.then("arm_swing", factor=2),
        "gain": plain.then("gain", markers=[*legs, "head", "pelvis"], factor=0.4, axes="xz"),
        "conflict": plain.then(
            "conflict", shoulder_width=1.3, hip_width=0.7, shoulder_sway=0.2, hip_sway=3
        ),
        "ellipses": plain.then("ellipses", shoulder_mm=[35, 12], hip_mm=[15, 20]),
        "perturb": plain.then(
            "perturb",
            markers=["left_knee"],
            amount_mm=[0, 50, 20],
            frequency_hz=3,
            phase_deg=30,
            start_s=0.1,
            end_s=1.5,
        ),
        "scramble": plain.then("scramble", seed=3),
        "scramble_structure": plain.then("scramble", seed=3, keep="structure"),
        "scramble_horizontal": plain.then("scramble", seed=4294967295, directions="horizontal"),
        "limb_dots": plain.then("limb_dots", number=9, lifetime_s=0.1, seed=5),
        "limb_dots_joints": plain.then(
            "limb_dots", number=6, lifetime_s=0.125, seed=5, places="joints", asynchrony=0
        ),
        "limb_dots_for_ever": plain.then("limb_dots", number=6, lifetime_s=None, seed=5),
        "blur": plain.then("blur", sd_mm=80),
        "mask_random": plain.then("mask", kind="random", number=9, lifetime_s=0.2, seed=6),
        "mask_linear": plain.then("mask", kind="linear", number=9, speed_mm_s=900, seed=6),
        "mask_linear_one_way": plain.then(
            "mask",
            kind="linear",
            number=9,
            speed_mm_s=900,
            direction_deg=200,
            lifetime_s=0.5,
            seed=6,
        ),
        "mask_scrambled": plain.then("mask", kind="scrambled", signal_to_noise=0.75, seed=6),
        "mask_scrambled_phases": plain.then(
            "mask", kind="scrambled", number=8, phases=True, lifetime_s=0.4, seed=6
        ),
        "chain": make_stimulus(
            [walker, Figure(person(2), position_mm=(0.0, 1000.0, 0.0), heading_deg=90.0)],
            eye_distance_mm=4000,
        )
        .then("speed", factor=1.25)
        .then("mask", kind="scrambled", number=7, seed=1, figures=[1])
        .then("scramble", seed=8, figures=[1])
        .then("invert")
        .then("limb_dots", number=5, lifetime_s=0.3, seed=2, figures=[0])
        .then("rotate", axis="z", angle_deg=0, speed_deg_s=-45),
    }


def expected(stimulus: Stimulus, times: tuple[float, ...] = TIMES_S) -> dict[str, Any]:
    """The golden file of a stimulus."""
    played = stimulus.play(times)
    return {
        "stimulus": stimulus.to_dict(),
        "times_s": list(times),
        "dots": list(played.dots),
        "figures": played.figures.tolist(),
        "positions_mm": _plain(played.positions),
        "visible": played.visible.astype(int).tolist(),
        "picture_mm": _plain(played.picture),
    }


def chance() -> dict[str, Any]:
    """Words and numbers of some streams."""
    names = [(1, 0, 0, 0), (2, 3, 14, 0), (4, 2**32 - 1, 65536, 7), (5, 123456789, 2, 2**31)]
    return {
        "streams": [
            {
                "purpose": purpose,
                "seed": seed,
                "index": index,
                "life": life,
                "words": random_words(purpose, seed, index, life, count=8).tolist(),
                "uniforms": uniforms(purpose, seed, index, life, count=4).tolist(),
                "normals": normals(purpose, seed, index, life, count=4).tolist(),
                "permutation_of_10": permutation(purpose, seed, index, size=10).tolist(),
            }
            for purpose, seed, index, life in names
        ]
    }


def mannequins() -> dict[str, Any]:
    """Body heights and hulls of a stimulus in perspective, at its first moment."""
    seen = stimuli()["perspective"]
    seen = replace(seen, display=replace(seen.display, style="mannequin"))
    stimulus = seen.then("resize", factor=0.8).then("occlude", markers=["left_knee"])
    bodies = drawing.mannequins(stimulus)
    hulls = drawing.hulls_of(stimulus, bodies, stimulus.play([0.4]), 0)
    balls = np.concatenate([hulls.middles, hulls.radii[..., None]], axis=2)
    return {
        "stimulus": stimulus.to_dict(),
        "time_s": 0.4,
        "heights_mm": body_heights(stimulus),
        "balls": balls.round(6).tolist(),
        "tones": hulls.tones.tolist(),
    }


def _plain(values: np.ndarray) -> list[Any]:
    plain = values.round(9).astype(object)
    plain[np.isnan(values)] = None
    return plain.tolist()


def text(content: dict[str, Any]) -> str:
    """One line for each part."""
    parts = (f"{json.dumps(k)}: {json.dumps(v, separators=(',', ':'))}" for k, v in content.items())
    return "{\n" + ",\n".join(parts) + "\n}\n"


if __name__ == "__main__":
    for name, stimulus in stimuli().items():
        (FOLDER / f"stimulus_{name}.json").write_text(text(expected(stimulus)), encoding="utf-8")
    (FOLDER / "mannequin.json").write_text(text(mannequins()), encoding="utf-8")
    (FOLDER / "random.json").write_text(text(chance()), encoding="utf-8")
