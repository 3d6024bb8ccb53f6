"""Draw the README's picture: walkers from one pole of sex to the other, and past both."""

from __future__ import annotations

from pathlib import Path

import eigenwalker as ew

if __name__ == "__main__":
    people = ew.load_population().size_normalised()
    sex = ew.trait_axis(people, "sex")
    alphas = {"female 6 SD": -6, "female 3 SD": -3, "average": 0, "male 3 SD": 3, "male 6 SD": 6}
    walkers = {
        title: people.walker(people.average + alpha * sex.step) for title, alpha in alphas.items()
    }
    figure = ew.plotting.figure_walkers(walkers)
    figure.savefig(Path(__file__).parent / "images" / "walkers.png", dpi=150)
