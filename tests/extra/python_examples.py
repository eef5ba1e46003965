#!/usr/bin/python3
"""python_examples.py: the search of the module shoal for an optimum, the scripts of doc/examples and the snippets of
doc/python.md. Run by test_python_examples.sh in a folder of its own; ends with the line of a shell test."""

import csv
import importlib.util
import os
import pathlib
import sys
import unittest
import warnings

import numpy as np

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "library"))
from test_python import FORKS_BESIDE_THREADS, ROOT, main, shoal  # noqa: E402

sys.path.append(str(ROOT / "scripts"))
import documents  # noqa: E402


def example(name):
    """A script of doc/examples as a module."""
    spec = importlib.util.spec_from_file_location(name, ROOT / f"doc/examples/{name}.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules[name] = module  # processes that learn look for it by its name
    spec.loader.exec_module(module)
    return module


# a fish with cheap beats, whose interval is given
SWIMMER = {"time": {"end": 1, "shedding_interval": 0.04},
           "fish": [{"name": "fish", "force": "reactive", "nodes": 9, "body": {"modulus": 1e7}}]}

# a flag that is straight, without any lift
ALONG_THE_STREAM = {"time": {"end": 1, "shedding_interval": 0.05}, "fluid": {"density": 1, "velocity": [1, 0], "viscosity": 0},
                    "fish": [{"nodes": 9, "sheet_points": 17, "wave": {"amplitude": 0, "frequency": 0}, "motion": {"prescribed": "head"},
                              "start": {"heading": 180}, "pressure": {"span": "infinite"}, "body": {"profile": "uniform", "depth": 1}}]}


@unittest.skipUnless(importlib.util.find_spec("scipy"), "python3-scipy is missing")
class Optima(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            cls.best = shoal.optimize(SWIMMER, "cost_of_transport", ["wave.frequency", "wave.amplitude"],
                                      bounds={"wave.frequency": (0.5, 2)}, subject_to={"speed": 0.8}, path="best", processes=1)

    def test_the_optimum_has_the_wanted_speed_and_a_lower_cost(self):
        best = self.best
        self.assertTrue(best.success, best)
        self.assertLess(abs(best.reached["steady_speed"] / 0.8 - 1), 1e-3)
        self.assertLess(best.value, 0.9 * best.start)
        self.assertEqual(list(best.values), ["fish.wave.frequency", "fish.wave.amplitude"])
        self.assertEqual(best.history[0]["fish.wave.frequency"], 1)
        self.assertRegex(repr(best), r"^<shoal.Optimum: steady_cost_of_transport 0\.\d+, 0\.\d+ of the start, steady_speed 0\.8")

    def test_the_optimum_is_a_case_of_its_own(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            state = shoal.steady(SWIMMER, self.best.assignments, path="own.nc", overwrite=True)
        self.assertLess(abs(state.cost_of_transport[0] / self.best.value - 1), 1e-3)
        self.assertTrue(os.path.exists(self.best.path))

    def test_along_the_wanted_speed_the_cost_has_no_slope(self):
        """The multiplier of Lagrange: both derivatives of the cost are the same multiple of those of the speed."""
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            cost, speed = shoal.error(SWIMMER, ["steady_cost_of_transport", "steady_speed"], assignments=self.best.assignments,
                                      sensitivity=["wave.frequency", "wave.amplitude"], path="slopes", overwrite=True)
        ratios = [cost.sensitivity[key][0] / speed.sensitivity[key][0] for key in cost.sensitivity]
        self.assertLess(abs(ratios[0] / ratios[1] - 1), 0.05, ratios)

    def test_the_history_is_kept_and_drawn(self):
        with open("best/history.csv", encoding="utf-8", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual(len(rows), len(self.best.history))
        self.assertEqual(float(rows[-1]["steady_speed"]), self.best.history[-1]["steady_speed"])
        if importlib.util.find_spec("matplotlib"):
            self.assertEqual(len(self.best.plot()), 4)

    def test_wrong_arguments_are_refused_before_a_search(self):
        for words, wrong in (("at least one number", {"over": []}), ("SLSQP or trust-constr", {"method": "BFGS"}),
                             ("at least one number", {"over": None}), ("tolerance is above 0", {"tolerance": -1}),
                             ("most is a whole number of iterations above 0", {"most": 0}),
                             (r"subject_to of speed: expects \(least, most\), not \(0.5, 0.8, 1\)", {"subject_to": {"speed": (0.5, 0.8, 1)}}),
                             (r"expects a value or \(least, most\), not \(2, 1\)", {"subject_to": {"speed": (2, 1)}}),
                             (r"expects a value or \(least, most\), not \(None, None\)", {"subject_to": {"speed": (None, None)}}),
                             ("subject_to of speed: nan is not finite", {"subject_to": {"speed": np.nan}}),
                             ("is the quantity itself", {"subject_to": {"steady_cost_of_transport": 0.1}})):
            with self.assertRaisesRegex(shoal.CaseError, words):
                shoal.optimize(SWIMMER, "cost_of_transport", **{"over": ["wave.amplitude"], "path": "never", **wrong})
        with self.assertRaisesRegex(TypeError, "subject_to is a dict"):
            shoal.optimize(SWIMMER, "cost_of_transport", ["wave.amplitude"], subject_to=[1], path="never")
        with self.assertRaisesRegex(TypeError, "a quantity is a name"):
            shoal.optimize(SWIMMER, None, ["wave.amplitude"], path="never")
        with self.assertRaisesRegex(shoal.FileError, "/dev/null: cannot create this folder"):
            shoal.optimize(SWIMMER, "cost_of_transport", ["wave.amplitude"], path="/dev/null", overwrite=True)
        self.assertFalse(os.path.exists("never"))
        with self.assertRaisesRegex(shoal.FileError, "best: exists"):
            shoal.optimize(SWIMMER, "cost_of_transport", ["wave.amplitude"], path="best")

    def test_wrong_numbers_are_refused_with_a_remedy(self):
        def ask(words, *arguments, **more):
            with self.assertRaisesRegex(shoal.CaseError, words):
                shoal.optimize(SWIMMER, "cost_of_transport", *arguments, path="wrong", overwrite=True, **more)

        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            ask("'nodes' is no such number", ["nodes"])
            ask("is 0 or not given", ["wave.constant"])
            ask("not within its bounds, 0.5 and 0.6", ["wave.amplitude"], {"wave.amplitude": (0.5, 0.6)})
            ask(r"bounds of wave.amplitude: expects \(least, most\), not \(0.1,\)", ["wave.amplitude"], [(0.1,)])
            ask("which is not in over: wave.amplitude", ["wave.amplitude"], {"amplitude": (0.1, 0.6)})
            with self.assertRaisesRegex(TypeError, "bounds is a dict of"):
                shoal.optimize(SWIMMER, "cost_of_transport", ["wave.amplitude"], 3, path="wrong", overwrite=True)
            with self.assertRaisesRegex(shoal.CaseError, "lift is 0 at the start"):
                shoal.optimize(ALONG_THE_STREAM, "lift", ["modulus"], path="wrong", overwrite=True)


class Examples(unittest.TestCase):
    @FORKS_BESIDE_THREADS  # of the pool before, which end after it has closed
    def test_a_fish_begins_to_learn(self):
        hold_place = example("hold_place")
        hold_place.CASE["time"]["end"] = 1.92
        policy, history = hold_place.learn(2, 8, 2, seed=1)
        self.assertEqual((policy.size, len(history), history[0].size), (12, 2, 8))
        self.assertTrue(all(np.isfinite(rewards).all() and rewards.max() > rewards.min() for rewards in history))
        again, _ = hold_place.learn(2, 8, 1, seed=1)
        np.testing.assert_array_equal(policy, again)
        hold_place.draw("hold_place.png", history, *([hold_place.episode(policy, 1)[1]] for _ in range(2)))

    def test_an_unstable_school_is_held_by_the_amplitude_of_a_plate(self):
        keep_together = example("keep_together")
        keep_together.CASE["time"]["end"] = 12
        away = [keep_together.swim(3.816, 7.235, is_controlled)[1] for is_controlled in (False, True)]
        self.assertGreater(abs(away[0][-1]), 1)
        self.assertLess(abs(away[1][-1]), 0.1)

    def test_the_threshold_of_a_school_is_the_zero_of_a_line(self):
        chart = example("school_stability")
        random = np.random.default_rng(2)
        heaves, slope, threshold = np.array([0.118, 0.122, 0.126, 0.138, 0.142]), -0.2, 0.13

        def rows(noise, claimed):
            sizes = 1 + slope * np.log(heaves / threshold) + noise * random.standard_normal(heaves.size)
            return [{"plates": 4, "heave": heave, "multiplier": size, "error": claimed, "cpu": 1.0} for heave, size in zip(heaves, sizes)]

        np.testing.assert_allclose(chart.threshold_of(rows(0, 0.01))[0], threshold, rtol=1e-9)
        # errors are twice the standard deviation, and so is the bar: 95 % of the thresholds lie within it
        inside = [abs(value - threshold) < bar for value, bar in (chart.threshold_of(rows(0.005, 0.01)) for _ in range(400))]
        self.assertGreater(np.mean(inside), 0.9)
        # errors that are claimed too small show in the scatter, and widen the bar
        self.assertGreater(np.median([chart.threshold_of(rows(0.005, 1e-3))[1] for _ in range(40)]), 0.002)
        # no threshold without states on both sides, but a bound
        heaves = heaves[3:]
        self.assertIsNone(chart.threshold_of(rows(0, 0.001)))
        # two states far from each other have a line, too
        sparse = [{"heave": heave, "multiplier": multiplier, "error": 0.01} for heave, multiplier in ((0.3, 0.95), (0.1, 1.05))]
        self.assertAlmostEqual(chart.threshold_of(sparse)[0], np.sqrt(0.03), places=12)
        self.assertEqual(chart.bound_of(rows(0, 0.001)), 0.138)
        self.assertEqual(next(chart.report(rows(0, 0.001))), "4 plates: stable down to 0.138 m (1 s of CPU time a state)")
        self.assertIsNone(chart.bound_of(rows(0, 0.5)))

    def test_the_chart_of_the_manual_has_the_states_that_a_search_finds_and_its_page_their_numbers(self):
        chart = example("school_stability")
        rows = chart.read_table(os.path.join(os.path.dirname(chart.CASE), "school_stability.csv"))
        with open(os.path.join(os.path.dirname(chart.CASE), "..", "..", "doc", "steady.md"), encoding="utf-8") as page:
            text = page.read()
        for line in chart.report(rows):
            self.assertIn(line + "\n", text)
        table = {(row["plates"], row["heave"]): row for row in rows}
        # one row of two plates, and one of four, which starts from that of three
        for plates, heave in ((2, 0.2), (4, 0.15)):
            before = table.get((plates - 1, heave), {"plates": 1, "speed": table[2, heave]["speed"], "places": [0.0]})
            row, found = table[plates, heave], chart.state_of(heave, before)
            self.assertLessEqual(abs(found["multiplier"] - row["multiplier"]), found["error"] + row["error"])
            np.testing.assert_allclose(found["places"], row["places"], atol=0.05)

    def test_a_chart_has_the_states_of_two_plates_and_keeps_them(self):
        chart = example("school_stability")
        rows = chart.fill([], [2], [0.15], "chart.csv")
        self.assertEqual([(row["plates"], chart.verdict(row)) for row in rows], [(2, "stable")])
        # twice as many events and a finer body give 0.904 and a period of 6.7 beats, at 5.11 m
        self.assertAlmostEqual(rows[0]["multiplier"], 0.904, delta=0.01)
        self.assertAlmostEqual(rows[0]["period"], 6.7, delta=0.15)
        self.assertAlmostEqual(rows[0]["places"][1], -5.105, delta=0.05)
        kept = chart.read_table("chart.csv")
        chart.state_of = None  # would fail
        self.assertEqual(len(chart.fill(kept, [2], [0.15], "chart.csv")), 1)
        chart.draw("chart.png", kept)

    def test_the_smoother_of_a_linear_model_is_that_of_bayes(self):
        estimate = example("estimate")
        random = np.random.default_rng(5)
        model = random.standard_normal((12, 4)) * np.array([12, 20, 2, 2])
        truth = estimate.MEAN + estimate.DEVIATION * random.standard_normal(4)
        data = model @ truth + estimate.NOISE * random.standard_normal(12)
        ensemble = estimate.smooth(lambda schools: schools @ model.T, data, random, 4000)[-1]
        inverse = np.diag(estimate.DEVIATION**-2) + model.T @ model / estimate.NOISE**2
        mean = np.linalg.solve(inverse, estimate.MEAN / estimate.DEVIATION**2 + model.T @ data / estimate.NOISE**2)
        spread = np.linalg.inv(inverse).diagonal() ** 0.5
        # the data tell something, and the errors of 4000 members are 1/63 and 1/89 of the deviation
        self.assertTrue(np.all(spread < 0.7 * estimate.DEVIATION), spread)
        np.testing.assert_allclose((ensemble.mean(axis=0) - mean) / spread, 0, atol=0.08)
        np.testing.assert_allclose(ensemble.std(axis=0) / spread, 1, atol=0.06)

    def test_a_follower_finds_its_leader(self):
        estimate = example("estimate")
        estimate.BEATS = 3
        truth, ensembles = estimate.twin(0, 1, lambda schools: [estimate.measured(one) for one in schools], 12)
        before, after = (estimate.errors(ensemble, truth) for ensemble in ensembles[[0, -1]])
        self.assertTrue(np.all(after.std(axis=0) < 0.5 * before.std(axis=0)), (before.std(axis=0), after.std(axis=0)))
        estimate.draw("estimate.png", [(truth, ensembles)])

    def test_the_best_gait_is_found_and_compared(self):
        best_gait = example("best_gait")
        best_gait.main({**SWIMMER, "name": "gait"}, 0.8, None, {"wave.amplitude": (0.15, 0.6)}, models=False)
        self.assertTrue(os.path.exists("best_gait-error/error.csv") and os.path.exists("best_gait/history.csv"))


class Document(unittest.TestCase):
    def test_every_snippet_runs_and_prints_its_comments(self):
        path = ROOT / "doc/python.md"
        snippets = [block.text for block in documents.blocks_of(path.read_text()) if block.kind == "python"]
        self.assertGreater(len(snippets), 10)
        self.assertGreater(sum(len(documents.PRINT.findall(snippet)) for snippet in snippets), 5)
        self.assertEqual(list(documents.compare(path, os.environ["SHOAL_PROGRAM"])), [])


if __name__ == "__main__":
    main()
