"""What is to be reached, and what is: a row each, (what, others, goal, measured, met)."""

from . import findings


class _Measured:
    """Looks numbers up in the report; experiments that were left out give None."""

    def __init__(self, report):
        self._experiments = report["experiments"]
        self._report = report

    def points(self, experiment, system="tapemark", hits="right", all_of="markers"):
        if experiment not in self._experiments:
            return []
        return findings.shares(self._experiments[experiment], system, hits, all_of)

    def share(self, experiment, value, hits="right", all_of="markers"):
        return dict(self.points(experiment, "tapemark", hits, all_of)).get(value)

    def least(self, experiment, up_to, hits, all_of):
        """The smallest share of the steps up to a value."""
        return min((share for value, share in self.points(experiment, "tapemark", hits, all_of) if value <= up_to),
                   default=None)

    def wrong_ids(self, experiments):
        """Of all steps; None where one of them was left out."""
        if any(name not in self._experiments for name in experiments):
            return None
        return sum(step["systems"]["tapemark"]["wrong"]
                   for name in experiments for step in self._experiments[name]["steps"])

    def ratio(self):
        known = [findings.slowest_ratio(self._report, name) for name in self._experiments]
        return max((each for each in known if each is not None), default=None)


def _percent(share):
    return "–" if share is None else f"{100 * share:.0f} %"


def _reach_row(what, others, goal_value, unit, points, least):
    reached = findings.reach(points, least)
    text = "–" if reached is None else f"{reached:g} {unit}"
    return (what, others, f"{goal_value:g} {unit}", text, reached is not None and reached >= goal_value)


def _share_row(what, others, least, share):
    goal = "all" if least == 1 else f"≥ {100 * least:.0f} %"
    return (what, others, goal, _percent(share), share is not None and share >= least)


def _light_row(numbers):
    own = findings.span(numbers.points("exposure"), 0.9)
    stag = findings.span(numbers.points("exposure", "stag"), 0.9)
    text = "–" if own is None else f"{own[0]:g} to {own[1]:g}"
    others = "STag: –" if stag is None else f"STag: {stag[0]:g} to {stag[1]:g}"
    wider = own is not None and (stag is None or (own[0] <= stag[0] and own[1] >= stag[1] and own != stag))
    return ("exposures read (≥ 90 %)", others, "wider than STag", text, wider)


def _wrong_row(what, others, wrong):
    return (what, others, "0", "–" if wrong is None else str(wrong), wrong == 0)


def _tape_free_row(report):
    tape_free = report.get("no-tape", {}).get("tapemark")
    if tape_free is None:
        return _wrong_row("wrong ids in 100 000 frames without a tape", "–", None)
    peers = report["no-tape"]["peers"].items()
    others = "; ".join(f"{name}: {each['wrong_ids']} in {each['frames']}" for name, each in peers)
    return _wrong_row(f"wrong ids in {tape_free['frames']} frames without a tape", others, tape_free["wrong_ids"])


def _time_row(numbers):
    ratio = numbers.ratio()
    text = "–" if ratio is None else f"1/{1 / ratio:.1f}"
    return ("time a frame, of ArUco's; slowest step", "1", "1/10", text, ratio is not None and ratio <= 0.1)


def rows(report):
    numbers = _Measured(report)
    aruco_m = findings.last(numbers.points("distance", "aruco"), 0.95)
    aruco_yaw = findings.last(numbers.points("yaw-3m", "aruco"), 0.9)
    return [
        _reach_row("distance to which ≥ 95 % of CMs are read",
                   f"ArUco: {aruco_m or '–'} m", 9, "m", numbers.points("distance"), 0.95),
        _reach_row("distance to which ≥ 95 % of TMs are read", "the paper: with gaps to 10 m", 12, "m",
                   numbers.points("distance", hits="tms_right", all_of="tms"), 0.95),
        _share_row("TMs read at 18 m", "–", 0.5, numbers.share("distance", 18, "tms_right", "tms")),
        _share_row("images with something right, 0.5 to 12 m", "the paper: at varying rates to 10 m", 1,
                   numbers.least("distance", 12, "something", "images")),
        _reach_row("yaw at 3 m to which ≥ 90 % of CMs are read", f"the paper: 40°; ArUco: {aruco_yaw or '–'}°", 75,
                   "°", numbers.points("yaw-3m"), 0.9),
        _light_row(numbers),
        _share_row("motion of 1.7 modules along: CMs read", "the paper: not robust", 0.9,
                   numbers.share("motion-along", 1.7)),
        _share_row("motion of 1.7 modules across: CMs read", "the paper: not robust", 0.9,
                   numbers.share("motion-across", 1.7)),
        _share_row("defocus of 0.5 modules: CMs read", "–", 0.9, numbers.share("defocus", 0.5)),
        _share_row("images with an id where a whole CM is left, 0 to 80 % hidden", "–", 1,
                   numbers.least("occlusion", 0.8, "id", "images")),
        _wrong_row("cells flipped, dirt, tears, to 30 %: wrong ids", "–",
                   numbers.wrong_ids(("cells", "dirt", "tears"))),
        _tape_free_row(report),
        _time_row(numbers),
    ]
