"""The columns of the export: what each means, in which unit, with which values, from where."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Column:
    """A column of the table of trials."""

    name: str
    meaning: str
    unit: str = ""
    values: str = ""
    source: str = "design"


COLUMNS = (
    Column("observer", "number of the observer", values="integer from 1", source="server"),
    Column("session", "session of this observer", values="integer from 1", source="server"),
    Column("group", "group of the observer", values="names of groups in the design"),
    Column("block", "block of trials", values="integer from 1"),
    Column("trial", "trial of the session, in the order drawn", values="integer from 1"),
    Column(
        "attempt",
        "which showing of this trial, by the time it began",
        values="integer from 1",
        source="computed at export",
    ),
    Column("stimulus", "names of stimulus files, separated by blanks", values="materials/"),
    Column("view_deg", "azimuth of the view, 0 is the front, sign as shown", "degree", "number"),
    Column("information", "what the walker keeps of its own", values="full, structure, dynamics"),
    Column("condition", "name of the condition, that of the information where there are none"),
    Column("level", "number by which the conditions differ", "as in the design", "number; empty"),
    Column("walker", "name of the walker, where one is shown", values="names of the population"),
    Column(
        "response",
        "the answer: a class, a step of the scale from 1, one or two places from 0, or a setting",
        values="text; empty without an answer",
        source="page",
    ),
    Column("response_by", "by what it was given", values="key, button; empty", source="page"),
    Column(
        "response_device",
        "what the answer was given with",
        values="keyboard, mouse, touch, pen; empty",
        source="page",
    ),
    Column(
        "rt_ms",
        "time from the first frame to the answer",
        "millisecond",
        "number; empty without an answer",
        "page",
    ),
    Column(
        "outcome",
        "what became of the showing",
        values="answered, none (no answer), timeout, interrupted",
        source="page; interrupted: computed at export",
    ),
    Column("repeated", "whether it was shown before without an answer", values="0, 1"),
    Column("interrupted", "whether the showing was broken off", values="0, 1"),
    Column("practice", "whether the block is practice", values="0, 1"),
    Column("test", "whether the answers are a test (preview)", values="0, 1", source="server"),
    Column("simulated", "whether a simulated observer answered", values="0, 1", source="server"),
    Column(
        "session_outcome",
        "how the session ended",
        values="finished, stopped (answers kept), left",
        source="server",
    ),
    Column(
        "flag",
        "what may have disturbed the showing, separated by blanks",
        values="hidden, unfocused, resized, dropped_frames, none",
        source="page; rules in the design",
    ),
    Column(
        "first_frame_ms",
        "time from the beginning of the trial to the first frame",
        "millisecond",
        "number; empty where unknown",
        "page",
    ),
    Column("frames_shown", "frames that showed the stimulus", "", "integer", "page"),
    Column("frames_planned", "frames that its duration is", "", "integer; empty", "page"),
    Column("frames_dropped", "frames of the screen without a new picture", "", "integer", "page"),
    Column("frame_interval_ms", "median time from frame to frame", "millisecond", "number", "page"),
    Column("frame_interval_min_ms", "shortest of these times", "millisecond", "number", "page"),
    Column("frame_interval_max_ms", "longest of these times", "millisecond", "number", "page"),
    Column(
        "shown_ms",
        "time from the first frame to the first without the stimulus",
        "millisecond",
        "number",
        "page",
    ),
    Column("page_hidden", "how often the page was hidden meanwhile", "", "integer", "page"),
    Column("focus_lost", "how often the window lost the focus meanwhile", "", "integer", "page"),
    Column("started_utc", "when the showing began", "", "ISO 8601, UTC", "page, its clock"),
    Column("answer", "name of the answer, as in the table of frames", "", "text", "page"),
)
QUESTIONS = (
    Column("observer", "number of the observer", "", "integer from 1", "server"),
    Column("session", "session of this observer", "", "integer from 1", "server"),
    Column("question", "name of the question", "", "names of questions in the design"),
    Column("question_answer", "what the observer answered", "", "text", "page"),
)
RATING = (
    Column("rating", "the step of the scale, from 1 at its first end", "", "integer", "page"),
)
RIGHT = (
    Column(
        "right_answer",
        "the right answer, where there is one; several of a catch trial, separated by blanks",
        values="as in response; empty",
    ),
    Column(
        "correct",
        "whether the response is right",
        values="0, 1; empty without a response or a right answer",
        source="computed at export",
    ),
    Column("catch", "whether it is a catch trial, whose right answer is plain", values="0, 1"),
)
FIGURES = tuple(
    Column(name, "walker in that place, from the left, above before below", "", "names")
    for name in "abcd"
)
PAIRS = (
    Column("chosen_1", "one walker of the chosen pair", "", "names; empty", "page"),
    Column("chosen_2", "the other walker of the chosen pair", "", "names; empty", "page"),
)
ODD = (Column("odd", "the walker that was chosen as the odd one", "", "names; empty", "page"),)
SETTINGS = (
    Column(
        "setting",
        "weight of the trait that the observer set; 0 is the walker as it is",
        "standard deviation of the walkers",
        "number; empty",
        "page",
    ),
    Column(
        "setting_start",
        "weight at which the slider began",
        "standard deviation of the walkers",
        "number; empty",
    ),
)
_WHO = tuple(
    column
    for column in COLUMNS
    if column.name in ("observer", "session", "group", "test", "simulated", "session_outcome")
)
SESSIONS = (
    *_WHO,
    Column("language", "language of the texts", "", "two or three letters", "page"),
    Column("version", "hash of design, texts and stimuli", "", "materials/", "server"),
    Column("consent_hash", "hash of the text that was agreed to", "", "SHA-256", "server"),
    Column("started_utc", "when the observer agreed", "", "ISO 8601, UTC", "server"),
    Column("ended_utc", "when the session ended", "", "ISO 8601, UTC; empty", "server"),
    Column("n_items", "answers and other reports that are kept", "", "integer", "server"),
    Column("n_refused", "answers that were refused for good", "", "integer", "server"),
)
SCREENS = (
    *_WHO[:2],
    Column("time_utc", "when the screen was measured", "", "ISO 8601, UTC", "page, its clock"),
    Column("width_px", "width of the screen", "CSS pixel", "integer", "page"),
    Column("height_px", "height of the screen", "CSS pixel", "integer", "page"),
    Column("window_px", "width and height of the window", "CSS pixel", "list of two", "page"),
    Column("pixel_ratio", "pixels of the device in one CSS pixel", "", "number", "page"),
    Column("refresh_hz", "refresh rate of the screen", "hertz", "number", "page"),
    Column("clock_isolated", "whether clocks are fine (5 microseconds)", "", "0, 1", "page"),
    Column("touch", "whether the screen is touched", "", "0, 1", "page"),
    Column("px_per_cm", "size of a CSS pixel", "CSS pixel per centimetre", "number", "page"),
    Column(
        "px_per_cm_step", "within which it was set", "CSS pixel per centimetre", "number", "page"
    ),
    Column("size_method", "how it is known", "", "card, assumed", "page"),
    Column("size_device", "what it was set with", "", "keyboard, mouse, touch, pen; empty", "page"),
    Column(
        "viewing_distance_mm",
        "distance of the eyes from the screen; known to some 10 %, not better",
        "millimetre",
        "number",
        "page",
    ),
    Column("distance_method", "how it is known", "", "told, blind_spot, assumed", "page"),
    Column("distance_sd_mm", "standard deviation over settings", "millimetre", "number", "page"),
    Column("distance_settings_mm", "the distance by each setting", "millimetre", "list", "page"),
    Column("stored", "whether the page could store answers", "", "0, 1", "page"),
    Column("browser", "what the browser calls itself", "", "text", "page"),
)
FRAMES = (
    Column("answer", "name of the answer, as in the table of trials", "", "text", "page"),
    Column("frame_times_ms", "time from the first frame to each", "millisecond", "list", "page"),
)
