"""Draw docs/images/frame.svg: the frame of the room, and from where the views look at it."""

from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse

from eigenwalker import decompose_fourier, simulate_walk
from eigenwalker.plotting import draw_body, observer_axes, project

BLUE, RED = "#0077BB", "#CC3311"
INK, GREY, PALE = "#1A1A1A", "#6E6E6E", "#C8C8C8"
USUAL = 8.0

VIEW, ELEVATION = 35.0, 18.0
AXES = (("x", "forward", RED), ("y", "left", "#009988"), ("z", "up", BLUE))


def draw_room(axes: Axes) -> None:
    """A walker on a floor of 500 mm squares, with the three axes at the origin."""
    walker = decompose_fourier(simulate_walk(seed=3))
    moment = walker.time_origin_s + 0.1 * walker.period_s
    posture = walker.trajectories([moment]).values[0]

    def seen(points):
        return project(points, azimuth_deg=VIEW, elevation_deg=ELEVATION)

    for line in np.arange(-1000, 1001, 500):
        for ends in ([[line, -1000, 0], [line, 1000, 0]], [[-1000, line, 0], [1000, line, 0]]):
            axes.plot(*seen(ends).T, color=PALE, lw=0.5, zorder=0)
    draw_body(axes, seen(posture), walker.markers)
    for (letter, words, ink), way in zip(AXES, np.eye(3), strict=True):
        length = 750 if letter != "z" else 2050
        tip = seen(length * way)
        arrow = {
            "arrowstyle": "-|>",
            "color": ink,
            "lw": 1.4 if letter != "z" else 0.9,
            "shrinkA": 0,
            "shrinkB": 0,
        }
        axes.annotate("", xy=tip, xytext=seen([0, 0, 0]), arrowprops=arrow, zorder=1)
        beyond = seen((length + (260 if letter != "z" else 90)) * way)
        axes.text(
            *beyond, f"{letter}  {words}", color=ink, fontsize=USUAL, ha="center", va="center"
        )
    origin = seen([0, 0, 0])
    axes.plot(*origin, "o", color=INK, ms=3)
    axes.annotate(
        "origin: the floor\nbelow the pelvis",
        xy=tuple(origin),
        xytext=(-1250, -620),
        fontsize=USUAL - 1,
        color=GREY,
        va="center",
        arrowprops={"arrowstyle": "-", "color": GREY, "lw": 0.6, "shrinkB": 4},
    )
    axes.set_title("Millimetres, right-handed; squares of 500 mm", fontsize=USUAL, color=INK)


def draw_views(axes: Axes) -> None:
    """The walker from straight above, walking up the page, and where observers stand."""
    from_above = np.array([[0.0, 1.0], [-1.0, 0.0]])  # forward is up the page, left is left
    axes.add_patch(Ellipse((0, 0), 430, 190, fc=PALE, ec="none"))
    axes.add_patch(Ellipse((0, 20), 150, 190, fc=INK, ec="none"))
    arrow = {"arrowstyle": "-|>", "color": RED, "lw": 1.4, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", xy=(0, 620), xytext=(0, 130), arrowprops=arrow)
    axes.text(-40, 420, "walks", color=RED, fontsize=USUAL, ha="right")
    for view, words in (
        (0, "front"),
        (30, "three-quarter"),
        (90, "side, walks to\nthe right"),
        (-90, "side, walks to\nthe left"),
    ):
        ahead = observer_axes(view)[2][:2] @ from_above
        look = {"arrowstyle": "->", "color": GREY, "lw": 0.8, "shrinkA": 0, "shrinkB": 0}
        axes.annotate("", xy=tuple(700 * ahead), xytext=tuple(960 * ahead), arrowprops=look)
        axes.plot(*(980 * ahead), "o", color=INK, ms=4)
        side = np.sign(round(ahead[0], 6))
        label = f"view {view}°\n{words}"
        place = 980 * ahead + (side * 70, 0 if side else 70)
        align = {1: "left", -1: "right", 0: "center"}[int(side)]
        axes.text(
            *place, label, fontsize=USUAL, color=INK, ha=align, va="center" if side else "bottom"
        )
    axes.set_title("From above: where the observer stands", fontsize=USUAL, color=INK)


def main() -> None:
    """Write the picture."""
    figure = Figure(figsize=(7.6, 3.3), layout="constrained", dpi=150)
    room, views = figure.subplots(1, 2, width_ratios=(1, 1.25))
    for axes in (room, views):
        axes.set_aspect("equal")
        axes.axis("off")
    draw_room(room)
    draw_views(views)
    room.set(xlim=(-1450, 1450), ylim=(-750, 2150))
    views.set(xlim=(-1800, 1800), ylim=(-450, 1450))
    path = Path(__file__).parent / "images" / "frame.svg"
    with mpl.rc_context({"svg.hashsalt": "eigenwalker"}):
        figure.savefig(path, metadata={"Date": None})


if __name__ == "__main__":
    main()
