"""Draws what stream_soak logged: memory, descriptors, the age of frames and what became of them, over the frames.

Usage: soak_plot.py LOG.csv PICTURE.png (needs matplotlib)
"""
import csv
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def read_columns(path):
    """The log's columns by their names, as numbers."""
    with open(path, newline="", encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    if not rows:
        sys.exit(f"soak_plot.py: {path}: holds no measurements")
    return {name: [float(row[name]) for row in rows] for name in rows[0]}


def draw(log, path):
    """Four panels above one another, all over the frames that went by."""
    frames = [count / 1000 for count in log["frames"]]
    figure, panels = plt.subplots(4, 1, figsize=(8, 9), sharex=True, layout="constrained")
    panels[0].plot(frames, [kib / 1024 for kib in log["memory_kib"]], color="tab:blue")
    panels[0].set_ylabel("memory, MiB")
    panels[1].plot(frames, log["descriptors"], color="tab:blue")
    panels[1].set_ylabel("open descriptors")
    panels[2].plot(frames, log["age_p50_ms"], color="tab:blue", label="median")
    panels[2].plot(frames, log["age_p99_ms"], color="tab:orange", label="99th percentile")
    panels[2].set_ylabel("age of frames, ms")
    panels[2].set_yscale("log")
    panels[2].legend(loc="upper right")
    for name, label in (("sent", "sent"), ("dropped", "dropped, as told"), ("spoiled", "spoiled by injected harm"),
                        ("unexplained", "unexplained"), ("wrong", "wrong records")):
        panels[3].plot(frames, [count / 1000 for count in log[name]], label=label)
    panels[3].set_ylabel("thousand, so far")
    panels[3].set_xlabel("thousand frames")
    panels[3].legend(loc="upper left")
    for panel, name, scale in ((panels[0], "memory_kib", 1024), (panels[1], "descriptors", 1)):
        panel.set_ylim(0, 1.3 * max(log[name]) / scale)
    for panel in panels:
        panel.grid(alpha=0.3)
    figure.savefig(path, dpi=90)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit("usage: soak_plot.py LOG.csv PICTURE.png")
    draw(read_columns(sys.argv[1]), sys.argv[2])
