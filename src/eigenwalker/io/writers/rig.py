"""A rig: a skeleton of constant bones, its rest pose, and how it moves over captured joints.

At rest the body stands on the floor and faces forward, arms in a T or an A, legs straight. Hips,
shoulders and head lie where they are on average in the frames of pelvis and chest. The pelvis
turns with both hips, the chest with both shoulders; the bones of the spine between them share the
twist. All other bones turn the shortest way. Where feet, hands or the top of the head were not
captured they have usual lengths: hands go with the forearms, feet with the shanks, but not through
the floor.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from importlib.resources import files
from typing import Any, Literal, NamedTuple

import numpy as np
import xarray as xr

from eigenwalker.core.arguments import check_choice
from eigenwalker.core.kinematics import forward_kinematics, rigid_turn, shortest_turn
from eigenwalker.core.quaternions import Rotation
from eigenwalker.core.skeleton import JOINTS
from eigenwalker.core.trajectories import check_trajectories, missing_markers

_TOML = files("eigenwalker.io.writers").joinpath("rigs.toml").read_text(encoding="utf-8")
SKELETONS = tomllib.loads(_TOML)
"""Names of bones, by skeleton."""
SIDES = ("left", "right")
FORWARD, LEFT, UP = np.eye(3)
A_POSE_DEG = 45.0
"""By how much arms hang below the horizontal in an A."""
CLAVICLE = 0.15
"""Where a clavicle begins that was not captured, as a share of the way to the shoulder."""
BALL, TIP, ANKLE, HAND, SKULL, SPINE = 0.14, 0.085, 0.08, 0.1, 0.11, 0.05
"""As shares of the leg: ankle to ball of the foot (forward), to the tip of the toes, height of the
ankle, length of a hand, how far the skull reaches below and above the middle of the head, and
how far above the pelvis the spine begins."""
FLAT_DEG = 8.0
"""By how much a shank may lean back before the foot leaves the floor."""
EXTRAS = (
    "head_top",
    *(f"{side}_{part}" for side in SIDES for part in ("clavicle", "hand", "toe", "heel")),
)
"""Points beyond the 15 joints that a rig has where they are known."""
ENDS = ("head_top", *(f"{side}_{end}" for side in SIDES for end in ("hand", "toe_end")))
"""Where chains end in a skeleton that has no joint there."""
FLIP = np.array([1.0, -1.0, -1.0])


class _Joint(NamedTuple):
    role: str
    parent: str
    rest: np.ndarray


@dataclass(frozen=True, eq=False)
class Rig:
    """Bones of a body and how they move; x forward, y left, z up, mm.

    Joints stand in the order of their tree, parents before children.
    """

    names: tuple[str, ...]
    """Names of the joints; end sites, which do not turn, have none."""
    roles: tuple[str, ...]
    """What each is: the names of markers, where there are such."""
    parents: tuple[int, ...]
    rest: np.ndarray
    """Place of each joint at rest relative to its parent, (joint, 3); of the root, to the floor."""
    axes: np.ndarray
    """Directions of each joint's own axes at rest, as columns, (joint, 3, 3): y along the bone."""
    moves: Mapping[int, np.ndarray]
    """Joints that move from their parents, and their places in their parents' frames, (time, 3)."""
    turns: np.ndarray
    """Rotations from rest, in the room: unit quaternions x, y, z, w of shape (time, joint, 4)."""

    @property
    def rotations(self) -> np.ndarray:
        """Rotations relative to the parent, as BVH has them: (time, joint, 4)."""
        return _relative(self.parents, [_rotation(turn) for turn in np.moveaxis(self.turns, 1, 0)])

    @property
    def oriented_rotations(self) -> np.ndarray:
        """Rotations of each joint's own axes relative to those of its parent: (time, joint, 4)."""
        turned = [
            _rotation(turn) * Rotation.from_matrix(axes)
            for turn, axes in zip(np.moveaxis(self.turns, 1, 0), self.axes, strict=True)
        ]
        return _relative(self.parents, turned)

    @property
    def positions(self) -> np.ndarray:
        """Places of the joints: (time, joint, 3)."""
        offsets = np.tile(self.rest, (len(self.turns), 1, 1))
        for joint, places in self.moves.items():
            offsets[:, joint] = places
        return forward_kinematics(self.parents, offsets, self.rotations)[0]

    def frames(self, keep: slice) -> Rig:
        """Return some of the frames."""
        moves = {joint: places[keep] for joint, places in self.moves.items()}
        return replace(self, moves=moves, turns=self.turns[keep])

    @property
    def rest_positions(self) -> np.ndarray:
        """Places of the joints at rest: (joint, 3)."""
        still = np.tile([0.0, 0.0, 0.0, 1.0], (1, len(self.parents), 1))
        return forward_kinematics(self.parents, self.rest, still)[0][0]


def _rotation(quaternions: np.ndarray) -> Rotation:
    return Rotation.from_quat(quaternions)


def _relative(parents: Sequence[int], turned: Sequence[Rotation]) -> np.ndarray:
    own = [
        each if parent < 0 else turned[parent].inv() * each
        for each, parent in zip(turned, parents, strict=True)
    ]
    return np.stack([each.as_quat() for each in own], axis=1)


def fit_rig(
    walk: xr.DataArray,
    skeleton: str = "plain",
    rest_pose: str = "t",
    *,
    floor_mm: float | None = None,
    ground: np.ndarray | None = None,
) -> Rig:
    """Return the rig that lies over the joints of a walk (time, marker, axis), mm.

    `ground` is where the root on the floor is, (time, 3), in skeletons that have one.
    """
    _check(walk, skeleton, rest_pose)
    ankles = _places(walk, [f"{side}_ankle" for side in SIDES])[..., 2].mean()
    if ankles > _places(walk, ["pelvis"])[..., 2].mean():  # upside down
        rig = fit_rig(walk * FLIP, skeleton, rest_pose, ground=ground)
        flip = Rotation.from_matrix(np.diag(FLIP))
        turned = [flip * _rotation(turn) for turn in np.moveaxis(rig.turns, 1, 0)]
        turns = np.stack([turn.as_quat() for turn in turned], axis=1)
        return replace(rig, turns=turns, moves={j: way * FLIP for j, way in rig.moves.items()})
    body = _Body(walk, floor_mm)
    names = SKELETONS[skeleton]
    body.grow(len(names["spine"]))
    return body.rig(names, rest_pose, ground)


def _check(walk: xr.DataArray, skeleton: str, rest_pose: str) -> None:
    check_choice(skeleton, SKELETONS, "skeleton")
    check_choice(rest_pose, ("t", "a"), "rest_pose")
    lacking = missing_markers(walk, JOINTS.markers)
    unknown = sorted(set(map(str, walk.marker.values)) - {*JOINTS.markers, *EXTRAS})
    if lacking or unknown:
        raise ValueError(
            "A BVH skeleton is made of the 15 joints, and feet, hands, clavicles and top of the "
            f"head where they are known; these trajectories lack {lacking} and have {unknown} "
            "beyond. Make joints of markers first with virtual_markers()."
        )
    check_trajectories(walk.assign_attrs(units="mm"), complete=True)


def floor_of(walk: xr.DataArray) -> float:
    """Return the height of the floor: 0 where the feet say so, else below the lowest ankle."""
    ankle = _leg_of(walk) * ANKLE
    ankles = _places(walk, [f"{side}_ankle" for side in SIDES])[..., 2]
    lowest = float(np.quantile(ankles, 0.02))
    names = [str(name) for name in walk.marker.values]
    toes = [name for name in names if name.endswith(("_toe", "_heel"))]
    lowest_toe = float(_places(walk, toes)[..., 2].min()) if toes else 0.0
    return 0.0 if 0.5 * ankle < lowest < 2 * ankle and lowest_toe >= 0 else lowest - ankle


def _places(walk: xr.DataArray, names: Sequence[str]) -> np.ndarray:
    known = [str(name) for name in walk.marker.values]
    return walk.values[:, [known.index(name) for name in names]]


def _leg_of(walk: xr.DataArray) -> float:
    """Return the mean length of thigh and shank together."""
    legs = [_places(walk, [f"{s}_{j}" for j in ("hip", "knee", "ankle")]) for s in SIDES]
    lengths = np.linalg.norm(np.diff(legs, axis=2), axis=-1)
    return float(np.median(lengths, axis=1).sum(axis=1).mean())


class _Body:
    """All joints at rest and how they turn, from the pelvis outwards."""

    def __init__(self, walk: xr.DataArray, floor_mm: float | None) -> None:
        self.seen = {
            str(name): walk.values[:, number] for number, name in enumerate(walk.marker.values)
        }
        self.leg = _leg_of(walk)
        self.floor = floor_of(walk) if floor_mm is None else floor_mm
        self.joints: dict[str, _Joint] = {}
        self.turn: dict[str, Rotation] = {}
        self.at: dict[str, np.ndarray] = {}

    def add(self, role: str, parent: str, rest: np.ndarray, turn: Rotation | None = None) -> None:
        """Add a joint, which turns with its parent until it is aimed."""
        self.joints[role] = _Joint(role, parent, rest)
        self.at[role] = self.at[parent] + self.turn[parent].apply(rest)
        self.turn[role] = turn or self.turn[parent]

    def aim(self, role: str, target: np.ndarray, direction: np.ndarray) -> np.ndarray:
        """Turn a joint the shortest way so that its bone, at rest in `direction`, meets a target.

        Return the bone at rest, of median length.
        """
        way = target - self.at[role]
        carried = self.turn[role]
        self.turn[role] = carried * shortest_turn(direction, carried.inv().apply(way))
        length = np.median(np.linalg.norm(way, axis=1))
        return direction / np.linalg.norm(direction) * length

    def grow(self, n_spine: int) -> None:
        """Add all joints."""
        hips = self._pelvis()
        self._spine(n_spine)
        self._head()
        for side in SIDES:  # so that each joint's chain stands together, as BVH needs it
            self._arm(side, f"spine_{n_spine - 1}")
        for side, hip in zip(SIDES, hips, strict=True):
            self._leg(side, hip)
            self._foot(side)

    def _pelvis(self) -> list[np.ndarray]:
        """Add the pelvis, turned with both hips; return where they are at rest."""
        pelvis, seen = self.seen["pelvis"], self.seen
        up = seen["sternum"] - pelvis
        frame = _frame(up, seen["left_hip"] - seen["right_hip"], keep="left")
        hips = [_mean_place(frame, seen[f"{side}_hip"] - pelvis) for side in SIDES]
        moving = [seen[f"{side}_hip"] - pelvis for side in SIDES]
        aside = np.linalg.norm(hips[0] + hips[1]) < 0.2 * np.linalg.norm(hips[0] - hips[1])
        if aside:  # where the hips are beside the pelvis, the trunk decides its tilt
            moving.append(up / np.linalg.norm(up, axis=1, keepdims=True))
        for _ in range(3):
            still = [*hips, UP] if aside else hips
            frame = rigid_turn(np.stack(still), np.stack(moving, axis=1))
            hips = [_mean_place(frame, way) for way in moving[:2]]
        self.joints["pelvis"] = _Joint("pelvis", "", np.zeros(3))
        self.at["pelvis"], self.turn["pelvis"] = pelvis, frame
        return hips

    def _spine(self, n_bones: int) -> None:
        """Add the spine, straight; its bones share the twist, and the last is the chest."""
        seen, first = self.seen, "spine_0"
        self.add(first, "pelvis", UP * SPINE * self.leg)
        bone = self.aim(first, seen["sternum"], UP) / n_bones
        straight, along = self.turn[first], seen["sternum"] - self.at[first]
        chest = _frame(along, seen["left_shoulder"] - seen["right_shoulder"], keep="up")
        twist = (straight.inv() * chest).as_rotvec()[:, 2]
        for number in range(n_bones):
            share = Rotation.from_rotvec(np.outer(twist * (number + 1) / n_bones, UP))
            if number:
                self.add(f"spine_{number}", f"spine_{number - 1}", bone)
            self.turn[f"spine_{number}"] = straight * share
        last = f"spine_{n_bones - 1}"
        clavicles = [f"{side}_clavicle" for side in SIDES]
        if set(clavicles) <= set(seen):  # which turn with the chest
            moving = [seen[name] - self.at[last] for name in ("sternum", *clavicles)]
            still = [bone, *(_mean_place(self.turn[last], way) for way in moving[1:])]
            self.turn[last] = rigid_turn(np.stack(still), np.stack(moving, axis=1))
        self.add("sternum", last, bone)

    def _head(self) -> None:
        head, top = self.seen["head"], self.seen.get("head_top")
        bone = self.aim(
            "sternum", head, _mean_place(self.turn["sternum"], head - self.at["sternum"])
        )
        length = float(np.linalg.norm(bone))
        half = min(self.leg * SKULL, 0.6 * length) * bone / length
        self.add("neck_middle", "sternum", (bone - half) / 2)
        self.add("skull", "neck_middle", (bone - half) / 2)
        self.add("head", "skull", half)
        crown = half
        if top is not None:
            crown = self.aim("head", top, _mean_place(self.turn["head"], top - self.at["head"]))
        self.add("head_top", "head", crown)

    def _arm(self, side: str, chest: str) -> None:
        seen, base, turn = self.seen, self.at["sternum"], self.turn[chest]
        clavicle, shoulder = f"{side}_clavicle", f"{side}_shoulder"
        hung = _mean_place(turn, seen[shoulder] - base)
        begin = CLAVICLE * hung
        if clavicle in seen:
            begin = _mean_place(turn, seen[clavicle] - base)
        self.add(clavicle, chest, self.joints["sternum"].rest + begin)
        self.add(shoulder, clavicle, self.aim(clavicle, seen[shoulder], hung - begin))
        out = LEFT * (np.sign(hung[1]) or 1.0)
        for joint, following in (("shoulder", "elbow"), ("elbow", "wrist")):
            bone = self.aim(f"{side}_{joint}", seen[f"{side}_{following}"], out)
            self.add(f"{side}_{following}", f"{side}_{joint}", bone)
        bone = out * self.leg * HAND
        if f"{side}_hand" in seen:
            bone = self.aim(f"{side}_wrist", seen[f"{side}_hand"], out)
        self.add(f"{side}_hand", f"{side}_wrist", bone)

    def _leg(self, side: str, hip: np.ndarray) -> None:
        self.add(f"{side}_hip", "pelvis", hip)
        for joint, following in (("hip", "knee"), ("knee", "ankle")):
            bone = self.aim(f"{side}_{joint}", self.seen[f"{side}_{following}"], -UP)
            self.add(f"{side}_{following}", f"{side}_{joint}", bone)

    def _foot(self, side: str) -> None:
        seen, ankle, toe, heel = self.seen, f"{side}_ankle", f"{side}_toe", np.zeros(3)
        low = float(np.quantile(seen[ankle][:, 2], 0.1)) - self.floor
        height = max(low, 0.3 * ANKLE * self.leg)
        if toe in seen:
            length = float(np.median(np.linalg.norm(seen[toe] - seen[ankle], axis=1)))
            low = float(np.quantile(seen[toe][:, 2], 0.1)) - self.floor
            low = min(max(low, 0.0), height)
            drop = min(height - low, 0.9 * length)
            bone = np.array([np.sqrt(length**2 - drop**2), 0.0, -drop])
            self.aim(ankle, seen[toe], bone)
            if f"{side}_heel" in seen:
                ways = [seen[f"{side}_{part}"] - self.at[ankle] for part in ("toe", "heel")]
                for _ in range(3):
                    heel = self.turn[ankle].inv().apply(ways[1]).mean(axis=0)
                    self.turn[ankle] = rigid_turn(np.stack([bone, heel]), np.stack(ways, axis=1))
        else:
            low, bone = 0.0, np.array([self.leg * BALL, 0.0, -height])
            self.turn[ankle] = self._on_floor(_flatter(self.turn[ankle]), self.at[ankle], bone)
        self.add(toe, ankle, bone)
        tip = np.array([self.leg * TIP, 0.0, -low])
        self.turn[toe] = self._on_floor(self.turn[toe], self.at[toe], tip)
        self.add(f"{side}_toe_end", toe, tip)
        if f"{side}_heel" in seen:
            self.add(f"{side}_heel", ankle, heel)

    def _on_floor(self, turn: Rotation, base: np.ndarray, bone: np.ndarray) -> Rotation:
        """Raise a bone where its end would be below the floor."""
        length = float(np.linalg.norm(bone))
        least = np.arcsin(np.clip((self.floor - base[:, 2]) / length, -1, 1))
        for _ in range(3):  # as the axis of the foot is not quite level
            rise = np.arcsin(np.clip(turn.apply(bone)[:, 2] / length, -1, 1))
            turn = _pitched(turn, np.maximum(least - rise, 0.0))
        return turn

    def rig(self, names: Mapping[str, Any], rest_pose: str, ground: np.ndarray | None) -> Rig:
        """Return the joints that a skeleton has, and the ends of its chains."""
        named = {role: name for role, name in _names(names).items() if role in self.joints}
        parent_of = {joint.role: joint.parent for joint in self.joints.values()}

        def nearest(role: str) -> str:
            parent = parent_of[role]
            return parent if parent in named or not parent else nearest(parent)

        carriers = {nearest(role) for role in named}
        used = [role for role in self.joints if role in named
                or (role in ENDS and nearest(role) not in carriers)]  # fmt: skip
        parents = [used.index(nearest(role)) if nearest(role) else -1 for role in used]
        at = {"": np.zeros(3)}
        for joint in self.joints.values():
            at[joint.role] = at[joint.parent] + joint.rest
        hung = _hanging(at) if rest_pose == "a" else {}
        rest = [at[role] - at[nearest(role)] for role in used]
        rest = [
            hung[nearest(role)].apply(bone) if nearest(role) in hung else bone
            for role, bone in zip(used, rest, strict=True)
        ]
        turned = [self.turn[r] * hung[r].inv() if r in hung else self.turn[r] for r in used]
        turns = np.stack([turn.as_quat() for turn in turned], axis=1)
        rest[0] = -min(place[2] for place in at.values()) * UP
        moves = {0: self.at["pelvis"]}
        if "ground" in names:
            path = np.zeros((len(turns), 3)) if ground is None else ground
            named["ground"] = names["ground"]
            used, parents = ["ground", *used], [-1, *(parent + 1 for parent in parents)]
            rest = [np.zeros(3), *rest]
            turns = np.insert(turns, 0, [0.0, 0.0, 0.0, 1.0], axis=1)
            moves = {0: path, 1: self.at["pelvis"] - path}
        labels = tuple(named.get(role, "") for role in used)
        axes = _axes(used, parents, np.stack(rest))
        return Rig(labels, tuple(used), tuple(parents), np.stack(rest), axes, moves, turns)


def _frame(up: np.ndarray, left: np.ndarray, *, keep: Literal["up", "left"]) -> Rotation:
    """Return the frame with x forward of two ways, of which one keeps its direction."""
    forward = np.cross(left, up)
    if keep == "left":
        up = np.cross(forward, left)
    else:
        left = np.cross(up, forward)
    axes = [way / np.linalg.norm(way, axis=1, keepdims=True) for way in (forward, left, up)]
    return Rotation.from_matrix(np.stack(axes, axis=2))


def _mean_place(frame: Rotation, ways: np.ndarray) -> np.ndarray:
    """Return the mean of ways in a frame, as long as they are by the median."""
    mean = frame.inv().apply(ways).mean(axis=0)
    length = np.linalg.norm(mean)
    return mean * np.median(np.linalg.norm(ways, axis=1)) / length if length else mean


def _pitched(turn: Rotation, angle: np.ndarray) -> Rotation:
    """Turn a foot so that its toes rise by an angle."""
    return turn * Rotation.from_rotvec(np.outer(-angle, LEFT))


def _flatter(turn: Rotation) -> Rotation:
    """Turn feet so that they stay flat while the shank leans back by a few degrees."""
    rise = np.rad2deg(np.arcsin(np.clip(turn.apply(FORWARD)[:, 2], -1, 1)))
    soft = FLAT_DEG / 4
    wanted = soft * (np.logaddexp(0, (rise - FLAT_DEG) / soft) - np.logaddexp(0, -rise / soft))
    return _pitched(turn, np.deg2rad(wanted - rise))


def _names(names: Mapping[str, Any]) -> dict[str, str]:
    """Return the name of each joint that a skeleton has."""
    every = {f"spine_{number}": name for number, name in enumerate(names["spine"])}
    for role, name in names.items():
        if role not in ("sides", "spine", "ground"):
            pairs = zip(SIDES, names["sides"], strict=True)
            sided = {f"{side}_{role}": name.replace("{L}", word) for side, word in pairs}
            every |= sided if "{L}" in name else {role: name}
    return every


def _hanging(at: Mapping[str, np.ndarray]) -> dict[str, Rotation]:
    """Return the turns of the arms from a T to an A."""
    turns: dict[str, Rotation] = {}
    for side in SIDES:
        out = np.sign(at[f"{side}_elbow"][1] - at[f"{side}_shoulder"][1])
        turn = Rotation.from_rotvec(-out * np.deg2rad(A_POSE_DEG) * FORWARD)
        turns |= {f"{side}_{joint}": turn for joint in ("shoulder", "elbow", "wrist", "hand")}
    return turns


def _axes(roles: Sequence[str], parents: Sequence[int], rest: np.ndarray) -> np.ndarray:
    """Return each joint's own axes as Mixamo has them: y along the bone.

    x to the left in the trunk, to the right in legs; z down in arms.
    """
    axes = np.zeros((len(roles), 3, 3))
    for joint, role in enumerate(roles):
        side, _, part = role.partition("_")
        bones = [child for child, parent in enumerate(parents) if parent == joint]
        along = rest[bones[0]] if bones else rest[joint]
        if role in ("ground", "pelvis") or role.startswith("spine") or part == "toe_end":
            along = UP  # of the tips of toes too, where Blender adds a bone that none should see
        x = LEFT
        if side in SIDES:
            arm = part in ("clavicle", "shoulder", "elbow", "wrist", "hand")
            x = -np.cross(along, UP) if arm else -LEFT
        z = np.cross(x, along)
        y = along / np.linalg.norm(along)
        z = z / np.linalg.norm(z)
        axes[joint] = np.stack([np.cross(y, z), y, z], axis=1)
    return axes
