"""The page: data/evaluation/README.md."""

from . import findings, goals, walk_page
from .camera import FOCAL_PX, HEIGHT_PX, WIDTH_PX, px_per_module
from .plots import FIGURES

PAPER_STOPS_M = {"aruco": 5.5, "qr-zxing": 3.5, "stag": 3.0}

COMMAND = "sh apps/eval/run"


def _table(header, rows):
    return ["| " + " | ".join(header) + " |", "|" + " --- |" * len(header),
            *("| " + " | ".join(row) + " |" for row in rows), ""]


def _percent(hits, all_of):
    """Whole percents, but never 100 or 0 where it is not all or none."""
    if all_of == 0:
        return "–"
    share = 100 * hits / all_of
    if hits not in (0, all_of):
        share = min(99, max(1, share))
    return f"{share:.0f}"


def _images(report):
    """Images a step, of the experiment with the fewest."""
    return min((step["systems"]["tapemark"]["frames"] for each in report["experiments"].values()
                for step in each["steps"]), default=0)


def _introduction(report):
    return [
        "# How far, how dark, how steep, how fast", "",
        "Tapemark and four other marker systems before the same camera, one thing at a time made harder. This page,",
        "its plots and `evaluation.json`, which has all counts, were made by", "", "```sh", COMMAND, "```", "",
        f"There are {_images(report)} images a step and kind of marker; seeds are fixed, so that only times change",
        "when it is run again. How it is measured: [apps/eval](../../apps/eval/README.md).", ""]


def _goals(report):
    rows = [(what, others, goal, measured, "–" if measured == "–" else "yes" if met else "**no**")
            for what, others, goal, measured, met in goals.rows(report)]
    return ["## What was to be reached", ""] + _table(("what", "others", "goal", "measured", "met"), rows)


def _values(values):
    return ", ".join(f"{value:g}" for value in values)


def _beaten(report):
    """By experiment and system: where, and how much at most."""
    labels = {each["name"]: each["label"] for each in report["systems"]}
    grouped = {}
    for name, value, system, share, own in findings.beaten(report):
        grouped.setdefault((name, system), []).append((value, share, own))
    lines = ["## Where others are better", ""]
    if not grouped:
        return lines + ["In no step did another system read a larger share of its markers, beyond what chance",
                        "explains.", ""]
    rows = []
    for (name, system), steps in grouped.items():
        experiment = report["experiments"][name]
        worst = max(steps, key=lambda step: step[1] - step[2])
        rows.append((experiment["title"], experiment["axis"], _values(value for value, _, _ in steps), labels[system],
                     f"{100 * worst[1]:.0f} % against {100 * worst[2]:.0f} % (at {worst[0]:g})"))
    lines += ["Steps in which another system read a larger share of its markers than Tapemark of its CMs, with",
              "intervals that do not touch:", ""]
    return lines + _table(("experiment", "axis", "steps", "better", "most"), rows)


def _wrong(report):
    labels = {each["name"]: each["label"] for each in report["systems"]}
    rows = [(labels[system], report["experiments"][name]["title"], f"{value:g}", str(count))
            for system, name, value, count in findings.wrong_readings(report)]
    frames = sum(step["systems"]["tapemark"]["frames"] for each in report["experiments"].values()
                 for step in each["steps"])
    lines = ["## Wrong ids", ""]
    if not rows:
        return lines + [f"None, in {frames} frames with the tape and as many or fewer with each other marker.", ""]
    lines += [f"In {frames} frames with the tape, and as many or fewer with each other marker; where cells are",
              "flipped, another valid code word may be what is printed:", ""]
    return lines + _table(("system", "experiment", "step", "wrong ids"), rows)


def _calibration(report):
    distance = report["experiments"].get("distance")
    lines = ["## The camera", "",
             f"Pictures of {WIDTH_PX} × {HEIGHT_PX} px, a focal length of {FOCAL_PX} px (1.37 widths), a blur of",
             "0.56 px, noise of 0.25 gray levels, paper of 203 and ink of 22 of 255: what was measured on the video",
             f"that the marker's inventors published (`{report['camera']}`). All ink is 6 cm high.",
             f"A module of the tape is {px_per_module(1):.1f} px wide at 1 m, {px_per_module(3):.1f} at 3 m and",
             f"{px_per_module(10):.2f} at 10 m.", ""]
    if distance is None:
        return lines
    labels = {each["name"]: each["label"] for each in report["systems"]}
    rows = []
    for system, paper_m in PAPER_STOPS_M.items():
        points = findings.shares(distance, system)
        nearly_all, half = findings.last(points, 0.8), findings.half_way(points)
        rows.append((labels[system], "–" if nearly_all is None else f"{nearly_all:g} m",
                     "–" if half is None else f"{half:.1f} m", f"{paper_m:g} m"))
    lines += _table(("", "80 % are read to", "half are read to", "the inventors: read to"), rows)
    return lines + [
        "One camera cannot move one of them alone. In the inventors' own videos, STag's black square is four fifths",
        "as high as ArUco's (its generator counts a white border in), which makes 3.75 m of their 3 m; and ZXing-C++",
        "reads their QR codes down to 32 px of height, which is 2.8 m here: they must have used another reader.", ""]


def _systems(report):
    rows = []
    for each in report["systems"]:
        timing = report["timing"]["systems"][each["name"]]
        workspace = ""
        if "workspace_bytes" in each:
            workspace = f", of which {each['workspace_bytes'] / 1024:.0f} KiB workspace"
        rows.append((each["label"], each["version"], f"{timing['median_ms']:.2f}", f"{timing['most_ms']:.2f}",
                     f"{timing['of_aruco']:.2f}", f"{report['memory'][each['name']] / 1024:.1f} MiB{workspace}"))
    return ["## Systems, time and memory", "",
            f"Median and largest processor time of {report['timing']['frames']} frames at 0.75 to 10 m, each the",
            "fastest of three, one thread, all systems in turn; by how much a process grows that reads frames, code",
            "included.", ""] + _table(("system", "version", "ms", "most", "of ArUco's", "memory"), rows)


def _experiment(name, report):
    experiment = report["experiments"][name]
    known = [each for each in report["systems"]
             if any(each["name"] in step["systems"] for step in experiment["steps"])]
    header = [experiment["axis"], "CM", "TM", "something right"]
    header += [each["label"] for each in known if each["name"] != "tapemark"]
    rows = []
    for step in experiment["steps"]:
        own = step["systems"]["tapemark"]
        row = [f"{step['value']:g}", _percent(own["right"], own["markers"]), _percent(own["tms_right"], own["tms"]),
               _percent(own["something"], own["images"])]
        for each in known[1:]:
            numbers = step["systems"].get(each["name"])
            row.append(" " if numbers is None else _percent(numbers["right"], numbers["markers"]))
        rows.append(row)
    where = "" if experiment["distance_m"] is None else f" At {experiment['distance_m']:g} m."
    return [f"### {experiment['title']}", "", f"Percent of the markers wholly in view that were read.{where}", ""
            ] + _table(header, rows)


def _figures(report):
    lines = ["## The experiments", "",
             "Upright lines in the plots are 95 % intervals. A system is left out where it reads next to nothing",
             "even when nothing is wrong, and once it read nothing in two steps in a row.", ""]
    for figure, names in FIGURES.items():
        known = [name for name in names if name in report["experiments"]]
        if known:
            titles = ", ".join(report["experiments"][name]["title"].lower() for name in known)
            lines += [f"![Share of markers read: {titles}]({figure}.png)", ""]
        for name in known:
            lines += _experiment(name, report)
    return lines


def markdown(report):
    """The whole page, of the parts that were measured."""
    labels = {each["name"]: each["label"] for each in report["systems"]}
    lines = [*_introduction(report), *_goals(report), *_beaten(report), *_wrong(report)]
    if "timing" in report and "memory" in report:
        lines += _systems(report)
    lines += [*_calibration(report), *_figures(report)]
    if "walk" in report:
        lines += walk_page.walk_lines(report["walk"], labels)
    if "no-tape" in report:
        lines += walk_page.no_tape_lines(report["no-tape"], labels)
    else:
        lines += ["", "## Frames without a tape", "",
                  "Not measured with this decoder as yet; see the page of apps/eval for what is known to be misread."]
    return "\n".join(lines).rstrip("\n") + "\n"
