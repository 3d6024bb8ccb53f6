"""The classical manipulations of point-light walkers, each as the conditions of a design."""

from __future__ import annotations

import json
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Manipulation:
    """Conditions that differ in one thing, and where they come from."""

    about: str
    conditions: tuple[dict[str, Any], ...]
    view_deg: float = 90.0


def _by_factor(transform: str, factors: tuple[float, ...], **more: Any) -> tuple[dict, ...]:
    return tuple(
        {
            "name": f"{transform}_{factor:g}".replace(".", "-"),
            "level": factor,
            "transforms": [{"name": transform, "factor": factor, **more}],
        }
        for factor in factors
    )


_PLAIN: dict[str, Any] = {"name": "plain"}
MANIPULATIONS = {
    "arm_swing": Manipulation(
        "Arms that swing less or more than they do (Kozlowski and Cutting, 1977)",
        _by_factor("arm_swing", (0.0, 0.5, 1.0, 1.5, 2.0)),
    ),
    "playback_speed": Manipulation(
        "The same walk played slower or faster (Barclay, Cutting and Kozlowski, 1978)",
        _by_factor("speed", (0.7, 1.0, 1.4)),
    ),
    "occlusion": Manipulation(
        "The upper or the lower body alone (Kozlowski and Cutting, 1977)",
        (
            _PLAIN,
            {"name": "upper_body", "transforms": [{"name": "occlude", "parts": ["lower_body"]}]},
            {"name": "lower_body", "transforms": [{"name": "occlude", "parts": ["upper_body"]}]},
        ),
    ),
    "exposure": Manipulation(
        "Shown for a part of a cycle up to several (Barclay, Cutting and Kozlowski, 1978)",
        tuple(
            {"name": f"ms_{round(1000 * each)}", "level": each, "duration_s": each}
            for each in (0.4, 0.8, 1.6, 2.4, 4.4)
        ),
    ),
    "blur": Manipulation(
        "Dots blurred into one blob (Barclay, Cutting and Kozlowski, 1978)",
        (
            _PLAIN,
            {"name": "blob", "level": 80.0, "transforms": [{"name": "blur", "sd_mm": 80.0}]},
        ),
    ),
    "inversion": Manipulation(
        "Upside down (Sumi, 1984; Barclay, Cutting and Kozlowski, 1978)",
        (
            {"name": "upright", "level": 0.0},
            {"name": "inverted", "level": 180.0, "transforms": [{"name": "invert"}]},
        ),
    ),
    "ellipses": Manipulation(
        "Synthetic walkers with ellipses of shoulders and hips of men and women (Cutting, 1978)",
        tuple(
            {
                "name": name,
                "transforms": [{"name": "ellipses", "shoulder_mm": shoulder, "hip_mm": hip}],
            }
            for name, shoulder, hip in (
                ("wide_shoulders", [35.0, 12.0], [15.0, 20.0]),
                ("wide_hips", [20.0, 12.0], [30.0, 20.0]),
            )
        ),
    ),
    "conflict": Manipulation(
        "Widths of shoulders and hips against their sway (Mather and Murdoch, 1994)",
        tuple(
            {
                "name": name,
                "transforms": [
                    {
                        "name": "conflict",
                        "shoulder_width": width,
                        "hip_width": 2 - width,
                        "shoulder_sway": sway,
                        "hip_sway": 2 - sway,
                    }
                ],
            }
            for name, width, sway in (
                ("male_both", 1.2, 1.5),
                ("male_width_female_sway", 1.2, 0.5),
                ("female_width_male_sway", 0.8, 1.5),
                ("female_both", 0.8, 0.5),
            )
        ),
        view_deg=0.0,
    ),
    "sticks": Manipulation(
        "Dots, or a stick figure with links",
        ({"name": "dots", "style": "dots"}, {"name": "sticks", "style": "sticks"}),
    ),
}
CARICATURE = Manipulation(
    "Walkers moved along the axis of sex, toward the extreme of their own class (Hill and Pollick,"
    " 2000)",
    tuple(
        {"name": f"alpha_{alpha:g}", "level": alpha, "trait": "sex", "alpha": alpha}
        for alpha in (0.0, 1.0, 2.0, 4.0, 6.0)
    ),
    view_deg=30.0,
)


def manipulation_design(template: str, name: str, manipulation: Manipulation) -> str:
    """Return the design file of a manipulation; the seed is still to be filled in."""
    tables = "\n".join(_table(each) for each in manipulation.conditions)
    names = ", ".join(f'"{each["name"]}"' for each in manipulation.conditions)
    values = {
        "about": manipulation.about,
        "name": name,
        "view": f"{manipulation.view_deg:.1f}",
        "conditions": tables,
        "names": names,
    }
    for each, text in values.items():
        template = template.replace(f"{{{each}}}", text)
    return template


def _table(condition: dict[str, Any]) -> str:
    lines = [f"{name} = {_toml(value)}" for name, value in condition.items()]
    return "[[conditions]]\n" + "\n".join(lines) + "\n"


def _toml(value: Any) -> str:
    """Return a value as TOML, in one line."""
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{name} = {_toml(part)}" for name, part in value.items()) + " }"
    if isinstance(value, list):
        return "[" + ", ".join(map(_toml, value)) + "]"
    return json.dumps(value)
