"""Simulated people in numbers: the tables of docs/simulation.md.

Prints, as Markdown, the built-in population beside Troje (2002), its joints beside published
norms, how its feet hold the ground, how well its sexes are told apart, and how well what was
planted is found again.
"""

import numpy as np

import eigenwalker as ew
from eigenwalker.population import match_sign_and_order, posture_correlations
from eigenwalker.simulation import (
    EFFECTS,
    PARAMETERS,
    TOE_BEND,
    draw_people,
    random_effect,
    true_direction,
    truth_of,
)

SHORT = {
    "ANSUR II (Gordon et al. 2014, Natick/TR-15/007), ages 18 to 38": "ANSUR II",
    "Pinzone, Schwartz & Baker 2014, Gait Posture 40:286": "Pinzone 2014",
    "Schwartz et al. 2008, J Biomech 41:1639": "Schwartz 2008",
    "Troje 2002, J Vision 2:371": "Troje 2002",
}


def table(*columns):
    print("| " + " | ".join(columns) + " |")
    print("|" + "---|" * len(columns))


def row(*cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |")


def mean_sd(values, digits=1):
    return f"{np.mean(values):.{digits}f} ({np.std(values, ddof=1):.{digits}f})"


def listed(values, digits=2):
    return ", ".join(f"{value:.{digits}f}" for value in values)


def beside_the_paper(populations):
    table("", "Troje 2002", *populations)
    columns = [list(_figures(people)) for people in populations.values()]
    for cells in zip(*columns, strict=True):
        (name, paper, _), values = cells[0], [value for _, _, value in cells]
        row(name, paper, *values)


def _figures(people):
    fits = [walker.fit for walker in people.walkers]
    male = (people.traits["sex"] == "male").to_numpy()
    frequency = people.part("frequency")[:, 0]
    shares = np.array([fit.variance_share for fit in fits])
    yield "variance in PC1, %", "84", f"{100 * shares[:, 0].mean():.1f}"
    yield "variance in four PCs, %", "over 98", f"{100 * shares[:, :4].sum(axis=1).mean():.1f}"
    sines = np.array([fit.sine_r2 for fit in fits]).mean(axis=0)
    yield "R2 of the sines", "0.99, 0.95, 0.94, 0.90", listed(sines)
    p0 = posture_correlations(np.array([[walker.p0] for walker in people.walkers]))
    yield "correlation of mean postures", "0.998", f"{p0[0]:.4f}"
    eigen = posture_correlations(match_sign_and_order(people.walkers))
    yield "of eigenpostures, sign and order", "0.95, 0.88, 0.85, 0.73", listed(eigen)
    own = posture_correlations(np.array([walker.p for walker in people.walkers]))
    yield "of eigenpostures, in correspondence", "", listed(own)
    yield "frequency of women, Hz", "0.845 (0.09)", mean_sd(frequency[~male], 3)
    yield "frequency of men, Hz", "0.836 (0.07)", mean_sd(frequency[male], 3)
    order = [np.argsort(fit.harmonics, kind="stable") for fit in fits]
    phases = np.degrees([f.phases[o] for f, o in zip(fits, order, strict=True)])
    yield "phi2, degrees", "91 (5.3)", mean_sd(np.abs(phases[:, 1] - phases[:, 0]) % 180)
    yield "phi4 - phi3, degrees", "91 (3.8)", mean_sd((phases[:, 3] - phases[:, 2]) % 180)
    power = [[(w.p[w.harmonics == h] ** 2).sum() for h in (1, 2)] for w in people.walkers]
    yield "second harmonic's power, %", "under 5", f"{100 * np.mean([b / a for a, b in power]):.1f}"
    standard = (people.X - people.X.mean(axis=0)) / people.X.std(axis=0)
    spectrum = np.linalg.svd(standard, compute_uv=False) ** 2
    yield (
        "variance in 15 eigenwalkers, %",
        "80",
        f"{100 * spectrum[:15].sum() / spectrum.sum():.0f}",
    )


def beside_the_norms(n_each):
    found = {}
    for _, person in draw_people(n_each, n_each, seed=1).iterrows():
        walk = ew.simulate_walk(dict(person), duration_s=3)
        stride = walk.isel(time=walk["phase"].values < 1)
        knee, hip = stride["left_knee_flexion_deg"].values, stride["left_hip_flexion_deg"].values
        ankle = stride["left_ankle_dorsiflexion_deg"].values
        rotation = stride["pelvis_rotation_deg"].values
        half, stance = len(knee) // 2, round(0.6 * len(knee))
        pelvis = stride.sel(marker="pelvis").values
        head = stride.sel(marker="head").values
        measures = {
            ("hip at contact", "36.3 (5.2)"): hip[0],
            ("least hip", "-5.7 (6.5)"): hip.min(),
            ("knee at contact", "5.6 (4.7)"): knee[0],
            ("greatest knee in loading", "about 18 to 20"): knee[:half].max(),
            ("least knee in stance", "1.8 (4.3)"): knee[half // 2 : half].min(),
            ("greatest knee", "60.5 (4.8)"): knee.max(),
            ("dorsiflexion", "12.8 (3.6)"): ankle[:stance].max(),
            ("plantarflexion", "-22 (7.4)"): ankle.min(),
            ("pelvic tilt", "11.6 (4.9)"): stride["pelvis_tilt_deg"].values.mean(),
            ("range of obliquity", "8.4 (3.5)"): np.ptp(stride["pelvis_obliquity_deg"].values),
            ("range of pelvic rotation", "12.0 (4.2)"): np.ptp(rotation),
            ("range of the shoulder", "30"): np.ptp(stride["left_shoulder_flexion_deg"].values),
            ("range of the elbow", "29.7 (10.2)"): np.ptp(stride["left_elbow_flexion_deg"].values),
            ("pelvis up and down, mm", "27 to 48, SD 7"): np.ptp(pelvis[:, 2]),
            ("pelvis to the side, mm", "39 to 70 over ground"): np.ptp(pelvis[:, 1]),
            ("pelvis fore and aft, mm", ""): np.ptp(pelvis[:, 0]),
            ("head to the side, mm", "59 (17)"): np.ptp(head[:, 1]),
        }
        for name, value in measures.items():
            found.setdefault(name, []).append(value)
    table("degrees unless said", "published", "simulated")
    for (name, published), values in found.items():
        row(name, published, mean_sd(values))


def on_the_ground(n_each):
    slips, clearances = [], []
    for seed, (_, person) in enumerate(draw_people(n_each, n_each, seed=0).iterrows()):
        walk = ew.simulate_walk(
            dict(person), seed=seed, markers="full", variability=1, wander_mm=10
        )
        slips.append(max(slip for side in ("left", "right") for slip in _slips(walk, side)))
        clearances.append(min(_clearance(walk, side) for side in ("left", "right")))
    table("worst of all steps of a person, mm", "median person", "worst person")
    row("sole slip on the belt", f"{np.median(slips):.1f}", f"{max(slips):.1f}")
    row("clearance in mid-swing", f"{np.median(clearances):.1f}", f"{min(clearances):.1f}")


def _slips(walk, side):
    belt = np.outer(walk.attrs["speed_mm_s"] * walk["time"].values, [1, 0])
    pitch = np.radians(walk[f"{side}_foot_pitch_deg"].values)
    flat = (pitch >= 0) & (pitch <= TOE_BEND)
    stance = walk[f"{side}_stance"].values
    number = np.cumsum(np.diff(stance.astype(int), prepend=0) == 1)
    for point, bears in (("heel", pitch <= 0), ("ball", flat), ("toe", pitch > TOE_BEND)):
        place = walk.sel(marker=f"{side}_{point}", axis=["x", "y"]).values + belt
        for which in range(number.min() + 1, number.max()):
            here = stance & bears & (number == which)
            if here.any():
                yield np.hypot(*np.ptp(place[here], axis=0))


def _clearance(walk, side):
    stance = walk.attrs["stance_of_stride"]
    own = (walk["phase"].values - (side == "right") * walk.attrs["right_onset"]) % 1.0
    swing = (own - stance) / (1 - stance)
    sole = walk.sel(marker=[f"{side}_{point}" for point in ("heel", "ball", "toe")], axis="z")
    return float(sole.values[(swing > 0.25) & (swing < 0.8)].min())


def joints_from_skin(n_people):
    misses = {}
    for seed in range(n_people):
        joints, skin = (
            ew.simulate_walk(seed=seed, duration_s=6, markers=m) for m in ("joints", "skin")
        )
        miss = np.linalg.norm(ew.virtual_markers(skin).values - joints.values, axis=2).mean(axis=0)
        for name, one in zip(ew.JOINTS.markers, miss, strict=True):
            misses.setdefault(name.removeprefix("left_").removeprefix("right_"), []).append(one)
    table("joint", "mean miss, mm", "of the worst person")
    for name, found in misses.items():
        row(name, f"{np.mean(found):.0f}", f"{max(found):.0f}")


def signs(people):
    return np.where(people.traits["sex"] == "male", 1, -1)


def told_apart(populations):
    panels = {
        "all, original size": ("all", False, 3),
        "all": ("all", True, 7),
        "structure": ("structure", True, 11),
        "dynamics": ("dynamics", True, 6),
        "p1": ("p1", True, 6),
        "p1+p2+p3": ("p1+p2+p3", True, 4),
        "phases": ("phases", True, 15),
    }
    table("fewest errors of 40 left out", "Troje 2002", *populations)
    for name, (part, normalised, paper) in panels.items():
        errors = []
        for people in populations.values():
            used = people.size_normalised() if normalised else people
            curves = ew.jackknife_curves(used.part(part), signs(people))
            errors.append(int(curves.generalisation[:25].min()))
        row(name, paper, *errors)


def along_the_axes(people):
    """What is seen 3 SD to either side of the average, size divided out."""
    traits = people.traits
    male = (traits["sex"] == "male").to_numpy()
    weight, height = (traits[name] - traits[name].mean() for name in ("weight_kg", "height_mm"))
    design = np.column_stack([np.ones(len(people)), male, height, weight / weight.std()])
    by_weight = np.linalg.lstsq(design, people.X, rcond=None)[0][-1]
    steps = {"sex": ew.trait_axis(people, "sex").step, "weight": by_weight}
    table("size divided out", "women, -3 SD", "men, +3 SD", "light, -3 SD", "heavy, +3 SD")
    columns = [
        _seen(people.walker(people.average + alpha * step))
        for step in steps.values()
        for alpha in (-3, 3)
    ]
    for name in columns[0]:
        row(name, *(column[name] for column in columns))


def _seen(walker):
    walk = walker.trajectories(np.arange(200) / 200 * walker.period_s)
    across, middle = {}, {}
    for joint in ("shoulder", "elbow", "hip"):
        left, right = (walk.sel(marker=f"{side}_{joint}", axis="y") for side in ("left", "right"))
        across[joint], middle[joint] = float((left - right).mean()), (left + right).values / 2
    wave = np.exp(-2j * np.pi * np.arange(200) / 200)
    stride = wave @ walk.sel(marker="left_ankle", axis="x").values
    phases = {
        name: np.degrees(np.angle(wave @ path / stride))
        for name, path in (("own", middle["hip"]), ("less", middle["hip"] - middle["shoulder"]))
    }
    return {
        "shoulders over hips": f"{across['shoulder'] / across['hip']:.2f}",
        "elbows further apart than shoulders, mm": f"{across['elbow'] - across['shoulder']:.0f}",
        "shoulders to the side, mm": f"{np.ptp(middle['shoulder']):.0f}",
        "hips to the side, mm": f"{np.ptp(middle['hip']):.0f}",
        "hips to the side, phase in the stride, degrees": f"{phases['own']:.0f}",
        "hips less shoulders, the same": f"{phases['less']:.0f}",
        "pelvis up and down, mm": f"{np.ptp(walk.sel(marker='pelvis', axis='z').values):.0f}",
        "frequency, Hz": f"{walker.frequency_hz:.3f}",
    }


def nothing_planted(n_seeds):
    shares = []
    for seed in range(n_seeds):
        people = ew.simulate_population(20, 20, seed=seed, sex_effect=0, effects={}, duration_s=6)
        curves = ew.jackknife_curves(people.X, signs(people))
        shares.append(curves.generalisation[3] / 40)
    error = np.std(shares, ddof=1) / np.sqrt(n_seeds)
    print(
        f"Nothing planted, {n_seeds} seeds, 20 + 20 walkers, 4 components: "
        f"{100 * np.mean(shares):.1f} % errors, standard error {100 * error:.1f}."
    )


def found_again(n_each):
    people = ew.simulate_population(n_each, n_each, seed=11)
    spread = people.X.std(axis=0)
    told = spread > 0.02  # in place, the pelvis is over the origin by construction
    scores = truth_of(people).people.filter(like="_score")
    design = np.column_stack([np.ones(len(scores)), scores])
    found = np.linalg.lstsq(design, people.X / np.where(told, spread, 1), rcond=None)[0][1:]
    error = np.sqrt(np.diag(np.linalg.inv(design.T @ design)))[1:]
    table("trait", "true size, SD", "sampling error, SD", "cosine found", "expected")
    for number, name in enumerate(scores):
        truth = true_direction(people, name.removesuffix("_score"))[told] / spread[told]
        size = np.sqrt(np.mean(truth**2))
        cosine = found[number, told] @ truth / np.linalg.norm(found[number, told])
        row(
            name.removesuffix("_score"), f"{size:.2f}", f"{error[number]:.2f}",
            f"{cosine / np.linalg.norm(truth):.2f}", f"{size / np.hypot(size, error[number]):.2f}",
        )  # fmt: skip
    print()
    table("planted alone, 8 mm", "cosine found")
    for part in ("structure", "dynamics"):
        plain, planted = (
            ew.simulate_population(
                n_each,
                n_each,
                seed=12,
                sex_effect=0,
                effects={},
                duration_s=6,
                planted=added,
            )
            for added in ({}, {"sex": random_effect(part, size_mm=8, seed=1)})
        )
        found = [_mean_difference(people, part) for people in (plain, planted)]
        spread = plain.part(part).std(axis=0)
        told = spread > 0.02
        truth = true_direction(planted, "sex")[planted.layout.columns(part)][told] / spread[told]
        seen = found[1][told] / spread[told]
        row(part, f"{seen @ truth / np.linalg.norm(seen) / np.linalg.norm(truth):.2f}")


def _mean_difference(people, part):
    features, sign = people.part(part), signs(people)
    return features[sign > 0].mean(axis=0) - features[sign < 0].mean(axis=0)


def where_numbers_come_from():
    table("parameter", "women", "men", "SD", "source")
    for name, parameter in PARAMETERS.items():
        women, men, sd = (f"{value:g}" for value in parameter[:3])
        source = parameter.source
        for long, short in SHORT.items():
            source = source.replace(long, short)
        row(name, women, men, sd, source)
    print()
    table("trait", "what one unit of it adds, in SDs of the parameter")
    for trait, sizes in EFFECTS.items():
        row(trait, ", ".join(f"{name} {size:+g}" for name, size in sizes.items()))


def main():
    populations = {"built-in": ew.load_population()}
    populations |= {f"seed {n}": ew.simulate_population(20, 20, seed=n) for n in (1, 2)}
    print("### Where the numbers come from\n")
    where_numbers_come_from()
    print("\n### Beside the paper\n")
    beside_the_paper(populations)
    print("\n### Beside published norms, 100 people\n")
    beside_the_norms(50)
    print("\n### On the ground, 40 people\n")
    on_the_ground(20)
    print("\n### Joints found from the skin, 20 people\n")
    joints_from_skin(20)
    print("\n### Told apart\n")
    body_alone = ew.simulate_population(20, 20, seed=0, effects={}, balanced=True)
    told_apart(populations | {"built-in, body alone": body_alone})
    print("\n### Along the axes\n")
    along_the_axes(populations["built-in"].size_normalised())
    print("\n### Nothing planted\n")
    nothing_planted(50)
    print("\n### Found again, 200 women and 200 men\n")
    found_again(200)


if __name__ == "__main__":
    main()
