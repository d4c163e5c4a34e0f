"""Time a frame: all systems over the same places, interleaved, so that a busy machine is busy for all."""

import statistics

from . import experiments
from .measure import gray_of

ROUNDS = 3
DISTANCES_M = (0.75, 1, 1.5, 2, 3, 4, 5, 6, 8, 10)


def measure(bench, images):
    """Per system the fastest of three rounds of each frame, in milliseconds of processor time."""
    experiment = experiments.find("distance")
    fastest = {reader.name: [] for reader in bench.readers}
    for distance_m in DISTANCES_M:
        for image in range(images):
            grays = {marker: gray_of(bench.frame(experiment, distance_m, image, marker)) for marker in bench.markers}
            times = [{reader.name: reader.read(grays[reader.marker]).cpu_ms for reader in bench.readers}
                     for _ in range(ROUNDS)]
            for name, all_ms in fastest.items():
                all_ms.append(min(each[name] for each in times))
    return {"frames": len(DISTANCES_M) * images, "systems": {name: _numbers(all_ms, fastest["aruco"])
                                                            for name, all_ms in fastest.items()}}


def _numbers(all_ms, aruco_ms):
    ratios = [own / other for own, other in zip(all_ms, aruco_ms)]
    return {"median_ms": round(statistics.median(all_ms), 3), "most_ms": round(max(all_ms), 3),
            "of_aruco": round(statistics.median(ratios), 4)}
