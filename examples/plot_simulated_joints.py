"""How the joints of simulated people turn over a stride.

Grey: forty people; black: their mean; dashed: the norm of Schwartz et al. (2008) from which the
lower body starts; knees stand 2 degrees above it, at the level of Pinzone et al. (2014). Name a
folder of captures (``python plot_simulated_joints.py FOLDER``) to lay real walks over them.
"""

import sys
import warnings
from itertools import pairwise
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import eigenwalker as ew

SHARE = np.linspace(0, 1, 101)


def strides(walk):
    """Thigh, knee, upper arm and elbow over strides that begin with the foot furthest ahead."""
    time, place = walk["time"].values, {m: walk.sel(marker=m).values for m in walk["marker"].values}
    found = {}
    for side in ("left", "right"):
        bone = {
            above: place[f"{side}_{below}"] - place[f"{side}_{above}"]
            for above, below in pairwise(("hip", "knee", "ankle"))
        } | {
            above: place[f"{side}_{below}"] - place[f"{side}_{above}"]
            for above, below in pairwise(("shoulder", "elbow", "wrist"))
        }
        lean = {name: np.degrees(np.arctan2(v[:, 0], -v[:, 2])) for name, v in bone.items()}
        upper, fore = bone["shoulder"], bone["elbow"]
        lengths = np.linalg.norm(upper, axis=1) * np.linalg.norm(fore, axis=1)
        angles = {
            "thigh against the vertical": lean["hip"],
            "knee flexion": lean["hip"] - lean["knee"],
            "upper arm against the vertical": lean["shoulder"],
            "elbow flexion": np.degrees(np.arccos((upper * fore).sum(axis=1) / lengths)),
        }
        if f"{side}_heel" in place:
            foot = place[f"{side}_toe"] - place[f"{side}_heel"]
            angles["ankle"] = np.degrees(np.arctan2(foot[:, 2], foot[:, 0])) - lean["knee"]
        ahead = (place[f"{side}_ankle"] - place["pelvis"])[:, 0]
        reach = round(0.3 / ew.fundamental_frequency(walk) / (time[1] - time[0]))
        peaks = [
            i
            for i in range(1, len(ahead) - 1)
            if ahead[i] == ahead[max(0, i - reach) : i + reach + 1].max()
        ]
        for name, angle in angles.items():
            for first, last in pairwise(peaks):
                at = time[first] + SHARE * (time[last] - time[first])
                found.setdefault(name, []).append(np.interp(at, time, angle))
    return {name: np.mean(curves, axis=0) for name, curves in found.items()}


def with_feet(capture):
    """The joints of a capture in place, and the markers on its heels and toes."""
    return ew.in_place(ew.virtual_markers(capture, joints="full"))


def miss(simulated, real):
    """Root mean square difference of two curves, as they are and once each mean is taken out."""
    return f"{np.sqrt(np.mean((simulated - real) ** 2)):.1f}, {np.std(simulated - real):.1f}"


def real_walks(folder):
    """Mean curves of the level walks that are there, capture set by capture set."""
    sets = {"cmu": "cmu/*_01.*", "bandai-namco normal": "bandai-namco/**/*normal*.bvh"}
    for name, pattern in sets.items():
        curves = []
        for path in sorted(Path(folder).glob(pattern)):
            try:
                curves.append(strides(ew.in_place(ew.virtual_markers(ew.read_mocap(path)))))
            except ValueError as reason:
                print(f"{path.name}: {reason}")
        if curves:
            yield name, {joint: np.mean([c[joint] for c in curves], axis=0) for joint in curves[0]}


def main():
    people = [strides(ew.simulate_walk(seed=seed)) for seed in range(40)]
    mean = {name: np.mean([one[name] for one in people], axis=0) for name in people[0]}
    figure, axes = plt.subplots(1, 4, figsize=(14, 3.4), layout="constrained")
    hip, tilt, knee = (
        ew.core.harmonic_basis(SHARE - 0.04, 4) @ ew.simulation.norm_coefficients(name, 0.43, 4)
        for name in ("hip_flexion", "pelvis_tilt", "knee_flexion")
    )
    norms = {"thigh against the vertical": hip - tilt, "knee flexion": knee}
    for ax, (name, curve) in zip(axes, mean.items(), strict=True):
        ax.plot(100 * SHARE, np.transpose([one[name] for one in people]), "0.8", lw=1)
        ax.plot(100 * SHARE, curve, "k", lw=2)
        if name in norms:
            ax.plot(100 * SHARE, norms[name], "k--", lw=1)
        ax.set(title=name, xlabel="% of stride", ylabel="degrees" if ax is axes[0] else "")
    real = dict(real_walks(sys.argv[1])) if len(sys.argv) > 1 else {}
    for label, curves in real.items():
        for ax, curve in zip(axes, curves.values(), strict=True):
            ax.plot(100 * SHARE, curve, label=label)
        axes[1].legend(loc="upper left", fontsize=8)
    if real:
        walkers = ew.load_population().walkers
        seen = [strides(each.trajectories(np.arange(0, 12, 1 / 120))) for each in walkers]
        print("RMS in degrees, and once each mean is taken out; the same of the built-in walkers:")
        for name in mean:
            captured = np.mean([one[name] for one in real.values()], axis=0)
            built_in = np.mean([one[name] for one in seen], axis=0)
            print(name, miss(mean[name], captured), "|", miss(built_in, captured))
        walks = (ew.simulate_walk(seed=seed, duration_s=6, markers="skin") for seed in range(40))
        ankles = [strides(with_feet(walk))["ankle"] for walk in walks]
        capture = strides(with_feet(ew.read_mocap(Path(sys.argv[1], "cmu", "02_01.c3d"))))
        print("ankle", miss(np.mean(ankles, axis=0), capture["ankle"]))
    figure.savefig("simulated_joints.png", dpi=110)


if __name__ == "__main__":
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # units and rates that files do not name, and are guessed
        main()
