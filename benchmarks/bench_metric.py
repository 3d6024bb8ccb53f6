"""Motion maps, paths through them, and all pairs of 21 clips.

Beside what one would reach for: scipy's cdist joint by joint, and librosa's dynamic time warping.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from itertools import combinations
from time import process_time

import librosa
import numpy as np
import xarray as xr
from scipy.spatial.distance import cdist
from side_by_side import machine, print_table, seconds

import eigenwalker as ew
from eigenwalker.metric import FrameMetric, pair_table, prepare, shaped
from eigenwalker.metric.frame_metrics import Shape
from eigenwalker.metric.kernels import n_threads
from eigenwalker.metric.paths import SLOPE_LIMIT, least_cost_path
from eigenwalker.metric.point_maps import point_map

N_FRAMES, N_JOINTS, N_CLIPS = 1400, 15, 21
ALIKE = np.full(N_JOINTS, 1 / N_JOINTS)
METRICS: dict[Shape, FrameMetric] = {
    "absolute": FrameMetric(),
    "squared": FrameMetric(shape="squared"),
    "sigmoid": FrameMetric(shape="sigmoid", scale=100.0),
    "power": FrameMetric(shape="power", exponent=0.3),
}


def clips() -> list[xr.DataArray]:
    """Two walks whose markers stand in the order in which maps take them."""
    walks = [ew.simulate_walk(seed=seed, duration_s=N_FRAMES / 120, truth=False) for seed in (1, 2)]
    return [walk.sortby("marker") for walk in walks]


def by_cdist(a: np.ndarray, b: np.ndarray, metric: FrameMetric) -> np.ndarray:
    return sum(
        (w * shaped(metric, cdist(a[:, k], b[:, k])) for k, w in enumerate(ALIKE)),
        np.zeros((len(a), len(b))),
    )


def ours(a: np.ndarray, b: np.ndarray, metric: FrameMetric) -> np.ndarray:
    parameter = metric.scale or metric.exponent or 1.0
    return point_map(a, b, ALIKE, shape=metric.shape, parameter=parameter)


def by_librosa(cost: np.ndarray) -> np.ndarray:
    return librosa.sequence.dtw(C=cost)[1][::-1]


def processor_seconds(ways: Mapping[str, Callable[[], object]]) -> dict[str, float]:
    """Return the least processor time of each way, which a busy machine hardly changes."""
    times: dict[str, list[float]] = {name: [] for name in ways}
    for _ in range(9):
        for name, way in ways.items():
            start = process_time()
            way()
            times[name].append(process_time() - start)
    return {name: min(taken) for name, taken in times.items()}


def maps() -> None:
    labelled = clips()
    a, b = (clip.values for clip in labelled)
    for shape, metric in METRICS.items():
        np.testing.assert_allclose(ours(a, b, metric), by_cdist(a, b, metric), rtol=2e-6)
        ways = {
            "cdist, joint by joint": lambda metric=metric: by_cdist(a, b, metric),
            "point_map": lambda metric=metric: ours(a, b, metric),
            "motion_map": lambda metric=metric: ew.motion_map(*labelled, metric=metric),
            "point_map, a clip with itself": lambda metric=metric: ours(a, a, metric),
        }
        title = f"Map of {N_FRAMES} x {N_FRAMES} frames, {N_JOINTS} joints, {shape}"
        aims = {} if shape == "power" else {"point_map": 8, "motion_map": 8}
        print_table(title, seconds(ways, rounds=7), aims=aims)
        print_table(f"{title}, processor time", processor_seconds(ways), aims={})


def paths() -> None:
    a, b = (clip.values for clip in clips())
    for n_frames in (120, 300, 1400):
        cost = ours(a[:n_frames], b[:n_frames], METRICS["absolute"])
        sums = [cost[tuple(way(cost).T)].sum() for way in (by_librosa, least_cost_path)]
        np.testing.assert_allclose(*sums)
        ways = {
            "librosa": lambda cost=cost: by_librosa(cost),
            "least_cost_path": lambda cost=cost: least_cost_path(cost),
            f"the same, slope_limit={SLOPE_LIMIT}": lambda cost=cost: least_cost_path(
                cost, slope_limit=SLOPE_LIMIT
            ),
        }
        times = seconds(ways, rounds=15)
        print_table(
            f"Path through {n_frames} x {n_frames} cells", times, aims={"least_cost_path": 5}
        )


BAND_IN_FLOAT32 = "pair_table, phase and heading too, a band of the map in float32"


def mean_along(cost: np.ndarray, path: np.ndarray) -> float:
    return float(cost[path[:, 0], path[:, 1]].mean())


def all_pairs() -> None:
    walks = {f"walk {seed}": ew.simulate_walk(seed=seed, truth=False) for seed in range(N_CLIPS)}
    prepared = {name: prepare(walk) for name, walk in walks.items()}
    cycles = [clip.cycle.values for clip in prepared.values() if clip.cycle is not None]
    pairs = list(combinations(cycles, 2))
    metric = METRICS["absolute"]

    def peer() -> list[float]:
        found = []
        for a, b in pairs:
            cost = by_cdist(a, b, metric)
            found.append(mean_along(cost, by_librosa(cost)))
        return found

    def same_task() -> list[float]:
        found = []
        for a, b in pairs:
            cost = ours(a, b, metric)
            found.append(mean_along(cost, least_cost_path(cost)))
        return found

    np.testing.assert_allclose(peer(), same_task(), rtol=1e-9)
    ways = {
        "cdist and librosa": peer,
        "point_map and least_cost_path, one thread": same_task,
        BAND_IN_FLOAT32: lambda: pair_table(prepared),
    }
    title = f"All {len(pairs)} pairs of {N_CLIPS} strides of {len(cycles[0])} frames"
    print_table(title, seconds(ways, rounds=9), aims={BAND_IN_FLOAT32: 8})
    print_table(f"{title}, processor time", processor_seconds(ways), aims={})
    ways = {"in_place": lambda: [ew.in_place(walk) for walk in walks.values()]}
    ways["prepare: in_place, loop, common clock"] = lambda: [prepare(w) for w in walks.values()]
    title = f"Making {N_CLIPS} walks of 12 s ready to be compared, once"
    print_table(title, seconds(ways, rounds=3), aims={})


if __name__ == "__main__":
    print(f"Metric ({machine()}, {n_threads()} threads)")
    maps()
    paths()
    all_pairs()
