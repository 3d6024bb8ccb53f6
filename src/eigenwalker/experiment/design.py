"""What a design may say: groups, sessions, blocks of trials, how they are shown and answered."""

from __future__ import annotations

import re
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

FORMAT = "eigenwalker experiment"
VERSION = 1
POSITIVE = "+"
"""As the pole of a condition: the positive one of the trait, whatever its name."""

Name = Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9_-]{0,39}$")]
Degrees = Annotated[float, Field(ge=-360, le=360)]
Seconds = Annotated[float, Field(gt=0, le=600)]
Information = Literal["full", "structure", "dynamics"]
TraitName = Annotated[str, Field(min_length=1, max_length=100)]
Alpha = Annotated[float, Field(ge=-20, le=20)]
Repeats = Annotated[int, Field(ge=0, le=20)]
NumberOfTrials = Annotated[int, Field(ge=1, le=2000)]


class Part(BaseModel):
    """A part of a design, which refuses words that it does not know."""

    model_config = ConfigDict(extra="forbid", frozen=True, allow_inf_nan=False, strict=True)


class Walkers(Part):
    """Which walkers of the population are shown."""

    number: Annotated[int | None, Field(ge=2, le=1000)] = None
    """Drawn by the seed where the population has more; left out, all."""


class Picture(Part):
    """How walkers are shown."""

    style: Literal["dots", "sticks", "mannequin"] = "dots"
    duration_s: Seconds = 7.0
    height_deg: Annotated[float, Field(ge=0.1, le=60)] = 5.0
    view_deg: Degrees = 0.0
    """Used where neither the group nor the session has a view."""
    both_signs: bool = False
    """Whether half of the trials show the view from the other side, as -30 for 30 degrees."""
    size_px: Annotated[int, Field(ge=64, le=2048)] = 512


class Condition(Part):
    """A version of each walker: what it keeps of its own, moved along a trait, transformed."""

    name: Name
    walker: Literal["own", "average"] = "own"
    """Whether each walker is shown, or the average of all in place of each."""
    information: Information = "full"
    trait: TraitName | None = None
    """The trait along which walkers are moved."""
    alpha: Alpha = 0.0
    """Standard deviations that each walker is moved along the trait."""
    toward: Annotated[str, Field(max_length=100)] | None = None
    """The pole of the trait, such as male; left out, the extreme of each walker's own class."""
    transforms: Annotated[list[dict[str, Any]], Field(max_length=20)] = []
    """As in stimulus files: name and parameters; parameters may be left out."""
    duration_s: Seconds | None = None
    """Left out, that of the picture."""
    style: Literal["dots", "sticks", "mannequin"] | None = None
    level: float | None = None
    """The number by which the conditions differ, for the data."""


class Group(Part):
    """Observers who are shown or asked the same; each observer is in one group."""

    name: Name
    observers: Annotated[int, Field(ge=1, le=100_000)]
    view_deg: Degrees | None = None
    scale: Name | None = None
    """The rating scale of this group, whose ends the texts name."""


class Sessions(Part):
    """Sessions of one observer, one for each view; their order is counterbalanced."""

    views_deg: Annotated[list[Degrees], Field(max_length=12)] = []
    least_hours: Annotated[float, Field(ge=0, le=10_000)] = 0.0
    most_hours: Annotated[float, Field(gt=0, le=10_000)] = 720.0

    @model_validator(mode="after")
    def _in_order(self) -> Sessions:
        if self.least_hours >= self.most_hours:
            raise ValueError("least_hours must be below most_hours")
        return self


class Catch(Part):
    """Trials among the others whose right answer is plain to all who look."""

    condition: Name
    right: Annotated[list[Annotated[str, Field(max_length=40)]], Field(min_length=1)]
    """Answers that are right: choices, or steps of the scale as ``"1"``."""
    number: Annotated[int, Field(ge=1, le=200)]


class Block(Part):
    """Trials in one random order."""

    practice: bool = False
    feedback: bool = False
    """Whether each answer is followed by a text that says whether it was right."""
    break_after: bool = True
    break_every: Annotated[int, Field(ge=1, le=2000)] | None = None
    """Trials between breaks within the block."""


class SingleWalkers(Block):
    """Each walker in each condition, one a trial."""

    information: Annotated[list[Information], Field(min_length=1, max_length=3)] = ["full"]
    conditions: Annotated[list[Name], Field(max_length=50)] = []
    """Names of conditions; they replace the information."""
    instances: Annotated[int, Field(ge=1, le=20)] = 1
    trials: NumberOfTrials | None = None
    """Drawn of all walkers, conditions and instances; left out, all of them."""
    catch: Annotated[list[Catch], Field(max_length=20)] = []
    repeats: Repeats = 3
    """How often a stimulus without an answer is shown again before the session pauses."""


class Choice(SingleWalkers):
    """Each walker is put into one of two classes, by a key or a button."""

    task: Literal["choice"]
    choices: Annotated[list[Name], Field(min_length=2, max_length=2)]


class Rating(SingleWalkers):
    """Each walker is rated on a scale with labelled ends."""

    task: Literal["rating"]
    steps: Annotated[int, Field(ge=2, le=11)] = 6
    scale: Name | None = None
    """Left out, that of the group."""


class Figures(Block):
    """Several walkers at once, some of them alike."""

    differ: Literal["walkers", "conditions"] = "walkers"
    """Whether others are other people, or the same person in another condition."""
    information: Annotated[list[Information], Field(min_length=1, max_length=3)] = ["full"]
    conditions: Annotated[list[Name], Field(max_length=50)] = []
    turn_deg: Degrees = 0.0
    """How much further each walker is turned than the one before it."""
    random_start: bool = True
    """Whether each walker begins at a random moment of its stride."""
    trials: NumberOfTrials = 40
    repeats: Repeats = 3


class SameOrDifferent(Figures):
    """Two walkers side by side are the same or different, in halves of the trials."""

    task: Literal["same_different"]
    choices: Annotated[list[Name], Field(min_length=2, max_length=2)] = ["same", "different"]


class OddOneOut(Figures):
    """Of three or four walkers the odd one is chosen."""

    task: Literal["odd_one_out"]
    figures: Literal[3, 4] = 3
    all_differ: bool = False
    """Whether all are different people, so that no answer is right or wrong."""


class Adjustment(Block):
    """A walker is moved along a trait by a slider until it looks as asked."""

    task: Literal["adjustment"]
    trait: TraitName
    walker: Literal["own", "average"] = "average"
    lowest: Alpha = -6.0
    highest: Alpha = 6.0
    steps: Annotated[int, Field(ge=3, le=121)] = 25
    """Places of the slider, at equal distances from the lowest to the highest weight."""
    instances: Annotated[int, Field(ge=1, le=200)] = 10
    """Settings of each walker."""

    @property
    def levels(self) -> list[float]:
        """Weights of the trait at the places of the slider, in standard deviations."""
        width = (self.highest - self.lowest) / (self.steps - 1)
        return [round(self.lowest + place * width, 6) + 0.0 for place in range(self.steps)]

    def condition(self, place: int) -> Condition:
        """Return the walker at a place of the slider."""
        words = ["slider", self.trait[:12], f"{self.lowest:g}", f"{self.highest:g}"]
        if self.walker == "own":
            words.append("own")
        name = re.sub("[^A-Za-z0-9_-]", "-", "_".join([*words, str(self.steps), str(place)]))
        level = self.levels[place]
        return Condition(
            name=name,
            walker=self.walker,
            trait=self.trait,
            alpha=level,
            toward=POSITIVE,
            level=level,
        )


class SimilarPair(Block):
    """Of four walkers in a square the most similar pair is chosen."""

    task: Literal["similar_pair"]
    trials: NumberOfTrials = 63
    limit_s: Seconds = 10.0
    spare_trials: Annotated[int, Field(ge=0, le=500)] = 20
    """Drawn beforehand, to replace trials without an answer."""
    pause_after: Annotated[int, Field(ge=1, le=20)] = 3
    """Trials without an answer, one after the other, after which the session pauses."""


class Detection(Block):
    """A walker is told from its own scrambled dots, among more and more dots, by a staircase."""

    task: Literal["detection"]
    choices: Annotated[list[Name], Field(min_length=2, max_length=2)] = ["present", "absent"]
    mask_dots: Annotated[
        list[Annotated[int, Field(ge=1, le=1000)]], Field(min_length=2, max_length=20)
    ] = [5, 10, 20, 40, 80]
    """Dots of the mask at each level, from the easiest."""
    trials: Annotated[int, Field(ge=2, le=2000)] = 60
    start: Annotated[int, Field(ge=0, le=19)] = 0
    """Place of the first level, from 0."""
    down: Annotated[int, Field(ge=1, le=5)] = 2
    """Right answers in a row after which it becomes harder."""
    repeats: Repeats = 3

    def condition(self, dots: int, present: bool, seed: int) -> Condition:
        """Return a walker in a mask, or its scrambled dots in the same."""
        scramble = [] if present else [{"name": "scramble", "seed": seed}]
        mask = {"name": "mask", "kind": "scrambled", "number": dots, "seed": seed + 1}
        name = f"{'present' if present else 'absent'}_{dots}"
        return Condition(name=name, transforms=[*scramble, mask], level=dots)


AnyBlock = Annotated[
    Choice | Rating | SimilarPair | SameOrDifferent | OddOneOut | Adjustment | Detection,
    Field(discriminator="task"),
]


class Question(Part):
    """A question before or after the trials; the texts have its words."""

    name: Name
    kind: Literal["text", "number", "choice"] = "text"
    options: Annotated[list[Name], Field(max_length=30)] = []
    """Of a choice."""
    least: float | None = None
    most: float | None = None
    """Of a number."""
    required: bool = False
    when: Literal["before", "after"] = "before"
    sessions: Literal["first", "each", "last"] = "each"

    @model_validator(mode="after")
    def _has_options(self) -> Question:
        if (self.kind == "choice") != (len(self.options) > 1):
            raise ValueError("a choice, and nothing else, has two or more options")
        if self.kind != "number" and (self.least is not None or self.most is not None):
            raise ValueError("least and most are for numbers alone")
        if self.least is not None and self.most is not None and self.least >= self.most:
            raise ValueError("least must be below most")
        return self


class Pace(Part):
    """What is between trials, and how long observers may stay away."""

    blank_s: Annotated[float, Field(ge=0, le=60)] = 3.0
    feedback_s: Annotated[float, Field(gt=0, le=60)] = 1.0
    """How long the text after an answer is shown, where a block has feedback."""
    count_remaining: bool = False
    """Whether the number of trials that remain is shown between trials."""
    refresh_after_min: Annotated[float, Field(gt=0, le=10_000)] = 30.0
    """Pause after which instructions are shown again."""
    hold_place_min: Annotated[float, Field(gt=0, le=100_000)] = 120.0
    """Time after which one who left gives the place in the group to the next observer."""


class Screen(Part):
    """What the observer's screen must be, and which trials are flagged."""

    measure: bool = True
    """Whether the size of a pixel is measured by a bank card, and the distance is asked for."""
    full_screen: bool = True
    phones: bool = True
    viewing_distance_mm: Annotated[float, Field(ge=100, le=10_000)] = 570.0
    px_per_cm: Annotated[float, Field(ge=5, le=500)] = 38.0
    """Assumed where the size of a pixel was not measured."""
    flag_dropped_share: Annotated[float, Field(gt=0, le=1)] = 0.05
    """Share of dropped frames above which a trial is flagged."""


class Recruiting(Part):
    """How observers come, and where they go afterwards."""

    parameters: Annotated[list[Name], Field(max_length=10)] = []
    """Parameters of links whose value identifies a person at a recruiting site."""
    keep_raw: bool = False
    completion_code: Annotated[str, Field(max_length=100)] = ""
    return_url: Annotated[str, Field(max_length=500, pattern=r"^(https://.*)?$")] = ""


class Design(Part):
    """An experiment, as the file ``design.toml`` describes it.

    See Also
    --------
    read_design : Reads one from a file.
    """

    format: Literal["eigenwalker experiment"]
    version: Annotated[int, Field(ge=VERSION, le=VERSION)]
    name: Name
    seed: Annotated[int, Field(ge=0, lt=2**32)]
    languages: Annotated[list[Annotated[str, Field(pattern="^[a-z]{2,3}$")]], Field(min_length=1)]
    walkers: Walkers = Walkers()
    picture: Picture = Picture()
    conditions: Annotated[list[Condition], Field(max_length=50)] = []
    groups: Annotated[list[Group], Field(min_length=1, max_length=50)]
    sessions: Sessions = Sessions()
    blocks: Annotated[list[AnyBlock], Field(min_length=1, max_length=50)]
    questions: Annotated[list[Question], Field(max_length=50)] = []
    pace: Pace = Pace()
    screen: Screen = Screen()
    recruiting: Recruiting = Recruiting()

    @property
    def n_sessions(self) -> int:
        """Sessions of one observer."""
        return max(len(self.sessions.views_deg), 1)

    @property
    def places_held(self) -> tuple[float, int, float]:
        """For `active_places`: minutes that a place is held, sessions, hours until the next one."""
        return self.pace.hold_place_min, self.n_sessions, self.sessions.most_hours

    def group(self, name: str) -> Group:
        """Return the group of that name."""
        return next(group for group in self.groups if group.name == name)

    def questions_in(self, session: int) -> list[Question]:
        """Return the questions of a session, which counts from 1."""
        kinds = {"each", *(["first"] if session == 1 else [])}
        kinds |= {"last"} if session == self.n_sessions else set()
        return [question for question in self.questions if question.sessions in kinds]

    def view_deg(self, group: Group, session_view: float | None) -> float:
        """Return the view of a session: its own, that of the group, or that of the picture."""
        views = (session_view, group.view_deg, self.picture.view_deg)
        return next(view for view in views if view is not None)

    @property
    def views_deg(self) -> list[float]:
        """All views that any observer is shown, with both signs where the design has them."""
        sessions = self.sessions.views_deg or [None]
        views = {self.view_deg(group, each) for group in self.groups for each in sessions}
        signs = (1, -1) if self.picture.both_signs else (1,)
        signed = {sign * view for view in views for sign in signs}
        turned = {
            turn(view, place * block.turn_deg)
            for view in signed
            for block in self.blocks
            if isinstance(block, Figures)
            for place in range(n_figures(block))
        }
        return sorted({view + 0.0 for view in signed | turned})

    def shown_in(self, block: AnyBlock) -> list[Condition]:
        """Return the conditions of a block: those it names, or one for each information."""
        if isinstance(block, SimilarPair):
            return [Condition(name="full")]
        if isinstance(block, Adjustment):
            return [block.condition(place) for place in range(block.steps)]
        if isinstance(block, Detection):
            places = [(dots, present) for present in (True, False) for dots in block.mask_dots]
            return [block.condition(*place, self.seed % 2**31) for place in places]
        if block.conditions:
            return [self.condition(name) for name in block.conditions]
        return [Condition(name=each, information=each) for each in block.information]

    def also_shown_in(self, block: AnyBlock) -> list[Condition]:
        """Return the conditions of a block's catch trials."""
        return [self.condition(each.condition) for each in getattr(block, "catch", [])]

    def condition(self, name: str) -> Condition:
        """Return the condition of that name."""
        return next(each for each in self.conditions if each.name == name)

    @property
    def shown(self) -> list[Condition]:
        """All conditions that any block shows, in the order of the blocks."""
        every = [
            each
            for block in self.blocks
            for each in (*self.shown_in(block), *self.also_shown_in(block))
        ]
        return list({each.name: each for each in every}.values())


def n_figures(block: Block) -> int:
    """Return how many walkers a trial shows at once."""
    if isinstance(block, OddOneOut):
        return block.figures
    return 2 if isinstance(block, SameOrDifferent) else 4 if isinstance(block, SimilarPair) else 1


def turn(view_deg: float, by_deg: float) -> float:
    """Return a view turned further, from -180 to 180 where it is turned at all."""
    return view_deg if by_deg == 0 else (view_deg + by_deg + 180) % 360 - 180
