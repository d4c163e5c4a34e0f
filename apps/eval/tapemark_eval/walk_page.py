"""The sections about the walk and about frames without a tape, for the page."""

PLACES = {"A": "the inventors' videos, markers on the baseboard", "B": "markers at the camera's height, level",
          "C": "markers on the floor by the wall, looking 30 degrees down"}

READINGS_SHOWN = 30


def _share(hits, all_of):
    return "–" if all_of == 0 else f"{hits} of {all_of}"


def _percents(interval):
    least, most = (0 if share < 1e-9 else 100 * share for share in interval)
    return f"{least:.2g} to {most:.2g} %"


def _walk_rows(systems, labels):
    for name, numbers in systems.items():
        whole = "–", "–"
        if "whole" in numbers:
            whole = (_share(numbers["frames_read_with_whole"], numbers["with_whole"]),
                     _share(numbers["right_of_whole"], numbers["whole"]))
        yield [labels[name], _share(numbers["frames_read"], numbers["frames"]), *whole, str(numbers["right"]),
               str(numbers["wrong"]), f"{numbers['ms']:.2f}", f"{numbers['ms_most']:.2f}"]


def walk_lines(results, labels):
    """Of walk.measure(); `labels` by the systems' names."""
    lines = ["## The walk", "",
             "A hundred frames of a way through two rooms; each system has its own markers in the same places. A",
             "frame counts as read when one id (or TM) is right. A is what the marker's inventors published; B and C",
             "are after their description, with a camera 1.40 m above the floor. Times are medians and largest.", ""]
    for name, condition in results.items():
        lines += [f"### Condition {name}: {PLACES[name]}", "",
                  "| | frames read | of those with a whole marker | whole markers read | ids read | wrong | ms | "
                  "most |", "| --- | --- | --- | --- | --- | --- | --- | --- |"]
        lines += ["| " + " | ".join(row) + " |" for row in _walk_rows(condition["systems"], labels)] + [""]
    if "A" in results:
        lines += ["Which of the other systems' markers are in view is not known in A: there is a truth about the",
                  "tape's video alone. Any id of theirs that the inventors' map has counts as right.", ""]
    return lines


def _kind_row(kind):
    cells = [kind[name] for name in ("kind", "frames", "frames_with_finders", "frames_with_candidates", "cms", "tms")]
    cells += [f"{kind[name]:.2f}" for name in ("decode_ms_mean", "decode_ms_max")]
    return "| " + " | ".join(str(cell) for cell in cells) + " |"


def _readings(frames):
    """What was read, and how to see it: frames are made by kind, number and seed alone."""
    if not frames:
        return []
    lines = ["What was read (`tapemark-clutter --kinds KIND --first FRAME --frames 1 --keep DIR` shows it; kinds of",
             "other systems' markers need `--sheets` too):", "",
             "| kind | frame | read, with confidence |", "| --- | --- | --- |"]
    for frame in frames[:READINGS_SHOWN]:
        read = ", ".join(f"{each['type'].upper()} {each.get('id', each.get('code'))} ({each['confidence']:.2f})"
                         for each in frame["markers"])
        lines.append(f"| {frame['kind']} | {frame['frame']} | {read} |")
    left_out = len(frames) - READINGS_SHOWN
    return lines + ([f"| and {left_out} more | | |"] if left_out > 0 else []) + [""]


def no_tape_lines(results, labels):
    """Of no_tape.measure()."""
    own = results["tapemark"]
    lines = ["## No tape", "",
             "Frames of 640 × 480 px of surfaces, print, other systems' markers, and of lures made to be mistaken",
             "for a tape, seen from random places in random light and blur:", "",
             "| | frames | wrong ids | frames with a wrong id, 95 % interval |", "| --- | --- | --- | --- |",
             f"| {labels['tapemark']} | {own['frames']} | {own['wrong_ids']} | "
             f"{_percents(own['frames_with_wrong_id_95'])} |"]
    for name, numbers in results["peers"].items():
        lines.append(f"| {labels[name]} | {numbers['frames']} | {numbers['wrong_ids']} | "
                     f"{_percents(numbers['frames_with_wrong_id_95'])} |")
    lines += ["", f"Wrong TMs: {own['wrong_tms']}. The others saw fewer frames, and none with their own markers.",
              "What Tapemark looked at (finder patterns, pairs of them tried as a CM) and reported:", "",
              "| kind | frames | with finder patterns | with pairs tried | CMs | TMs | ms, mean | most |",
              "| --- | --- | --- | --- | --- | --- | --- | --- |"]
    return lines + [_kind_row(kind) for kind in own["kinds"]] + [""] + _readings(own["read"])
