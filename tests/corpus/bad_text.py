"""Known-bad files of text formats: cut short, with other things than numbers, with wrong counts."""

from __future__ import annotations

import json

from corpus.bad_file import BadFile, changed, cut, written
from corpus.sound_files import acclaim_files, sound_files

TEXT = {
    "bvh": (r"-?\d+\.\d+(?= .*\n\Z)", "finite number in frame 12"),
    "amc": (r"(?<=lfemur )-?\d+\.\d+(?=.*\n(?:.*\n){1,9}\Z)", "finite number in lfemur in frame"),
    "trc": (r"-?\d+\.\d+(?=\n\Z)", "finite number in line 17"),
    "sto": (r"-?\d+\.\d+(?=\n\Z)", "finite number in line 19"),
    "vicon_csv": (r"-?\d+\.\d+(?=\r\n\Z)", "finite number in line 17"),
    "qualisys_tsv": (r"-?\d+\.\d+(?=\r\n\Z)", "finite number in line 21"),
    "csv": (r"-?\d+\.\d+(?=\n\Z)", "finite number in line 14"),
    "kinect": (r"-?\d+\.\d+(?=\n\Z)", "finite number in line 13"),
    "data3d": (r"-?\d+\.\d+(?=\n\Z)", "finite number in line 36"),
    "described": (r"-?\d+\.\d+(?=\n\Z)", "finite number in line 12"),
}
"""The last number of each format, and what is said of it where it is none."""

CUT = {
    "bvh": "12 frames, as it declares, but got (10|11): the file is cut short",
    "amc": "10 bones in each frame, but got 9 in frame 12: the file is cut short",
    "trc": "12 frames, as it declares, but got 11: the file is cut short",
    "sto": "12 frames, as it declares, but got 11: the file is cut short",
    "qualisys_tsv": "12 frames, as it declares, but got 11: the file is cut short",
    "csv": "12 frames, as it declares, but got 11: the file is cut short",
    "data3d": "three lines a frame, but got 35: the file is cut short",
}
"""What is said of a file that lacks its last line; the others cannot tell that."""

COUNTED = {
    "bvh": (r"Frames: \d+", "Frames: {}"),
    "trc": (r"(?<=^25\t25\t)\d+", "{}"),
    "sto": (r"nRows=\d+", "nRows={}"),
    "qualisys_tsv": (r"(?<=NO_OF_FRAMES\t)\d+", "{}"),
}
"""Where formats count their frames."""


def _within_line(content: bytes, share: float) -> int:
    """Return the middle of the line that lies at a share of the lines."""
    lines = content.splitlines(keepends=True)
    at = int(share * len(lines))
    return sum(map(len, lines[:at])) + len(lines[at].strip()) // 2


def _last_line(content: bytes) -> int:
    return content.rstrip(b"\r\n").rfind(b"\n") + 1


def cut_short() -> list[BadFile]:
    """Return files that end early: within their header, a line, and a number."""
    found = []
    for kind in TEXT:
        within = (
            "cells|numbers|cut short|frames|columns|bones|lines|MOTION|as it is called|a capture|"
            "name|count"
        )
        for share in (0.1, 0.3, 0.5, 0.7, 0.9):
            end = cut(kind, lambda content, share=share: _within_line(content, share))
            found.append(BadFile(f"{kind} cut at {share:.0%}", end, f"expected.*({within})"))
        if kind != "trc":  # whose numbers have as many decimals as they need, each its own
            last = cut(kind, lambda content: len(content.rstrip(b"\r\n")) - 3)
            said = "cut short|decimals|2 in its frame no. 12"
            found.append(BadFile(f"{kind} cut within its last number", last, said))
        if kind in CUT:
            found.append(BadFile(f"{kind} without its last line", cut(kind, _last_line), CUT[kind]))
    for share in (0.2, 0.6, 0.99):
        end = cut("pose_json", lambda content, share=share: int(share * len(content)))
        found.append(BadFile(f"JSON cut at {share:.0%}", end, "expected JSON, but got"))
    return found


def no_numbers() -> list[BadFile]:
    """Return files with something else where a number should be."""
    words = {"text": "abc", "infinity": "inf", "minus infinity": "-Infinity", "1e308": "1e308"}
    words |= {"a hexadecimal number": "0x1F", "an Arabic digit": "٣", "two points": "1.2.3"}
    found = [
        BadFile(f"{kind} with {what} for a number", changed(kind, pattern, word), said)
        for kind, (pattern, said) in TEXT.items()
        for what, word in words.items()
        if "infinity" not in what or kind in ("bvh", "amc")  # tables write inf for a gap
    ]
    for what, word in {"text": '"abc"', "infinity": "Infinity", "1e308": "1e308"}.items():
        make = changed("pose_json", r"-?\d\.\d+(?=\]\]\}\]\Z)", word)
        found.append(BadFile(f"JSON with {what} for a number", make, "finite number for each of x"))
    return found


def wrong_counts() -> list[BadFile]:
    """Return files that declare other frames than they hold, or none."""
    found = []
    for kind, (pattern, put) in COUNTED.items():
        for count in ("0", "-1", "13", "11", "999999999", "1e9", "twelve"):
            said = "expected .*(frames|count|[Ff]rames:|nrows)"
            make = changed(kind, pattern, put.format(count))
            found.append(BadFile(f"{kind} that declares {count} frames", make, said))
    return found


def wrong_rates() -> list[BadFile]:
    """Return files with frame rates that no camera has."""
    places = {
        "trc": r"^25(?=\t25)",
        "vicon_csv": r"(?<=^Trajectories\r\n)25",
        "qualisys_tsv": r"(?<=FREQUENCY\t)25",
        "amc": r"(?<=SAMPLES-PER-SECOND )25",
    }
    rates = ("0", "-25", "1e9", "nan", "fast")
    found = [
        BadFile(f"{kind} at {rate} Hz", changed(kind, pattern, rate), "frames a second between")
        for kind, pattern in places.items()
        for rate in rates
    ]
    found += [
        BadFile(f"BVH with the frame time {step}", changed("bvh", r"(?<=Time: )\S+", step), said)
        for step, said in {
            "0": "a frame time above 0",
            "-0.04": "a frame time above 0",
            "nan": "finite number in the frame time",
            "1e-9": "frames a second between",
        }.items()
    ]
    for rate in ("0", "-1", "1e9", "nan"):
        make = changed("described", "rate_hz = 25", f"rate_hz = {rate}", beside=True)
        found.append(BadFile(f"description of {rate} Hz", make, "frames a second between"))
    for rate in ("0", "1e9", '"fast"'):
        make = changed("pose_json", r'"rate_hz": 25', f'"rate_hz": {rate}', variant=1)
        found.append(BadFile(f"JSON at {rate} Hz", make, "frames a second between"))
    make = changed("csv", r"^0\.08,", "0.03,")
    found.append(BadFile("table whose times go back", make, "times that go on"))
    make = changed("trc", r"^3\t0\.08", "3\t0.8")
    found.append(BadFile("TRC whose times go back", make, "times that go on"))
    return found


def wrong_grammar() -> list[BadFile]:
    """Return files against the rules of their formats."""
    motion = acclaim_files()
    amc, asf = motion.values()
    lonely = {"07_01.amc": amc}
    strangers = {"07_01.amc": amc, "a.asf": asf, "b.asf": asf}
    deep = b"HIERARCHY\nROOT a {\n" + b"JOINT b {\n" * 3000 + b"MOTION\n"
    two_people = json.dumps([{"people": [{"pose_keypoints_3d": [0, 0, 0, 1] * 25}] * 2}] * 3)
    flat = json.dumps([{"people": [{"pose_keypoints_2d": [0, 0, 1] * 25}]}] * 3)
    columns = "\t".join(f"c{i}_x\tc{i}_y" for i in range(20))
    return [
        BadFile("BVH without its motion", changed("bvh", "^MOTION", ""), "a line MOTION"),
        BadFile("BVH with an open brace", changed("bvh", "}", ""), r"without their }"),
        BadFile("BVH with seven channels", changed("bvh", "CHANNELS 6", "CHANNELS 7"), "CHANNELS"),
        BadFile("BVH with an unknown channel", changed("bvh", "Zrotation", "Wrotation"), "Xpos"),
        BadFile("BVH with a channel twice", changed("bvh", "Zrotation", "Xrotation"), "each once"),
        BadFile("BVH of 3000 joints", written({"a.bvh": deep}), "more than 2000 joints"),
        BadFile("BVH with a strange word", changed("bvh", "OFFSET", "SCALE"), "but got 'SCALE'"),
        BadFile("AMC without a skeleton", written(lonely), r"\(\.asf\) beside .*got none; copy"),
        BadFile("AMC with two skeletons", written(strangers), "2 of other names; name its"),
        BadFile("skeleton alone", written({"a.asf": asf}), "name the motion"),
        BadFile(
            "AMC of a strange bone", changed("amc", "lfemur", "wing"), "which it lacks|once in"
        ),
        BadFile("AMC that skips a frame", changed("amc", "^3$", "4"), "frame 3 after 2"),
        BadFile("AMC with an angle too many", changed("amc", "^ltibia .*", "ltibia 1 2"), "ltibia"),
        *(
            BadFile(f"ASF {what}", changed("amc", old, new, beside=True), said)
            for what, old, new, said in (
                ("without a hierarchy", ":hierarchy", ":family", ":hierarchy in the skeleton"),
                ("without bones", ":bonedata", ":bones", ":bonedata in the skeleton"),
                ("with a bone of two parents", "thorax head", "thorax head lfoot", "one parent"),
                ("with a loop", "thorax head", "head head", "each bone in the hierarchy"),
                ("with an unknown bone", "thorax head", "thorax hat", "bones of the section"),
                ("with a negative length", "length 7", "length -7", "above 0"),
                ("with a length in words", "length 7", "length long", "finite number in the leng"),
                ("with a bone twice", "name rfemur", "name lfemur", "'lfemur' twice"),
                ("with a strange axis", "axis 0 0 30 XYZ", "axis 0 0 30 XXZ", "order of axes"),
                ("with a direction of 9", "direction 0 -1 0", "direction 0 -9 0", "of length 1"),
                ("cut within a block", r"  end\n:hierarchy", ":hierarchy", "with an end"),
            )
        ),
        BadFile("TRC with a marker too many", changed("trc", r"\t15\tmm", "\t16\tmm"), "50 cells"),
        BadFile("TRC without counts", changed("trc", "NumFrames", "Frames"), "'numframes'"),
        BadFile(
            "TRC with a cell too few", changed("trc", r"^2\t0\.04\t\S+", "2\t0.04"), "47 cells"
        ),
        BadFile("TRC with a text as table", changed("trc", "^Frame#", "Bild#"), "line Frame#"),
        BadFile(
            "STO of angles",
            changed("sto", r"_t[xyz](.|\n)*", "\tknee_angle\tankle_angle\n0\t1\t2\n"),
            "nrows|positions of several points",
        ),
        BadFile("Qualisys TSV of 6D data", changed("qualisys_tsv", r"\b3D", "6D"), "3D data"),
        BadFile(
            "Qualisys TSV with too few names",
            changed("qualisys_tsv", r"^MARKER_NAMES\thead", "MARKER_NAMES"),
            "names of 15 markers",
        ),
        BadFile(
            "Vicon CSV of angles only",
            written(lambda: {"a.csv": _first("vicon_csv").replace(b",mm", b",deg")}),
            "Trajectories in lengths",
        ),
        BadFile(
            "Vicon CSV with two units", changed("vicon_csv", "^,,mm,mm,mm", ",,m,m,m"), "one unit"
        ),
        BadFile(
            "table in two dimensions",
            written({"a.csv": f"{columns}\n".encode() + b"\t".join([b"1"] * 40) + b"\n"}),
            "in two dimensions; export the 3D",
        ),
        BadFile(
            "table without times",
            written(
                {"a.csv": b"a_x,a_y,a_z,b_x,b_y,b_z,c_x,c_y,c_z\n" + b"1,2,3,4,5,6,7,8,9\n" * 5}
            ),
            "a column time_s",
        ),
        BadFile(
            "numbers without a description",
            written({"a.txt": b"1.0 2.0 3.0 4.0\n" * 20}),
            "a description beside the file",
        ),
        BadFile("JSON of two people", written({"a.json": two_people.encode()}), "one person"),
        BadFile("JSON in two dimensions", written({"a.json": flat.encode()}), "points in space"),
        BadFile("JSON of nothing", written({"a.json": b"{}"}), "a list of frames"),
        BadFile("JSON, 100000 deep", written({"a.json": b"[" * 100_000}), "expected JSON"),
        BadFile(
            "JSON with other points later",
            changed("pose_json", r'"head"(?!.*"head")', '"hat"', variant=1),
            "the same points in each frame",
        ),
        *(
            BadFile(f"description {what}", changed("described", old, new, beside=True), said)
            for what, old, new, said in (
                ("that is no TOML", "rate_hz", "= =", "a description in TOML"),
                ("that names another file", "rate_hz", 'file = "../../secret"\nrate_hz', "some of"),
                ("with text for a number", "rate_hz = 25", 'rate_hz = "25"', "rate_hz as float"),
                ("of an unknown unit", '"mm"', '"furlong"', "a unit of"),
                ("with two axes alike", 'up = "z"', 'up = "x"', "three different axes"),
                ("of a strange axis", 'up = "z"', 'up = "w"', "up as x, -x"),
                ("with a name too many", r"\[", '["hat", ', "48 columns"),
                ("of no rate", "rate_hz = 25", "", "rate_hz or time_column, but got neither"),
                ("100000 deep", "rate_hz = 25", "rate_hz = " + "[" * 100_000, "in TOML"),
                ("of an infinite unit", 'unit = "mm"', "unit_mm = inf", "unit_mm"),
                ("with lines that are not there", "rate_hz", "header_lines = 99\nrate_hz", "leave"),
            )
        ),
    ]


def _first(kind: str) -> bytes:
    return next(iter(sound_files(kind)[0].values()))
