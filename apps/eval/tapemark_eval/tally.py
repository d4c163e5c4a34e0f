"""Counts of many frames: one system in one step of an experiment."""

import statistics

from . import intervals


def _rounded(interval):
    return [round(bound, 4) for bound in interval]


class Tally:
    def __init__(self):
        self.verdicts = []
        self.cpu_ms = []

    def add(self, verdict, cpu_ms):
        self.verdicts.append(verdict)
        self.cpu_ms.append(cpu_ms)

    def _sum(self, name):
        return sum(int(getattr(each, name)) for each in self.verdicts)

    def numbers(self, marker):
        """What is written down. Images count where at least one marker is wholly in view (for occlusion, where one is
        left); `each` is the share of markers wholly in view that were read."""
        seen = [each for each in self.verdicts if each.whole > 0]
        images = len(seen)
        counts = [(each.right, each.whole) for each in self.verdicts]
        markers, right = self._sum("whole"), self._sum("right")
        something = sum(each.something for each in seen)
        numbers = {
            "frames": len(self.verdicts), "images": images, "something": something,
            "something_95": _rounded(intervals.wilson(something, images)),
            "markers": markers, "right": right, "each_95": _rounded(intervals.clustered(counts)),
            "wrong": self._sum("wrong") + self._sum("tm_wrong"),
            "ms": round(statistics.median(self.cpu_ms), 3), "ms_most": round(max(self.cpu_ms), 3)}
        if marker == "tape":
            tms, tms_right = self._sum("tm_whole"), self._sum("tm_right")
            ids = sum(each.id_read for each in seen)
            numbers |= {"id": ids, "id_95": _rounded(intervals.wilson(ids, images)),
                        "tms": tms, "tms_right": tms_right, "tms_95": _rounded(intervals.wilson(tms_right, tms)),
                        "tms_wrong": self._sum("tm_wrong")}
        return numbers
