"""The plots of the page: shares of markers read; upright lines are their 95 % intervals."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # pylint: disable=wrong-import-position

LOOKS = {
    "tapemark": ("#c1121f", "o", "-"), "aruco": ("#1d4e89", "s", "-"), "qr-opencv": ("#b08900", "v", ":"),
    "qr-zxing": ("#b08900", "^", "-"), "stag": ("#2a7f3f", "D", "-"), "apriltag-1": ("#7b2d8b", "P", "-"),
    "apriltag-2": ("#7b2d8b", "x", ":"),
}

FIGURES = {
    "distance": ("distance",),
    "angle": ("yaw-3m", "yaw-1.5m", "pitch-3m", "pitch-1.5m"),
    "light": ("exposure", "gradient", "shadow"),
    "blur": ("motion-along", "motion-across", "defocus"),
    "roll-and-occlusion": ("roll", "occlusion"),
    "damage": ("cells", "dirt", "tears"),
}
LOGARITHMIC = ("exposure",)


def _series(experiment, name, hits, all_of, interval):
    """Values, shares and bounds of a system, where it was measured."""
    rows = [(step["value"], step["systems"][name]) for step in experiment["steps"]
            if step["systems"].get(name, {}).get(all_of, 0) > 0]
    values = [value for value, _ in rows]
    shares = [100 * numbers[hits] / numbers[all_of] for _, numbers in rows]
    low = [100 * numbers[interval][0] for _, numbers in rows]
    high = [100 * numbers[interval][1] for _, numbers in rows]
    return values, shares, low, high


def _draw(axes, name, label, series, dashed=False):
    values, shares, low, high = series
    if not values:
        return
    colour, mark, line = LOOKS[name]
    bold = name == "tapemark"
    axes.plot(values, shares, color=colour, marker=mark, markersize=5 if bold else 4, linewidth=2 if bold else 1.2,
              linestyle="--" if dashed else line, label=label, zorder=3 if bold else 2,
              markerfacecolor="white" if dashed else colour)
    axes.vlines(values, low, high, color=colour, alpha=0.45, linewidth=2 if bold else 1.2, zorder=1)


def _panel(axes, name, experiment, systems):
    for system in systems:
        _draw(axes, system["name"], system["label"] + (" CM" if system["marker"] == "tape" else ""),
              _series(experiment, system["name"], "right", "markers", "each_95"))
    tm = _series(experiment, "tapemark", "tms_right", "tms", "tms_95")
    _draw(axes, "tapemark", "Tapemark TM", tm, dashed=True)
    if name in LOGARITHMIC:
        axes.set_xscale("log")
    axes.set_ylim(-3, 103)
    axes.set_title(experiment["title"], fontsize=10)
    axes.set_xlabel(experiment["axis"], fontsize=9)
    axes.tick_params(labelsize=8)
    axes.grid(color="#dddddd", linewidth=0.6)
    if experiment["twin_axis"] is not None:
        ratio = next(step["twin"] / step["value"] for step in experiment["steps"] if step["value"])
        twin = axes.secondary_xaxis("top", functions=(lambda x: x * ratio, lambda x: x / ratio))
        twin.tick_params(labelsize=7)
        twin.set_xlabel(experiment["twin_axis"], fontsize=8)


def draw_all(report, output):
    """Writes a picture a figure; returns their names."""
    names = []
    for figure_name, experiment_names in FIGURES.items():
        known = [each for each in experiment_names if each in report["experiments"]]
        if not known:
            continue
        columns = min(2, len(known)) if len(known) != 3 else 3
        rows = -(-len(known) // columns)
        width = {1: 8.5, 2: 10, 3: 12}[columns]
        figure, grid = plt.subplots(rows, columns, figsize=(width, 3.9 * rows + 0.6), squeeze=False, sharey=True)
        for axes, name in zip(grid.ravel(), known):
            _panel(axes, name, report["experiments"][name], report["systems"])
        for row in grid:
            row[0].set_ylabel("markers read, %", fontsize=9)
        handles, labels = _legend_of(grid)
        figure.legend(handles, labels, loc="lower center", ncols=4, fontsize=8, frameon=False)
        figure.tight_layout(rect=(0, 0.09 if rows == 1 else 0.05, 1, 1))
        name = f"{figure_name}.png"
        figure.savefig(output / name, dpi=90, pil_kwargs={"optimize": True})
        plt.close(figure)
        names.append(name)
    return names


def _legend_of(grid):
    """Each system once, whichever panel it is in."""
    known = {}
    for axes in grid.ravel():
        for handle, label in zip(*axes.get_legend_handles_labels()):
            known.setdefault(label, handle)
    return list(known.values()), list(known)
