"""Headings of traits name a unit in the ways people write them."""

from __future__ import annotations

import pytest

from eigenwalker.population.trait_table import heading_parts


@pytest.mark.parametrize(
    ("heading", "parts"),
    [
        ("Height (cm)", ("Height", "cm")),
        ("Weight [kg]", ("Weight", "kg")),
        ("Age / years", ("Age", "years")),
        ("age_years", ("age", "years")),
        ("leg length in mm", ("leg length", "mm")),
        ("Age (at test)", ("Age", "")),
        ("Sex (m/f)", ("Sex", "")),
        ("patient_id", ("patient_id", "")),
        ("happy", ("happy", "")),
    ],
)
def test_a_heading_has_a_name_and_a_unit(heading, parts) -> None:
    assert heading_parts(heading) == parts
