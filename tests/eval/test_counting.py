"""What the evaluation counts, and how sure it is of it. Run with the folder of tapemark_eval on PYTHONPATH."""

import random
import unittest
from types import SimpleNamespace

from tapemark_eval import damage, experiments, findings, gate, intervals
from tapemark_eval.camera import CM_IDS, TM_CODE, row_mm
from tapemark_eval.judge import judge


def tape_frame(whole_ids, tape_whole=False):
    truth = {"cms": [{"id": each, "full": each in whole_ids} for each in CM_IDS],
             "segments": [{"full": tape_whole}], "pictures": []}
    return SimpleNamespace(truth=truth)


class Intervals(unittest.TestCase):
    def test_wilson_is_as_published(self):
        # Newcombe, Statistics in Medicine 17, 1998, table I, method 3.
        for hits, trials, low, high in ((81, 263, 0.2553, 0.3662), (15, 148, 0.0624, 0.1605), (0, 20, 0, 0.1611),
                                        (1, 29, 0.0061, 0.1718)):
            bounds = intervals.wilson(hits, trials)
            self.assertAlmostEqual(bounds[0], low, 4)
            self.assertAlmostEqual(bounds[1], high, 4)

    def test_nothing_tells_nothing(self):
        self.assertEqual(intervals.wilson(0, 0), (0, 1))
        self.assertEqual(intervals.clustered([(0, 0)]), (0, 1))

    def test_markers_that_fail_together_tell_less(self):
        together = intervals.clustered([(6, 6), (0, 6)] * 10)
        apart = intervals.clustered([(3, 6)] * 20)
        self.assertAlmostEqual(apart[0], intervals.wilson(60, 120)[0])
        self.assertLess(together[0], apart[0] - 0.1)
        self.assertEqual(intervals.clustered([(6, 6)] * 20), intervals.wilson(20, 20))


class Verdicts(unittest.TestCase):
    def test_ids_count_where_the_marker_is_whole(self):
        verdict = judge(tape_frame({0, 2}), "tape", [0, -1, 77], [])
        self.assertEqual((verdict.whole, verdict.right, verdict.wrong), (2, 1, 1))
        self.assertTrue(verdict.id_read and verdict.something)

    def test_codes_may_read_backwards_only_undirected(self):
        frame = tape_frame(set(), True)
        self.assertEqual(judge(frame, "tape", [], [(TM_CODE[::-1], False)]).tm_right, 1)
        self.assertEqual(judge(frame, "tape", [], [(TM_CODE[:-1], True)]).tm_wrong, 1)
        lopsided = TM_CODE != TM_CODE[::-1]
        self.assertEqual(judge(frame, "tape", [], [(TM_CODE[::-1], True)]).tm_wrong, int(lopsided))

    def test_codes_that_are_no_ids_are_wrong(self):
        frame = SimpleNamespace(truth={"pictures": [{"picture": 3, "full": True}], "cms": [], "segments": []})
        verdict = judge(frame, "qr", [3, None], [])
        self.assertEqual((verdict.whole, verdict.right, verdict.wrong), (1, 1, 1))


class Damage(unittest.TestCase):
    def test_a_share_is_covered(self):
        for hurt in (damage.add_dirt, damage.add_tears):
            rows = [bytearray([255] * 200) for _ in range(80)]
            hurt(rows, 0.25, random.Random(1), 1.0)
            changed = sum(each != 255 for row in rows for each in row) / 16000
            self.assertTrue(0.25 <= changed < 0.3, changed)

    def test_a_share_of_the_cells_is_flipped(self):
        rows = [bytearray([255] * 10) for _ in range(10)]
        cells = [(row, column) for row in range(5) for column in range(10)]
        damage.flip_cells(rows, cells, 0.1, random.Random(1))
        self.assertEqual(sum(each == 0 for row in rows[:5] for each in row), 5)
        self.assertTrue(all(each == 255 for row in rows[5:] for each in row))


class Scenes(unittest.TestCase):
    def test_all_systems_see_the_same(self):
        for experiment in experiments.EXPERIMENTS:
            value = experiment.values[-1]
            scenes = [experiment.scene(value, experiments.random_of(experiment.name, value, 3), row_mm(None))
                      for _ in range(2)]
            self.assertEqual(*scenes)

    def test_steps_are_spread(self):
        distance = experiments.find("distance")
        self.assertEqual(experiments.steps_of(distance, 3), (0.5, 6, 20))
        self.assertEqual(experiments.steps_of(distance, None), distance.values)


class Falls(unittest.TestCase):
    def step(self, right, wrong=0):
        return {"experiment": "distance", "value": 3, "markers": 48, "right": right, "tms": 8, "tms_right": 8,
                "wrong": wrong}

    def test_less_than_chance_explains_is_a_fall(self):
        self.assertEqual(gate.compare([self.step(48)], [self.step(45)]), [])
        self.assertEqual(len(gate.compare([self.step(48)], [self.step(44)])), 2)  # the step, and all steps
        self.assertEqual(gate.compare([self.step(0)], [self.step(0)]), [])

    def test_a_wrong_id_is_a_fall(self):
        self.assertEqual(len(gate.compare([self.step(48)], [self.step(48, 1)])), 2)
        self.assertEqual(gate.compare([self.step(48, 1)], [self.step(48)]), [])

    def test_other_scenes_are_not_compared(self):
        with self.assertRaises(gate.GateError):
            gate.compare([self.step(48)], [self.step(48) | {"markers": 47}])


class Findings(unittest.TestCase):
    def test_reach_ends_at_the_first_gap(self):
        points = [(1, 1.0), (2, 0.96), (3, 0.4), (4, 1.0)]
        self.assertEqual(findings.reach(points, 0.95), 2)
        self.assertIsNone(findings.reach(points[2:], 0.95))
        self.assertEqual(findings.last(points, 0.95), 4)
        self.assertEqual(findings.span(points, 0.9), (1, 2))
        self.assertAlmostEqual(findings.half_way(points), 2 + 0.46 / 0.56)


if __name__ == "__main__":
    unittest.main()
