"""What the numbers say: how far each system reads, where others are better, where goals are met."""


def shares(experiment, system, hits="right", all_of="markers"):
    """(value, share) of each step in which the system had something to read."""
    return [(step["value"], step["systems"][system][hits] / step["systems"][system][all_of])
            for step in experiment["steps"] if step["systems"].get(system, {}).get(all_of, 0) > 0]


def reach(points, least):
    """The last value up to which every step has this share at least; None where the first has not."""
    last = None
    for value, share in points:
        if share < least:
            break
        last = value
    return last


def last(points, least):
    """The last value at which the share is this at least, gaps or not; None where there is none."""
    return max((value for value, share in points if share >= least), default=None)


def half_way(points):
    """Where the share falls through one half, by straight lines between the steps; None where it does not."""
    for (value, share), (next_value, next_share) in zip(points, points[1:]):
        if share >= 0.5 > next_share:
            return value + (share - 0.5) / (share - next_share) * (next_value - value)
    return None


def span(points, least):
    """First and last value of the longest run of steps with this share at least; None without any."""
    best, run = [], []
    for value, share in points:
        run = run + [value] if share >= least else []
        best = max(best, run, key=len)
    return (best[0], best[-1]) if best else None


def beaten(report):
    """Steps in which another system read more, beyond what chance explains: its interval lies above ours. A list of
    (experiment, value, system, its share, our share)."""
    found = []
    for name, experiment in report["experiments"].items():
        for step in experiment["steps"]:
            own = step["systems"]["tapemark"]
            for system, numbers in step["systems"].items():
                if own["markers"] > 0 and numbers["markers"] > 0 and numbers["each_95"][0] > own["each_95"][1]:
                    found.append((name, step["value"], system, numbers["right"] / numbers["markers"],
                                  own["right"] / own["markers"]))
    return found


def wrong_readings(report):
    """(system, experiment, value, count) of all wrong ids."""
    return [(system, name, step["value"], numbers["wrong"]) for name, experiment in report["experiments"].items()
            for step in experiment["steps"] for system, numbers in step["systems"].items() if numbers["wrong"]]


def slowest_ratio(report, experiment_name):
    """The largest ratio of median times, ours to ArUco's, of an experiment's steps."""
    ratios = [step["systems"]["tapemark"]["ms"] / step["systems"]["aruco"]["ms"]
              for step in report["experiments"][experiment_name]["steps"] if "aruco" in step["systems"]]
    return max(ratios, default=None)
