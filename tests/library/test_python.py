#!/usr/bin/python3
"""test_python.py: the module shoal. Run by test_python.sh in a folder of its own; ends with the line of a shell test."""

import copy
import functools
import gc
import importlib.util
import json
import multiprocessing
import os
import pathlib
import pickle
import pydoc
import re
import signal
import subprocess
import sys
import threading
import time
import unittest
import warnings

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, os.environ.get("SHOAL_MODULE", str(ROOT / "scripts")))
import shoal  # noqa: E402

SMALL = {"force": "reactive", "nodes": 7, "sheet_points": 21}
PAIR = {
    "time": {"end": 0.2, "shedding_interval": 0.02, "output_interval": 0.02},
    "fish": [{"name": "a", **SMALL, "wave": {"ramp": 0.1}},
             {"name": "b", **SMALL, "nodes": 9, "start": {"position": [0.2, 0.7]}}],
}


class Runs(unittest.TestCase):
    def test_a_case_is_a_dict_or_a_path_with_assignments(self):
        pathlib.Path("pair.yaml").write_text(json.dumps({"format": 1, "name": "pair", **PAIR}))  # JSON is YAML
        by_path, by_dict = shoal.Run("pair.yaml", {"fish[0].nodes": 11}), shoal.Run(PAIR, {"fish[0].nodes": 11})
        for run in by_path, by_dict:
            run.advance(run.end)
            self.assertEqual(list(run["n_nodes"]), [11, 9])
        self.assertEqual(by_path["x"].tobytes(), by_dict["x"].tobytes())

    def test_the_cases_beside_the_library_can_be_included(self):
        self.assertEqual(shoal.Run({"include": ["demo.yaml"], "time": {"end": 0.25}}).names, ["fish"])

    def test_a_view_has_shape_names_and_unit_and_is_no_copy(self):
        run = shoal.Run(PAIR)
        run.step()
        x = run.view("x")
        self.assertEqual((x.shape, x.dims, x.unit), ((2, 9, 2), ("fish", "node", "xy"), "m"))
        self.assertTrue(np.isnan(x[0, 7:]).all() and np.isfinite(x[0, :7]).all())
        self.assertFalse(x.flags.writeable or x.flags.owndata)
        self.assertEqual(run.view("x").ctypes.data, x.ctypes.data)
        self.assertEqual(run["wake_x"].shape, (2, 2, 2))
        self.assertEqual(run["total_circulation"].shape, ())
        self.assertIsNone(x[0].dims)

    def test_what_is_read_stays(self):
        run = shoal.Run(PAIR)
        places = []
        while not run.at_end:
            places.append(run["com"])
            run.step()
        self.assertEqual((places[0].dims, places[0].unit), (("fish", "xy"), "m"))
        self.assertTrue(places[0].flags.writeable and places[0].flags.owndata)
        self.assertGreater(np.abs(places[0] - places[-1]).max(), 1e-6)
        with self.assertRaises(ValueError):
            run.view("com")[0] = 1

    def test_a_view_keeps_its_run(self):
        run = shoal.Run(PAIR)
        x = run.view("x")
        before = x.copy()
        run.close()
        del run
        gc.collect()
        np.testing.assert_array_equal(x, before)

    def test_every_variable_can_be_read(self):
        run = shoal.Run(PAIR)
        run.step()
        self.assertGreater(len(run.keys()), 60)
        for name in run.keys():
            self.assertIsInstance(run[name], np.ndarray)
            self.assertIn(name, run)
        self.assertEqual(run.names, ["a", "b"])

    def test_the_flow_has_the_shape_of_the_points(self):
        run = shoal.Run(PAIR, {"fluid.velocity": [0.1, 0.2]})
        run.advance(0.2)
        velocity, vorticity = run.flow(np.full((3, 4, 2), 1e6))
        self.assertEqual((velocity.shape, vorticity.shape), ((3, 4, 2), (3, 4)))
        np.testing.assert_allclose(velocity, np.broadcast_to([0.1, 0.2], (3, 4, 2)), atol=1e-6)
        with self.assertRaisesRegex(shoal.CaseError, "shape"):
            run.flow([1, 2, 3])

    def test_errors_are_exceptions_with_the_words_of_the_program(self):
        with self.assertRaisesRegex(shoal.CaseError, "did you mean 'amplitude'"):
            shoal.Run(PAIR, {"fish[0].wave.amplitud": 1})
        with self.assertRaisesRegex(shoal.FileError, "/no/such.yaml"):
            shoal.Run("/no/such.yaml")
        with self.assertRaisesRegex(shoal.SolverError, "max_steps"):
            shoal.Run(PAIR, {"solver.max_steps": 1}).step()
        run = shoal.Run(PAIR)
        with self.assertRaisesRegex(shoal.CaseError, "there is no variable 'speeed'"):
            run["speeed"]
        run.advance(run.end)
        self.assertTrue(run.at_end)
        with self.assertRaisesRegex(shoal.CaseError, "at its end"):
            run.step()
        with self.assertRaises(TypeError):
            shoal.Run({**PAIR, "name": object()})

    def test_arguments_are_not_cut(self):
        run = shoal.Run(PAIR)
        before = run["wave_amplitude"].copy()
        for fish in 2, -1, 2**32, 2**40, 2**64, "c":
            with self.assertRaisesRegex(shoal.CaseError, f"there is no fish '?{fish}"):
                run.set(fish, "wave.amplitude", 0.5)
        with self.assertRaises(TypeError):
            run.set(0.5, "wave.amplitude", 0.5)
        for wrong in (lambda: run.set(0, "wave.amplitude\0 of it", 0.5), lambda: "speed\0" in run,
                      lambda: run.write("cut.nc\0 here"), lambda: shoal.Run("cut.yaml\0 here"),
                      lambda: shoal.Run(PAIR, ["name=a\0b"]), lambda: shoal.Run(PAIR, folder=".\0")):
            try:
                self.assertFalse(wrong())
            except shoal.CaseError as error:
                self.assertIn("has a zero byte in it", str(error))
        self.assertFalse(os.path.exists("cut.nc"))
        for wrong in (lambda: shoal.Run("a\ud800.yaml"), lambda: run.write("a\ud800.nc"),
                      lambda: shoal.check("a\ud800.yaml"), lambda: shoal.steady(PAIR, path="a\ud800.nc"),
                      lambda: shoal.study(PAIR, path="a\ud800"), lambda: shoal.view("a\ud800.nc"),
                      lambda: shoal.Run(PAIR, folder="a\ud800")):
            with self.assertRaisesRegex(shoal.CaseError, "has a surrogate in it, which is no character"):
                wrong()
        # a name that is not UTF-8: the program takes it, the NetCDF library of Python does not
        with self.assertRaisesRegex(shoal.FileError, "cannot be read"):
            shoal.check("a\udcff.yaml")
        run.write("a\udcff.nc")
        with self.assertRaisesRegex(shoal.FileError, "the name is not UTF-8: rename the file or its folder"):
            shoal.open("a\udcff.nc")
        run.step()
        for time in -1, 0:
            with self.assertRaisesRegex(shoal.CaseError, "before the last event"):
                run.advance(time)
        run.advance(run.end)
        alone = shoal.Run(PAIR)
        alone.advance(alone.end)
        self.assertEqual(run["wave_amplitude"].tobytes(), alone["wave_amplitude"].tobytes())
        self.assertEqual(before.tobytes(), shoal.Run(PAIR)["wave_amplitude"].tobytes())

    def test_a_fish_is_led(self):
        run, alone = shoal.Run(PAIR), shoal.Run(PAIR)
        run.set("a", "wave.amplitude", 0.1)
        run.set(1, "control.bias", 0.3)
        for one in run, alone:
            one.advance(0.2)
        self.assertGreater(np.abs(run["x"][0, :7] - alone["x"][0, :7]).max(), 1e-5)
        self.assertGreater(float(run["phi0"][1]), 0.01)
        with self.assertRaisesRegex(shoal.CaseError, "cannot be set"):
            run.set(0, "wave.phase", 1)

    def test_bodies_and_wakes_are_changed(self):
        case = {**PAIR, "wake": {"spare_vortices": 4}}
        run, alone = shoal.Run(case), shoal.Run(case)
        for one in run, alone:
            one.step(3)
            one.step(0)
            one.step(np.int64(0))
            self.assertAlmostEqual(one.time, 0.06)
        position, velocity = run.state("b")
        self.assertEqual((position.shape, velocity.shape), ((9, 2), (9, 2)))
        np.testing.assert_array_equal(position, run["x"][1])
        run.set_state("b", velocity=velocity + [0.5, 0])
        np.testing.assert_allclose(run["com_velocity"][1], alone["com_velocity"][1] + [0.5, 0], atol=1e-12)
        run.set_state(1, position=position + [0, 0.1])
        np.testing.assert_allclose(run.state(1)[0], position + [0, 0.1])
        run.add_vortex(-1, 0.2, 0.05)
        self.assertEqual(run["wake_count"].tolist(), [alone["wake_count"][0] + 3, alone["wake_count"][1] + 1])
        self.assertLess(abs(run["total_circulation"]), 1e-10)
        run.advance(run.end)
        with self.assertRaisesRegex(shoal.CaseError, "wake.spare_vortices: 4, of which 3 are used"):
            run.add_vortex(0, 0, 1)
        with self.assertRaisesRegex(shoal.CaseError, r"position of b has the shape \(9, 2\), not \(7, 2\)"):
            run.set_state("b", position=np.zeros((7, 2)))
        with self.assertRaisesRegex(shoal.CaseError, "edge 0 of b would be 0 m long"):
            run.set_state("b", position=np.zeros((9, 2)))

    def test_a_copy_has_the_bits_of_the_run(self):
        run = shoal.Run(PAIR)
        run.advance(0.1)
        copy = run.clone()
        kept = run.clone()
        for one in run, copy:
            one.advance(0.2)
        self.assertEqual(run["x"].tobytes(), copy["x"].tobytes())
        end = run["x"].tobytes()
        run.restore(kept)
        self.assertAlmostEqual(run.time, 0.1)
        run.advance(0.2)
        self.assertEqual(run["x"].tobytes(), end)

    def test_runs_in_threads_are_those_alone(self):
        def swim(frequency, into):
            run = shoal.Run(PAIR, {"fish[*].wave.frequency": frequency})
            run.advance(run.end)
            into[frequency] = run["x"].tobytes()

        alone, together = {}, {}
        for frequency in 1.0, 1.2, 1.4:
            swim(frequency, alone)
        threads = [threading.Thread(target=swim, args=(frequency, together)) for frequency in alone]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(alone, together)

    def test_a_step_and_a_view_call_few_functions_of_python(self):
        # the time of a step is compared with that of the same step in C by `make bench`
        run = shoal.Run(PAIR)
        run.step()
        run.view("x")
        calls = []

        def record(frame, event, argument):
            if event in ("call", "c_call"):
                calls.append(frame.f_code.co_name if event == "call" else argument.__name__)

        sys.setprofile(record)
        run.step()
        run.view("x")
        sys.setprofile(None)
        calls.remove("setprofile")
        self.assertLessEqual(len(calls), 20, calls)  # 3 hand the step over to the thread that a signal can stop


# Each is a way to misuse the module, in the terms of Python: what it raises, or None where it has to work. `run` is a run
# of two fish after three events, `other` a run of another case.
MISUSE = [
    (None, "kept = copy.deepcopy(run); del kept; gc.collect(); run.step()"),
    (None, "kept = copy.copy(run); run.close(); del run; gc.collect(); kept.step()"),
    (None, "kept = copy.deepcopy([run, run]); assert kept[0] is kept[1]; run.close(); kept[0].step()"),
    (None, "kept = pickle.loads(pickle.dumps(run)); run.close(); kept.step()"),
    (None, "kept = pickle.loads(pickle.dumps(run['x'])); run.close(); kept.sum()"),
    (None, "env = shoal.SwimEnv(PAIR); env.reset(); kept = copy.deepcopy(env); del env; gc.collect(); kept.step([0.1])"),
    (None, "env = shoal.SwimEnv(PAIR); env.reset(); kept = pickle.loads(pickle.dumps(env)); kept.step([0.1]); kept.reset()"),
    (None, "views = [run.view(name) for name in run.keys()]; run.close(); del run; gc.collect(); [v.tobytes() for v in views]"),
    (None, "a = run.view('x')[0, 1:3]; run.step(); run.close(); del run; gc.collect(); a.sum()"),
    (None, "[thread.start() or thread for thread in [threading.Thread(target=run.step) for _ in range(5)]]; run.close()"),
    (None, "in_threads(lambda: run.step() if not run.at_end else None, lambda: run['wake_x'], lambda: run.clone())"),
    (None, "in_threads(run.close, lambda: shoal.Run(PAIR).step(), lambda: pickle.dumps(shoal.Run(PAIR)))"),
    (None, "kept = run.clone(); in_threads(lambda: run.restore(kept), lambda: kept.restore(run), lambda: kept.view('x').sum())"),
    (None, "with multiprocessing.get_context('fork').Pool(2) as pool: assert len(pool.map(advanced, [run, run])) == 2"),
    (None, "with multiprocessing.get_context('spawn').Pool(1) as pool: pool.map(shoal.Run.step, [run])"),
    (None, "in_fork(run.step); run.step()"),
    (None, "many = shoal.Run(PAIR, {'solver.threads': 2}); many.step(); in_fork(lambda: many.advance(many.end)); many.step()"),
    (None, "run.__init__(PAIR); run.step(); gc.collect()"),
    (None, "run.close(); run.close(); repr(run); run._repr_html_(); run.closed"),
    ("CaseError: the run is closed", "run.close(); run.step()"),
    ("CaseError: the run is closed", "run.close(); run['x']"),
    ("CaseError: the run is closed", "run.close(); copy.deepcopy(run)"),
    ("CaseError: the run is closed", "run.close(); run.restore(other)"),
    ("CaseError: the run is closed", "run.close(); run.names"),
    ("TypeError: .* cannot be pickled: the run is closed", "run.close(); pickle.dumps(run)"),
    ("TypeError: .* cannot be pickled: .* failed before", "run = shoal.Run(PAIR, {'solver.max_steps': 1}); failing(run.step); pickle.dumps(run)"),
    ("TypeError: this run cannot be restored", "shoal._run._unpickle(shoal.Run, pickle.dumps(run)[:-50])"),
    ("CaseError: set: there is no fish 1099511627776: this run has 2, numbered from 0: a, b", "run.set(2**40, 'wave.amplitude', 0.5)"),
    ("CaseError: set: there is no fish -1", "run.set(-1, 'wave.amplitude', 0.5)"),
    ("TypeError: set: a fish is a number or a name", "run.set(None, 'wave.amplitude', 0.5)"),
    ("TypeError: advance: a time, s, is one number, not str '1'", "run.advance('1')"),
    ("CaseError: .* before the last event", "run.advance(-1)"),
    ("CaseError: .* not finite", "run.advance(float('nan'))"),
    ("CaseError: .* not finite|TypeError", "run.advance(10**400)"),
    ("CaseError: .* after the end", "run.advance(1e300)"),
    ("TypeError: .* not list", "run.advance([1, 2])"),
    ("CaseError: step: -1 events", "run.step(-1)"),
    ("CaseError: step: 1.5 events: the number is whole", "run.step(1.5)"),
    ("CaseError: step: .*: a value is masked", "run.step(np.ma.masked)"),
    ("CaseError: advance: .*: a value is masked: fill it first", "run.advance(np.ma.array(0.1, mask=True))"),
    ("CaseError: set: wave.amplitude: a value is masked", "run.set(0, 'wave.amplitude', np.ma.array([0.5], mask=[True]))"),
    ("CaseError: flow: points: a value is masked", "run.flow(np.ma.array([0, 0], mask=[True, False]))"),
    ("CaseError: a case cannot hold dict: a value is masked", "shoal.Run({**PAIR, 'solver': {'rtol': np.ma.array(1e-5, mask=True)}})"),
    ("CaseError: flow: points: 1073741824 numbers are too many", "run.flow(np.broadcast_to(0.5, (2**29, 2)))"),
    ("CaseError: there is no variable .*speed.*did you mean speed", "run['speed\\0s']"),
    ("TypeError: a variable is named by a string, not int 3", "run[3]"),
    ("CaseError: .*zero byte", "run.set(0, 'wave.amplitude\\0', 1)"),
    ("TypeError: set: wave.amplitude: numbers", "run.set(0, 'wave.amplitude', 'large')"),
    ("TypeError: set: wave.amplitude: numbers", "run.set(0, 'wave.amplitude', 1j)"),
    (".*Error: set: wave.amplitude: ", "run.set(0, 'wave.amplitude', functools.reduce(lambda inner, _: [inner], range(10**5), []))"),
    ("CaseError: .*0 numbers: give one", "run.set(0, 'wave.amplitude', [])"),
    ("CaseError: .*cannot be set: only wave.amplitude, wave.frequency", "run.set(0, 'wave.phase', 1)"),
    ("CaseError: set: control.waypoints: ", "run.set(0, 'control.waypoints', [[1, 2], [3]])"),
    ("CaseError: .*needs 'law: place'", "run.set(0, 'control.offset', [1, 2])"),
    ("TypeError: set: control.waypoints: numbers", "run.set(0, 'control.waypoints', [object()])"),
    ("CaseError: .* too many", "run.set(0, 'control.waypoints', np.zeros(2**21))"),
    ("TypeError: a case is the path of a case file or a dict, not int 0", "shoal.Run(0)"),
    ("TypeError: sweep: the values of time.end are a list, not int 1", "shoal.study(PAIR, sweep={'time.end': 1})"),
    ("TypeError: sweep: the values of time.end are a list, not str '1,2'", "shoal.study(PAIR, sweep={'time.end': '1,2'})"),
    ("TypeError: path is a string or a path, not int 3", "shoal.steady(PAIR, path=3)"),
    ("TypeError: start is a string or a path, not int 3", "shoal.threshold(PAIR, 'time.end', 1, 2, start=3)"),
    ("TypeError: a case is the path", "shoal.Run(None)"),
    ("CaseError: a case cannot hold dict: nested too deep",
     "shoal.Run(functools.reduce(lambda inner, _: {'fish': inner}, range(10**5), {}))"),
    ("CaseError: a case cannot hold list: nested too deep",
     "shoal.Run(PAIR, {'fish': functools.reduce(lambda inner, _: [inner], range(10**5), [])})"),
    ("TypeError: assignments are a dict", "shoal.Run(PAIR, 'time.end=2')"),
    ("TypeError: an assignment is a string", "shoal.Run(PAIR, [1])"),
    ("TypeError: an assignment is a string", "shoal.Run(PAIR, [None])"),
    ("TypeError: restore: a Run, not NoneType", "run.restore(None)"),
    ("CaseError: .*not copies", "run.restore(other)"),
    ("CaseError: flow: points have the shape", "run.flow(1)"),
    ("TypeError: flow: points: numbers", "run.flow('here')"),
    ("CaseError: .*is not finite", "run.flow([np.nan, 0])"),
    ("TypeError: path is a string or a path", "run.write(3)"),
    ("FileError", "run.write('/no/such/folder/x.nc')"),
    ("ValueError: .*read-only", "run.view('x')[0, 0, 0] = 1"),
    ("TypeError: progress is a function", "run.advance(run.end, progress=3)"),
    ("KeyError: 'told'", "run.advance(run.end, progress=lambda *_: {}['told'])"),
    ("FileError: .*no such file|FileError", "shoal.load('/no/such.ckpt')"),
    ("FileError: .*cannot be used", "pathlib.Path('bad.ckpt').write_text('bad'); shoal.load('bad.ckpt')"),
]


def advanced(run):
    run.advance(run.end)
    return run.time


def failing(call):
    try:
        call()
    except shoal.Error:
        pass


def in_threads(*calls):
    """Each call over and over again in a thread of its own; a run that is closed meanwhile says so."""
    def over_and_over(call):
        for _ in range(8):
            failing(call)

    threads = [threading.Thread(target=over_and_over, args=[call]) for call in calls]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


FORKS_BESIDE_THREADS = unittest.skipIf("libasan" in os.environ.get("LD_PRELOAD", ""),
                                       "the allocator of gcc 12's sanitizer stays locked in the child of a process with threads")


def in_fork(call):
    """A call in a child, which has to end."""
    child = os.fork()
    if child == 0:
        signal.alarm(60)
        call()
        os._exit(0)
    assert os.waitpid(child, 0)[1] == 0, "the child has not ended well"


class Misuse(unittest.TestCase):
    def outcome(self, code):
        """The exception of a piece of code in a child process, or the signal that ended the child."""
        reading, writing = os.pipe()
        child = os.fork()
        if child == 0:
            said = "the end of the process"
            try:
                signal.alarm(120)
                os.close(reading)
                run, other = shoal.Run(PAIR), shoal.Run(PAIR, {"time.end": 0.1})
                run.step(3)
                exec(code, {**globals(), "run": run, "other": other})
                said = "None"
            except BaseException as error:
                said = f"{type(error).__name__}: {error}"
            finally:
                os.write(writing, said.encode()[:4000])
                os._exit(0)
        os.close(writing)
        with os.fdopen(reading, "rb") as file:
            said = file.read().decode()
        status = os.waitpid(child, 0)[1]
        return f"signal {os.WTERMSIG(status)}" if os.WIFSIGNALED(status) else said

    def test_no_misuse_ends_the_process(self):
        self.assertGreater(len(MISUSE), 30)
        for want, code in MISUSE:
            with self.subTest(code):
                self.assertRegex(self.outcome(code), f"^({want})")

    @FORKS_BESIDE_THREADS
    def test_a_run_that_a_thread_steps_during_a_fork_is_refused_in_the_child(self):
        run = shoal.Run({**PAIR, "time": {**PAIR["time"], "end": 20}})
        thread = threading.Thread(target=lambda: run.advance(run.end))
        thread.start()
        time.sleep(0.05)
        self.assertTrue(thread.is_alive())

        def use():
            try:
                run.step()
            except shoal.SolverError as error:
                os._exit(0 if "when the process forked" in str(error) and repr(run) else 1)
            os._exit(2)

        in_fork(use)
        thread.join()
        self.assertTrue(run.at_end)


class Words(unittest.TestCase):
    """What a terminal and a notebook show, and progress."""

    def test_a_run_says_what_it_is(self):
        run = shoal.Run(PAIR)
        self.assertEqual(repr(run), "<shoal.Run of 2 fish (a, b) at t = 0 of 0.2 s>")
        self.assertRegex(shoal.__version__, r"^\d+\.\d+\.\d+$")
        self.assertIn(shoal.__version__, shoal.version())
        self.assertIn("com_velocity", run._ipython_key_completions_())
        self.assertLessEqual({"Run", "check", "steady", "study", "open", "plot"}, set(dir(shoal)))

    def test_help_is_the_table_of_functions_on_a_few_screens(self):
        lines = pydoc.plain(pydoc.render_doc(shoal)).splitlines()
        self.assertLess(len(lines), 100)
        self.assertIn("steady(case)", "\n".join(lines[:20]))

    def test_every_public_name_has_types_and_a_docstring(self):
        for name in dir(shoal):
            thing = getattr(shoal, name)
            if name == "__version__":
                continue
            self.assertTrue(thing.__doc__, name)
            members = [] if not isinstance(thing, type) else [member for key, member in vars(thing).items()
                                                              if not key.startswith("_") and callable(member)]
            for member in members:
                self.assertTrue(member.__doc__, f"{name}: {member}")
        for method in ("advance", "set", "flow", "clone", "view"):
            self.assertIn("return", {**getattr(shoal.Run, method).__annotations__, "return": None})
            self.assertTrue(getattr(shoal.Run, method).__annotations__ or method == "clone", method)

    def test_a_notebook_shows_the_run_and_looking_changes_nothing(self):
        run, alone = shoal.Run(PAIR), shoal.Run(PAIR)
        run.step(4)
        text = run._repr_html_()
        self.assertEqual((text.count("<polygon"), text.count("<circle")), (2, int(run["wake_count"].sum())))
        for one in run, alone:
            one.advance(one.end)
        self.assertEqual(run["x"].tobytes(), alone["x"].tobytes())
        run = shoal.Run(PAIR)
        run.write("shown.nc", overwrite=True)
        run.advance(0.1)
        self.assertIn("<iframe srcdoc=", run._repr_html_())
        self.assertFalse(os.path.exists("shown.html"))

    def test_progress_is_reported(self):
        run, seen, started = shoal.Run({**PAIR, "time": {**PAIR["time"], "end": 4}}), [], time.monotonic()
        run.advance(3.99, progress=lambda time, end: seen.append((time, end)))
        self.assertLessEqual(len(seen), 2 + (time.monotonic() - started) / shoal._progress.EVERY)
        self.assertEqual((seen[0], seen[-1][0]), ((0.0, 3.99), run.time))
        self.assertEqual([time for time, _ in seen], sorted(time for time, _ in seen))
        self.assertAlmostEqual(run.time, 4)
        alone = shoal.Run({**PAIR, "time": {**PAIR["time"], "end": 4}})
        alone.advance(4)
        self.assertEqual(run["x"].tobytes(), alone["x"].tobytes())

    def test_ctrl_c_takes_effect_within_one_event(self):
        # without and with progress; the run continues with the bits of an uninterrupted run
        case = {**PAIR, "time": {**PAIR["time"], "end": 1000}}
        for progress in (False, lambda time, end: None):
            run = shoal.Run(case)
            sent = []

            def interrupt():
                sent.append(shoal._library.library.shoal_time(run._handle.pointer))
                os.kill(os.getpid(), signal.SIGINT)

            timer = threading.Timer(0.3, interrupt)
            timer.start()
            with self.assertRaises(KeyboardInterrupt):
                run.advance(run.end, progress)
            timer.join()
            self.assertLess(run.time, run.end)
            # the event in progress, and one more for the time between the two lines above
            self.assertLessEqual(run.time, sent[0] + 2.5 * run.interval)
            run.step()
            alone = shoal.Run(case)
            alone.advance(run.time)
            self.assertEqual(run["x"].tobytes(), alone["x"].tobytes())

    def test_ctrl_c_stops_the_set_up(self):
        # this set-up takes minutes
        fine = {**PAIR, "fish": [{"nodes": 1500}]}
        timer = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        started = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            shoal.Run(fine)
        self.assertLess(time.monotonic() - started, 60)
        timer.join()
        shoal.Run(PAIR).step()

    def test_ctrl_c_stops_a_long_event_and_a_copy_of_a_large_run(self):
        # 100,000 steps for an event: minutes
        long = {**PAIR, "solver": {"method": "rk4", "step": 2e-7, "max_steps": 1000000}}
        run = shoal.Run(long)
        whole = run["x"].tobytes()
        for call in (run.step, lambda: run.advance(run.end), lambda: run.advance(run.end, progress=lambda *_: None)):
            timer = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT))
            timer.start()
            with self.assertRaises(KeyboardInterrupt):
                call()
            timer.join()
            self.assertEqual((run.time, run["x"].tobytes()), (0, whole))

        # an environment too, and its run is at an event
        environment = shoal.SwimEnv(long)
        environment.reset()
        timer = threading.Timer(0.1, os.kill, (os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            environment.step(environment.action_space.sample())
        timer.join()
        self.assertEqual(environment.run.time, 0)

        # the set-up of the copy takes as long as that of the run
        large = shoal.Run({**PAIR, "fish": [{"nodes": 200}]})
        for copied in (large.clone, lambda: copy.copy(large), lambda: copy.deepcopy(large)):
            timer = threading.Timer(0.02, os.kill, (os.getpid(), signal.SIGINT))
            timer.start()
            with self.assertRaises(KeyboardInterrupt):
                copied()
            timer.join()
        self.assertEqual(large.time, 0)

    def test_a_signal_handler_does_not_see_a_run_between_two_events(self):
        solver = {"method": "rk4", "step": 5e-6, "max_steps": 100000}
        run, other, said = shoal.Run({**PAIR, "solver": solver}), shoal.Run(PAIR), []

        def use(*_):
            other.step()  # another run is free
            try:
                said.append(run.time)
            except shoal.SolverError as error:
                said.append(str(error))

        before = signal.signal(signal.SIGALRM, use)
        signal.setitimer(signal.ITIMER_REAL, 0.05)
        run.step()
        signal.signal(signal.SIGALRM, before)
        self.assertIn("a signal handler cannot use a run between two of its events", said[0])
        self.assertEqual((run.time, other.time), (run.interval, other.interval))

    def test_a_time_outside_of_the_case_is_refused_before_the_first_event(self):
        run = shoal.Run(PAIR)
        for time in (run.end + 2 * run.interval, -1):
            for progress in (False, lambda time, end: None):
                with self.assertRaises(shoal.CaseError):
                    run.advance(time, progress)
                self.assertEqual(run.time, 0)

    def test_a_bar_is_one_line_as_wide_as_the_terminal(self):
        code = ("import sys; sys.path.insert(0, sys.argv[1]); import shoal\n"
                f"run = shoal.Run({PAIR!r}); run.advance(0.1); run.advance(run.end, progress=True)\n")
        said = subprocess.run([sys.executable, "-c", code, os.path.dirname(os.path.dirname(shoal.__file__))], check=True,
                              capture_output=True, env={**os.environ, "COLUMNS": "60"}).stderr.decode()
        self.assertEqual((said.count("\n"), said[-1]), (1, "\n"))
        self.assertEqual({len(line) for line in said.strip("\n\r").split("\r")}, {59})
        self.assertIn("  0 % t = 0.1 of 0.2 s", said)
        self.assertIn("100 % t = 0.2 of 0.2 s", said)


class Programs(unittest.TestCase):
    """What the program does for the module."""

    def test_errors_along_a_sweep_have_the_swept_values(self):
        case = {"name": "swept", "time": {"end": 0.2, "shedding_interval": 0.1}, "error": {"keys": ["nodes"], "of": "speed"},
                "fish": [{"name": "a", **SMALL, "nodes": 9}]}
        axes = [{"key": "fish[*].body.modulus", "values": [1e6, 2e6]}, {"key": "fluid.velocity", "values": [[0, 0], [0.1, 0]]}]
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = shoal.error(case, "speed", against="first", assignments={"sweep": axes}, overwrite=True)
        self.assertEqual([one.quantity for one in found], ["speed"] * 4 + ["ratio_speed"] * 4 + ["change_speed"] * 4)
        places = [{"fish[*].body.modulus": modulus, "fluid.velocity": velocity} for modulus in (1e6, 2e6)
                  for velocity in ("[0, 0]", "[0.1, 0]")]
        self.assertEqual([one.at for one in found], 3 * places)
        self.assertEqual(float(found[0]), found[0].value)
        self.assertAlmostEqual(found[6].value, found[2].value / found[0].value, delta=1e-7)
        self.assertIn("speed of a, fish[*].body.modulus 2e+06, fluid.velocity [0.1, 0]: ", str(found[3]))

    def test_a_case_is_checked(self):
        good = shoal.check(PAIR)
        self.assertIn("2 fish", good.summary)
        self.assertTrue(any("use at least 14 nodes" in text for text in good.warnings), good.warnings)
        with self.assertRaisesRegex(shoal.CaseError, "(?s)did you mean 'amplitude'.*nodes"):
            shoal.check({**PAIR, "fish": [{"wave": {"amplitud": 1}, "nodes": 2}]})
        with self.assertRaisesRegex(shoal.FileError, "none.yaml"):
            shoal.check("none.yaml")

    def test_a_steady_state_has_its_stability(self):
        case = {"name": "slow", "time": PAIR["time"], "fish": [{"name": "a", **SMALL}]}
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            steady = shoal.steady(case)
        self.assertTrue(any(issubclass(one.category, shoal.CaseWarning) for one in said))
        self.assertEqual((steady.path, steady.names), ("slow.nc", ["a"]))
        self.assertTrue(0.7 < steady.speed[0] < 0.9, steady)
        self.assertTrue(steady.is_stable)
        self.assertAlmostEqual(float(steady.growth), np.log(abs(steady.multipliers[0])) * 1.0, 4)
        with steady.open() as data:
            self.assertEqual(float(data["steady_speed"][0]), steady.speed[0])
        values = steady.to_xarray()
        self.assertEqual(float(values["speed"].sel(fish="a")), steady.speed[0])
        np.testing.assert_array_equal(values["multiplier"], steady.multipliers)
        self.assertTrue(0 < values["multiplier_error"][0] < 0.05)
        with self.assertRaisesRegex(shoal.FileError, "slow.nc"):
            shoal.steady(case)
        self.assertIn("cost_of_transport", dir(steady))
        with self.assertRaisesRegex(AttributeError, "'cost' is none of .*cost_of_transport"):
            steady.cost

    def test_a_branch_is_a_dataset_in_its_order(self):
        plate = {"nodes": 4, "sheet_points": 13, "force": "pressure", "pressure": {"span": "infinite", "suction_limit": 0},
                 "drag": {"skin": "laminar"}, "start": {"speed": 3.8}, "wave": {"amplitude": 0, "frequency": 0},
                 "body": {"profile": "uniform", "thickness": 0.05, "depth": 1, "density": 20, "modulus": 1e6},
                 "motion": {"prescribed": "all", "surge": "free", "heave": 0.15, "frequency": 1}}
        case = {"format": 1, "name": "plate", "time": {"end": 5, "shedding_interval": 0.05}, "wake": {"lifetime": 3, "smoothing": 0.2},
                "fluid": {"density": 1, "viscosity": 2e-3}, "steady": {"tolerance": 1e-3}, "fish": [{"name": "plate", **plate}]}
        key = "fish[*].motion.heave"
        found = shoal.branch(case, key, 0.15, 0.14)
        heave = found["motion_heave"].values
        self.assertEqual((heave[0], heave[-1]), (0.15, 0.14))
        self.assertTrue((np.diff(heave) < 0).all() and (np.diff(found["arclength"]) > 0).all(), found)
        self.assertTrue((found["steady_multiplier"] < 1).all() and (np.diff(found["steady_speed"][:, 0]) < 0).all(), found)
        state = shoal.steady(case, {key: 0.14}, overwrite=True)
        self.assertLess(abs(float(found["steady_speed"][-1, 0]) / state.speed[0] - 1), 2e-3)
        self.assertEqual(found.attrs["path"], os.path.join("plate-branch", "study.nc"))
        with self.assertRaisesRegex(shoal.FileError, "overwrite|--force"):
            shoal.branch(case, key, 0.15, 0.14)

    def test_a_threshold_has_a_bar(self):
        flag, key = str(ROOT / "cases/flag.yaml"), "fish[*].body.modulus"
        coarse = {"fish[*].nodes": 9, "time.shedding_interval": 0.05, "time.output_interval": 0.1}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            found = shoal.threshold(flag, key, 5e4, 1e5, coarse, path="flutter")
            self.assertEqual((found.kind, found.unstable, found.key), ("flutter", "below", key))
            self.assertAlmostEqual(found.bar, found.by_secant + found.by_state + found.by_interval + found.by_bodies, delta=1e-3 * found.bar)
            self.assertTrue(5e4 < float(found) < 1e5 and found.by_error == 0 < found.by_secant < 10, found)
            for side in (-1, 1):
                state = shoal.steady(flag, {**coarse, key: found.value + side * 3 * found.by_secant}, overwrite=True)
                self.assertEqual(state.is_stable, side > 0)
            self.assertRegex(str(found), r"^fish\[\*\]\.body\.modulus = \d+.* \N{PLUS-MINUS SIGN} .*: unstable below it \(flutter\)$")
            with self.assertRaisesRegex(shoal.SolverError, "stable at both; .* steady states were found"):
                shoal.threshold(flag, key, 9.5e4, 1e5, coarse, path="none")
            with self.assertRaisesRegex(shoal.CaseError, "two different numbers"):
                shoal.threshold(flag, key, 1e5, 1e5)

    def test_a_study_is_a_dataset(self):
        case = {**PAIR, "name": "swept", "sweep": [{"key": "fish[0].wave.frequency", "values": [0.9, 1.1]}]}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            data = shoal.study(case, processes=1)
        np.testing.assert_array_equal(data["fish0_wave_frequency"], [0.9, 1.1])
        self.assertEqual(data["fish0_wave_frequency"].dims, ("member",))
        self.assertIn("fish0_wave_frequency", data.coords)
        self.assertEqual((data["speed"].dims, list(data["fish"].values)), (("member", "fish"), ["a", "b"]))
        self.assertEqual(data.attrs["path"], "swept-study/study.nc")
        with self.assertRaisesRegex(shoal.CaseError, "processes is an integer from 1"):
            shoal.study(case, processes=0)

    def test_every_command_has_a_function(self):
        case = {**PAIR, "name": "commands"}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            path = shoal.run(case, path="commands.nc")
            with shoal.open(path) as data:
                end = float(data["time"][-1])
            with self.assertRaisesRegex(shoal.FileError, "commands.nc is complete, and has no checkpoint"):
                shoal.resume(path)
            shoal.run(case, {"time.checkpoint_interval": end}, path="kept.nc")
            self.assertEqual(shoal.resume("kept.nc", end=2 * end), "kept.nc")
            with shoal.open("kept.nc") as data:
                self.assertAlmostEqual(float(data["time"][-1]), 2 * end)

            water = shoal.field(path, at=end, grid=(12, 7), box=(-1, -1, 3, 1))
            self.assertEqual(dict(water.sizes)["x"], 12)
            with self.assertRaisesRegex(shoal.FileError, "overwrite=True"):
                shoal.field(path)
            self.assertTrue(os.listdir(shoal.export(path, "vtk")))
            self.assertGreater(os.path.getsize(shoal.animate(path, "commands.gif")), 1000)

            swept = shoal.study(case, sweep={"fish[0].wave.frequency": np.array([0.9, 1.1])}, processes=1)
            os.remove(swept.attrs["path"])
            again = shoal.gather(os.path.dirname(swept.attrs["path"]))
            np.testing.assert_array_equal(again["speed"], swept["speed"])
            self.assertNotIn("ratio_speed", swept)
            over = shoal.study(case, sweep={"fish[0].wave.frequency": [0.9, 1.1]}, relative_to=1.1, path="over", processes=1)
            np.testing.assert_array_equal(over["ratio_speed"], over["speed"] / over["speed"][1])
            with self.assertRaisesRegex(shoal.CaseError, "relative_to: 2.0 is neither `first` nor a value"):
                shoal.study(case, sweep={"fish[0].wave.frequency": [0.9, 1.1]}, relative_to=2.0, path="none")
            with self.assertRaisesRegex(shoal.CaseError, "relative_to is of the argument sweep"):
                shoal.study(case, relative_to="first")
            with self.assertRaisesRegex(TypeError, "sweep is a dict"):
                shoal.study(case, sweep=["fish[0].nodes"])
            compared = shoal.compare({**PAIR, "time": {"end": 0.02, "shedding_interval": 0.01}}, ["ida2", "ida3"], rtol=[1e-3, 1e-4])
            self.assertIn("speed", compared)

        found = {key["path"] for key in shoal.keys("smoothing")}
        self.assertTrue({"wake.smoothing", "sheet.smoothing"} <= found < {key["path"] for key in shoal.keys()})
        self.assertIn("speed", {variable["name"] for variable in shoal.keys("speed", output=True)})
        self.assertEqual(dir(shoal.plot), ["field", "forces", "gait", "modes", "pressure", "school", "study", "swim", "time"])
        self.assertFalse(hasattr(shoal, "simulate"))
        for name in dir(shoal):
            self.assertTrue(getattr(shoal, name).__doc__ or name == "__version__", name)

    def test_a_sweep_is_a_grid(self):
        sweep = [{"keys": ["fish[*].body.modulus", "fish[*].nodes"], "values": [[1e6, 7], [1e5, 8]]},
                 {"key": "fish[1].wave.phase", "values": [0, 30, 60]}]
        case = {**PAIR, "name": "plane", "time": {"end": 0.02, "shedding_interval": 0.01}, "sweep": sweep}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            data = shoal.study(case, processes=1)
        self.assertLessEqual({"body_modulus", "nodes", "fish1_wave_phase"}, {*data.coords})
        plane = shoal.grid(data)
        self.assertEqual(plane["speed"].dims, ("body_modulus", "fish1_wave_phase", "fish"))
        np.testing.assert_array_equal(plane["body_modulus"], [1e6, 1e5])  # in the order of the case
        self.assertEqual(plane["nodes"].dims, ("body_modulus",))
        self.assertEqual(plane["nose"].dims[-1], "xy")
        for m in range(6):
            at = {key: data[key].values[m] for key in ("body_modulus", "fish1_wave_phase")}
            np.testing.assert_array_equal(plane["speed"].sel(at), data["speed"][m])
            self.assertEqual(plane["member"].sel(at), m)
        with self.assertRaisesRegex(shoal.CaseError, "the 5 members are no full grid of body_modulus, fish1_wave_phase"):
            shoal.grid(data.isel(member=slice(5)))
        with self.assertRaisesRegex(shoal.CaseError, "no swept keys"):
            shoal.grid(data.drop_vars(["body_modulus", "nodes", "fish1_wave_phase"]))

    def test_one_and_many_points_have_the_same_dimensions(self):
        error = {"of": "speed", "keys": {"rtol": [1e-3, 1e-4]}}
        case = {**PAIR, "name": "points", "time": {"end": 0.02, "shedding_interval": 0.01}, "error": error}
        sweep = {"sweep": [{"key": "fish[*].body.modulus", "values": [1e5, 1e6]}]}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            one, many = (shoal.study(these, processes=1, path=f"of-{n}")
                         for n, these in ((1, case), (2, {**case, **sweep})))
        for name in ("stated_speed", "bar_speed", "part_speed", "key_value", "key_levels", "point_member"):
            self.assertEqual(one[name].dims, many[name].dims, name)
        self.assertEqual((one.sizes["point"], many.sizes["point"]), (1, 2))
        np.testing.assert_array_equal(many["body_modulus"], [1e5, 1e6])
        self.assertEqual(many["body_modulus"].dims, ("point",))
        self.assertEqual(many["bar_speed"].dims, ("point", "fish"))
        self.assertEqual(shoal.grid(many)["stated_speed"].dims, ("body_modulus", "fish"))
        self.assertEqual(one["stated_speed"][0, 0], one["speed"][int(one["point_member"][0]), 0])

    def test_an_error_is_the_number_of_the_program(self):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            lift, = shoal.error(ROOT / "cases/foil_static.yaml", "steady_lift", path="budget", models=True,
                                assignments={"solver.rtol": 1e-5})
        with open("budget/error.csv") as file:
            total = next(line for line in file if ",sum," in line).split(",")
        self.assertEqual((lift.fish, lift.quantity, lift.unit), ("foil", "steady_lift", "N"))
        self.assertEqual((lift.value, lift.error), (float(total[3]), float(total[7])))
        self.assertTrue(1e-6 < lift.error / lift.value < 1e-2, lift)
        self.assertRegex(str(lift), r"^steady_lift of foil: 0\.\d+ ± 0\.0+[1-9]\d N \(flagged\); other models: 0\.\d+ to 0\.\d+$")
        self.assertTrue(lift.models[0] < lift.value - lift.error, lift)  # less lift with a finite span
        self.assertTrue(lift.flags and "noise" not in " ".join(lift.flags), lift.flags)
        matter, = shoal.error(ROOT / "cases/foil_static.yaml", "steady_lift", path="matter",
                              sensitivity=["body.modulus", "fluid.density"])
        (stiff, of_stiff), (dense, of_dense) = (matter.sensitivity[key] for key in ("fish.body.modulus", "fluid.density"))
        self.assertLess(abs(stiff + dense - 1), of_stiff + of_dense)  # the shape depends on their ratio
        self.assertTrue(np.isnan(matter.error) and "fluid.density +0.75" in str(matter), matter)
        unsure, = shoal.error(ROOT / "cases/foil_static.yaml", "steady_lift", path="matter", uncertain={"body.modulus": 0.1},
                              overwrite=True)
        self.assertLess(abs(unsure.error / (0.1 * stiff * unsure.value) - 1), 0.01)  # error.csv has three digits
        for wrong in {"sensitivity": []}, {"sensitivity": "smoothing"}, {"uncertain": {"body.modulus": -1}}:
            with self.assertRaises(shoal.CaseError):
                shoal.error(ROOT / "cases/foil_static.yaml", "steady_lift", path="wrong", **wrong)
        with self.assertRaisesRegex(shoal.FileError, "start none.nc: cannot be read"):
            shoal.error(ROOT / "cases/foil_static.yaml", "steady_lift", path="wrong", start="none.nc")
        with self.assertRaisesRegex(shoal.CaseError, "nothing_known"):
            shoal.error(ROOT / "cases/foil_static.yaml", "nothing_known", path="budget", overwrite=True)

    def test_a_result_is_a_page(self):
        page = shoal.view(shoal.run(PAIR, path="paged.nc"))
        self.assertEqual(page.path, "paged.html")
        self.assertRegex(page._repr_html_(), 'style="width: 100%; height: \\d+px; border: 0"')  # properties of CSS
        with self.assertRaisesRegex(shoal.FileError, "paged.html"):
            shoal.view("paged.nc", overwrite=False)

    def test_the_includes_of_a_dict_are_found(self):
        pathlib.Path("included.yaml").write_text(json.dumps({"format": 1, **PAIR}))
        self.assertIn("2 fish", shoal.check({"include": "included.yaml"}).summary)

    def test_a_run_is_a_dataset(self):
        run = shoal.Run(PAIR)
        run.step(2)
        data = run.to_xarray()
        self.assertEqual((list(data["fish"].values), data["x"].dims), (["a", "b"], ("fish", "node", "xy")))
        self.assertEqual(data["com"].attrs["units"], "m")
        np.testing.assert_array_equal(data["com"], run["com"])


class Results(unittest.TestCase):
    def test_a_result_is_that_of_the_program(self):
        path = shoal.run(PAIR, path="by_python.nc")
        self.assertEqual(path, "by_python.nc")
        pathlib.Path("by_program.yaml").write_text(json.dumps({"format": 1, "name": "run", **PAIR}))
        subprocess.run([os.environ["SHOAL"], "run", "-q", "by_program.yaml", "-o", "by_program.nc"], check=True)
        subprocess.run([ROOT / "tests/run/same_result.py", "by_python.nc", "by_program.nc"], check=True)
        notes = []
        for path in "by_python.nc", "by_program.nc":
            with shoal.open(path) as data:
                notes.append([data.attrs.get("warnings"), data.attrs["closest_approach"]])
        self.assertEqual(*notes)

    def test_checkpoints_of_a_case_are_those_of_the_program(self):
        case = {"format": 1, "name": "kept", **PAIR, "time": {**PAIR["time"], "checkpoint_interval": 0.06}}
        pathlib.Path("kept.yaml").write_text(json.dumps(case))
        shoal.run(case, path="kept_python.nc")
        subprocess.run([os.environ["SHOAL"], "run", "-q", "kept.yaml", "-o", "kept_program.nc"], check=True)
        subprocess.run([ROOT / "tests/run/same_result.py", "kept_python.nc", "kept_program.nc"], check=True)
        alone = shoal.Run(case)
        alone.advance(alone.end)
        with shoal.open("kept_program.nc") as data:
            self.assertEqual(data["x"].values[-1].tobytes(), alone["x"].tobytes())

    def test_the_program_goes_on_from_a_checkpoint(self):
        run, whole = shoal.Run(PAIR), shoal.Run(PAIR)
        with self.assertRaisesRegex(shoal.CaseError, "needs a result file"):
            run.checkpoint()
        for one, path in (run, "stopped.nc"), (whole, "whole.nc"):
            one.write(path, overwrite=True)
            one.advance(0.1)
            one.checkpoint()
        run.write_end()
        whole.advance(whole.end)
        whole.write_end()
        subprocess.run([os.environ["SHOAL"], "resume", "-q", "stopped.ckpt"], check=True)
        subprocess.run([ROOT / "tests/run/same_result.py", "stopped.nc", "whole.nc"], check=True)

    def test_of_threads_with_the_same_result_one_writes_it(self):
        case = {**PAIR, "time": {**PAIR["time"], "end": 2}}
        for overwrite in False, True:
            ended = []

            def swim():
                try:
                    ended.append(shoal.run(case, path="shared.nc", overwrite=overwrite))
                except shoal.FileError as error:
                    ended.append(str(error))

            threads = [threading.Thread(target=swim) for _ in range(3)]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            # one that comes after another has ended may write it again where it was told to
            self.assertIn("shared.nc", ended)
            for end in ended:
                self.assertRegex(end, "^shared.nc$|another run writes this result|exists")
            with shoal.open("shared.nc") as data:
                self.assertEqual((data.attrs["run_status"], data["time"].size), ("complete", 101))
            self.assertFalse(os.path.exists("shared.nc.part"))

    def test_the_end_of_a_fork_leaves_the_result_alone(self):
        run = shoal.Run(PAIR)
        run.write("forked.nc")
        run.step()
        child = os.fork()
        if child == 0:
            del run
            gc.collect()
            os._exit(0)
        self.assertEqual(os.waitpid(child, 0)[1], 0)
        with shoal.Run(PAIR) as other, self.assertRaisesRegex(shoal.FileError, "another run writes this result"):
            other.write("forked.nc", overwrite=True)
        run.advance(run.end)
        run.write_end()
        with shoal.open("forked.nc") as data:
            self.assertEqual((data.attrs["run_status"], data["time"].size), ("complete", 11))

    def test_the_path_is_that_of_the_case(self):
        self.assertEqual(shoal.run({**PAIR, "name": "named"}), "named.nc")
        self.assertEqual(shoal.run(PAIR, {"output.file": "filed.nc"}), "filed.nc")
        with self.assertRaisesRegex(shoal.FileError, "filed.nc"):
            shoal.run(PAIR, {"output.file": "filed.nc"})

    def test_a_result_opens_with_names(self):
        data = shoal.open(shoal.run(PAIR, path="names.nc"))
        self.assertEqual(list(data["fish"].values), ["a", "b"])
        np.testing.assert_allclose(data["com"].sel(fish="b", xy="y")[0], 0.7)
        self.assertEqual(data["wake_x"].dims, ("wake", "xy"))
        self.assertEqual(data.sizes["wake"], int(data["wake_count"].sum()))
        self.assertTrue(np.isfinite(data["wake_x"]).all() and (data["wake_age"] >= 0).all())
        last = data.isel(wake=data["wake_time"].values == data["time"].values[-1])
        self.assertEqual(int((last["wake_fish"] == "a").sum()), int(data["wake_count"].sel(fish="a")[-1]))
        with self.assertRaisesRegex(shoal.FileError, "no such file"):
            shoal.open("none.nc")
        pathlib.Path("text.nc").write_text("no netcdf")
        with self.assertRaisesRegex(shoal.FileError, "text.nc"):
            shoal.open("text.nc")

    def test_periods_are_cut(self):
        data = shoal.open(shoal.run(PAIR, {"fish[*].wave.frequency": 12.5}, path="beats.nc"))
        beats = shoal.periods(data, "a")
        self.assertEqual((beats.sizes["period"], beats.sizes["phase"]), (2, 4))
        np.testing.assert_array_equal(beats["com"].values.reshape(8, 2, 2), data["com"].values[:8])
        np.testing.assert_allclose(beats["time"][1], [0.08, 0.1, 0.12, 0.14])
        with self.assertRaisesRegex(shoal.CaseError, "rows"):
            shoal.periods(data.isel(time=slice(0, None, 3)), "a")


def follower(**arguments):
    return shoal.SwimEnv(PAIR, fish="b", actions=("bias", "amplitude", "frequency"), act_every=0.04,
                         observations=("velocity", "heading", "curvature", "muscle", "flow", "goal", "closing", "neighbours",
                                       "action"),
                         goal=("a", (0.2, 0.7)), **arguments)


class Interpreters(unittest.TestCase):
    def test_an_interpreter_without_numpy_is_told_which_one_has_it(self):
        # without the folders of Debian's packages
        code = (f"import sys; sys.path = [p for p in sys.path if not p.endswith('packages')]\n"
                f"sys.path.append({os.path.dirname(os.path.dirname(shoal.__file__))!r})\nimport shoal\n")
        said = subprocess.run([sys.executable, "-S", "-c", code], capture_output=True, text=True, check=False)
        self.assertEqual(said.returncode, 1)
        last = said.stderr.strip().splitlines()[-1]
        self.assertRegex(last, f"^ImportError: shoal needs numpy, which {sys.executable} does not have; /\\S+ has it$")
        self.assertNotIn("During handling", said.stderr)
        other = last.split()[-3]
        subprocess.run([other, "-c", "import numpy"], check=True)


class Environments(unittest.TestCase):
    def rules_of_gymnasium(self, env):
        """What gymnasium.utils.env_checker asks of an environment."""
        observation, info = env.reset(seed=3)
        self.assertIsInstance(info, dict)
        over = False
        while not over:
            space = env.observation_space
            self.assertTrue(space.contains(observation), observation)
            self.assertEqual(observation.dtype, space.dtype)
            action = env.action_space.sample()
            self.assertTrue(env.action_space.contains(action))
            observation, reward, terminated, truncated, info = env.step(action)
            self.assertIsInstance(reward, float)
            self.assertIs(type(terminated), bool)
            self.assertIs(type(truncated), bool)
            self.assertTrue(np.isfinite(reward))
            over = terminated or truncated
        return observation

    def test_the_spaces_have_bounds(self):
        env = follower()
        for space in env.action_space, env.observation_space:
            self.assertTrue(np.all(np.isfinite(space.low)) and np.all(space.low < space.high))
        self.assertEqual(env.observation_space.shape, (2 + 2 + 7 + 7 + 6 + 3 + 2 + 4 + 3,))
        self.assertEqual(env.action_space.shape, (3,))

    def test_a_hundred_episodes_keep_the_rules_of_gymnasium(self):
        env = follower(reward={"speed": 1, "cost_of_transport": 0.1, "course": 0.1, "goal": 1})
        for episode in range(100):
            self.rules_of_gymnasium(env)
            self.assertTrue(env.run.at_end)

    def test_seed_and_actions_say_everything(self):
        env = follower(vary={"fish[1].start.heading": (170, 190)})
        ends = []
        for seed in 1, 1, 2:
            env.reset(seed=seed)
            for action in ([0.2, 0.4, 1.0], [-0.2, 0.5, 1.2]):
                ends.append(env.step(action)[0].tobytes())
        self.assertEqual(ends[0:2], ends[2:4])
        self.assertNotEqual(ends[2:4], ends[4:6])
        env.reset(seed=1, options={"assignments": {"time.end": 0.1}})
        self.assertAlmostEqual(env.run.end, 0.1)

    def test_a_reset_is_the_beginning_again(self):
        env = follower()
        first, _ = env.reset()
        seen = [env.step([0.1, 0.4, 1.1])[0] for _ in range(3)]
        again, _ = env.reset()
        np.testing.assert_array_equal(first, again)
        for want in seen:
            np.testing.assert_array_equal(env.step([0.1, 0.4, 1.1])[0], want)

    def test_what_is_seen_is_in_the_frame_of_the_fish(self):
        env = shoal.SwimEnv(PAIR, fish=1, observations=("goal", "neighbours"), goal=(0.2, 1.7))
        seen, _ = env.reset()
        com = env.run["com"]
        # the heading is 180 degrees: forwards is -x, left is -y
        away = [-(0.2 - com[1, 0]), -(1.7 - com[1, 1])]
        np.testing.assert_allclose(seen[:3], [*away, np.hypot(*away)], rtol=1e-6)
        np.testing.assert_allclose(seen[3:5], -(com[0] - com[1]), rtol=1e-6)

    def test_neighbours_are_seen_ahead_and_to_the_left(self):
        # towards 60 degrees: ahead is (cos, sin), left is (-sin, cos)
        env = shoal.SwimEnv(PAIR, {"defaults.fish.start.heading": 60, "fish[0].start.position": [2.5, 1]}, fish=1,
                            observations=("neighbours",))
        seen, _ = env.reset()
        ahead, left = np.array([0.5, 3**0.5 / 2]), np.array([-(3**0.5) / 2, 0.5])
        for first, name in (0, "com"), (2, "com_velocity"):
            of = env.run[name][0] - env.run[name][1]
            np.testing.assert_allclose(seen[first : first + 2], [of @ ahead, of @ left], rtol=1e-5, atol=1e-6)
        self.assertTrue(np.all(np.abs(seen[:2]) > 0.1), seen)

    def test_sight_ends_at_the_range_behind_and_at_bodies(self):
        # the eye is at (0, 0) and looks along -x, the heading of all fish; their bodies are lines of 4 edges along +x
        case = {"time": {"end": 1, "shedding_interval": 0.02}, "defaults": {"fish": {"nodes": 5}},
                "fish": [{"name": name, "start": {"position": position}} for name, position in
                         (("eye", [0, 0]), ("near", [-2.5, 0.5]), ("far", [-6, 0.5]), ("behind", [3, 0.2]))]}

        def seen(position=None, **vision):
            moved = {"fish[1].start.position": position} if position else None
            env = shoal.SwimEnv(case, moved, fish="eye", observations=("sight",), vision=vision)
            first = env.reset(seed=4)[0].reshape(3, 5)
            np.testing.assert_array_equal(first, env.reset(seed=4)[0].reshape(3, 5))
            return first, env.run["com"]

        first, com = seen(range=10, angle=360)
        np.testing.assert_array_equal(first[:, 0], 1)
        # left of a fish along -x is -y
        np.testing.assert_allclose(first[:, 1:3], -com[1:], rtol=1e-6)
        np.testing.assert_allclose(first[:, 3:], [[1, 0]] * 3, atol=1e-6)
        # the tail of the near fish is 1.5 lengths from the eye, and 18.4 degrees off its heading; that of the far one 5
        flags = lambda *a, **b: seen(*a, **b)[0][:, 0].tolist()  # noqa: E731
        self.assertEqual(flags(range=1.5, angle=360), [0, 0, 0])
        self.assertEqual(flags(range=1.6, angle=360), [1, 0, 0])
        self.assertEqual(flags(range=5.1, angle=360), [1, 1, 1])
        self.assertEqual(flags(range=10, angle=300), [1, 1, 0])
        # the nose of the near fish is 11.3 degrees off, that of the far one 4.8
        self.assertEqual(flags(range=10, angle=21), [0, 1, 0])
        # a body across the line of sight hides the far fish, unless bodies are glass; what is seen of others stays
        across = [-1.2, 0.07]
        self.assertEqual(flags(across, range=10, angle=360, occlusion=False), [1, 1, 1])
        hidden, _ = seen(across, range=10, angle=360)
        self.assertEqual(hidden[:, 0].tolist(), [1, 0, 1])
        np.testing.assert_array_equal(hidden[1], 0)

    def test_the_noise_of_sight_has_the_size_that_was_asked_for(self):
        env = shoal.SwimEnv(PAIR, fish=1, observations=("sight",), vision={"range": 50, "angle": 360, "noise": (0.1, 0.03)})
        _, x, y, *_ = np.array([env.reset(seed=seed)[0] for seed in range(400)]).T
        way = env.run["com"][0] - env.run["x"][1, 0]
        distance, direction = np.hypot(x, y) / np.hypot(*way), np.arctan2(y, x) - np.arctan2(-way[1], -way[0])
        direction = (direction + np.pi) % (2 * np.pi) - np.pi
        # standard errors of a mean are 1/20, of a deviation 1/28, in units of the deviation
        for values, mean, deviation in (distance, 1, 0.1), (direction, 0, 0.03):
            self.assertLess(abs(values.mean() - mean), 0.2 * deviation)
            self.assertLess(abs(values.std() / deviation - 1), 0.15)

    def test_an_eye_that_cannot_be_is_refused(self):
        for wrong in {"range": 0}, {"angle": 361}, {"noise": (0.1, -1)}, {"noise": 0.1}, {"colour": 1}, {"occlusion": 1}:
            with self.assertRaisesRegex(shoal.CaseError, "vision"):
                shoal.SwimEnv(PAIR, fish=1, observations=("sight",), vision=wrong)
        with self.assertRaisesRegex(shoal.CaseError, "sight"):
            shoal.SwimEnv(PAIR, fish=1, vision={"range": 3})

    def test_the_pressure_on_both_sides_is_that_at_the_sensors_of_the_case(self):
        sensors = {"fish[1].force": "pressure", "fish[1].body.depth": 0.25, "fish[1].sensors": [0.1, 0.6]}
        env = shoal.SwimEnv(PAIR, sensors, fish=1, observations=("pressure",), act_every=0.04)
        env.reset(seed=1)
        seen = env.step(env.action_space.sample())[0]
        both = [env.run[f"sensor_pressure_{side}"][1] for side in ("left", "right")]
        of_fish = float(env.run["fluid_density"]) * float(env.run["body_length"][1]) ** 2
        np.testing.assert_allclose(seen, np.transpose(both).ravel() / of_fish, rtol=1e-6)
        self.assertTrue(np.all(seen != 0))
        with self.assertRaisesRegex(shoal.CaseError, "needs sensors in the case"):
            shoal.SwimEnv(PAIR, fish=1, observations=("pressure",))

    def test_closing_is_how_fast_the_goal_comes_nearer(self):
        env = shoal.SwimEnv(PAIR, {"defaults.fish.start.speed": 0.5}, fish=1, observations=("closing",), act_every=0.08,
                            goal=("a", (0.2, 0.7)))
        np.testing.assert_array_equal(env.reset()[0], [0, 0])
        swimmer = env.swimmer
        before, time = swimmer.to_goal(), env.run.time
        seen = env.step([0.2])[0]
        np.testing.assert_allclose(seen, swimmer._own(*(before - swimmer.to_goal()) / (env.run.time - time)), rtol=1e-5)
        self.assertGreater(np.abs(seen).max(), 1e-3)
        with self.assertRaisesRegex(shoal.CaseError, "'closing' needs a goal"):
            shoal.SwimEnv(PAIR, observations=("closing",))

    def test_rewards_are_what_they_say(self):
        env = shoal.SwimEnv(PAIR, {"defaults.fish.start.speed": 0.5}, act_every=0.2, goal=(-5, 0.7), fish=1,
                            reward=lambda swimmer: 7)
        env.reset()
        before, swimmer = np.array(env.swimmer.com), env.swimmer
        self.assertEqual(env.step([0.0])[1], 7)
        way = swimmer.com - before
        self.assertAlmostEqual(swimmer._earn_speed(), np.hypot(*way) / 0.2, 12)
        self.assertAlmostEqual(swimmer._EARNED["goal"](swimmer), -np.hypot(*([-5, 0.7] - swimmer.com)), 12)
        self.assertLess(abs(swimmer._earn_course()), 0.05)
        work = float(env.run["actuation_work"][1])
        self.assertAlmostEqual(swimmer._earn_cost(), -work / (swimmer.mass * np.hypot(*way)), 12)

    def test_an_episode_ends_when_the_fish_is_lost_or_the_solver_fails(self):
        env = shoal.SwimEnv(PAIR, goal=(9, 9), far=3)
        env.reset()
        self.assertEqual(env.step([0.0])[2:4], (True, False))
        env = shoal.SwimEnv(PAIR, {"solver.max_steps": 1})
        env.reset()
        _, reward, terminated, truncated, info = env.step([0.0])
        self.assertEqual((reward, terminated, truncated), (0.0, True, False))
        self.assertIn("max_steps", info["failure"])
        env.reset()

    def test_what_is_not_known_is_refused(self):
        for wrong in {"actions": ("tail",)}, {"observations": ("smell",)}, {"reward": {"joy": 1}}, {"reward": {"goal": 1}}:
            with self.assertRaisesRegex(shoal.CaseError, "is none of|needs a goal"):
                shoal.SwimEnv(PAIR, **wrong)
        env = shoal.SwimEnv(PAIR)
        env.reset()
        with self.assertRaisesRegex(shoal.CaseError, "an action is 1 numbers"):
            env.step([0.1, 0.2])
        with self.assertRaisesRegex(shoal.CaseError, "an action is 1 numbers"):
            env.step([np.nan])

    def test_actions_outside_the_box_are_refused(self):
        env = shoal.SwimEnv(PAIR, actions={"bias": (-0.3, 0.3), "frequency": (0.8, 1.2)})
        with self.assertRaisesRegex(shoal.CaseError, r"call reset\(\) first"):
            env.step([0, 1])
        env.reset()
        before = env.run["x"].tobytes()
        for wrong in [0.31, 1], [0, 0.7], [0, np.inf], [0, 1, 1], [], "ab":
            with self.assertRaisesRegex((shoal.CaseError, ValueError), "bias -0.3 to 0.3|could not convert"):
                env.step(wrong)
        self.assertEqual((env.run.time, env.run["x"].tobytes()), (0, before))
        env.step(env.action_space.high)
        env.step(env.action_space.low)

    def test_actions_fall_on_events(self):
        self.assertEqual(shoal.SwimEnv(PAIR, act_every=0.06)._n_steps, 3)
        with self.assertRaisesRegex(shoal.CaseError, "act_every: 0.05 s is no multiple .* 0.02 s: take 0.04 or 0.06 s"):
            shoal.SwimEnv(PAIR, act_every=0.05)
        for wrong in 0, -0.02, 0.001:
            with self.assertRaisesRegex(shoal.CaseError, "no multiple"):
                shoal.SwimEnv(PAIR, act_every=wrong)

    def test_arguments_of_environments_are_checked(self):
        for wrong, text in (({"fish": "c"}, "there is no fish 'c'"), ({"goal": "here"}, "a goal is"),
                            ({"goal": ("c", (1, 1))}, "there is no fish 'c'"), ({"render_mode": "human"}, "rgb_array, html"),
                            ({"actions": {"bias": (1, 0)}}, "lower one first"), ({"vary": {"time.end": 3}}, "bounds of time.end"),
                            ({"actions": ("bais",)}, "did you mean 'bias'"), ({"goal": (1, 1), "far": -1}, "far, .* is above 0")):
            with self.assertRaisesRegex(shoal.CaseError, text):
                shoal.SwimEnv(PAIR, **wrong)
        for wrong in ({"reward": "speed"}, {"reward": 1}, {"vary": ["time.end"]}, {"vary": "time.end"}):
            with self.assertRaisesRegex(TypeError, " is a .*dict of (weights|bounds) .*, not "):
                shoal.SwimEnv(PAIR, **wrong)
        env = shoal.SwimEnv(PAIR)
        for wrong in 1, "goal":
            with self.assertRaisesRegex(TypeError, "reset: options are a dict"):
                env.reset(options=wrong)
        env.reset()
        with self.assertRaisesRegex(shoal.CaseError, "an action: a value is masked"):
            env.step(np.ma.array([0.1], mask=True))

    def test_an_environment_is_drawn(self):
        env = shoal.SwimEnv(PAIR, render_mode="rgb_array")
        env.reset()
        first = env.render()
        self.assertEqual((first.shape, first.dtype), ((324, 720, 3), np.uint8))
        env.step([0.1])
        self.assertTrue(np.any(env.render() != first) and first.min() < 100 < first.max())
        self.assertIn("<polygon", shoal.SwimEnv(PAIR, render_mode="html").render())
        self.assertIsNone(shoal.SwimEnv(PAIR).render())
        self.assertEqual(env.metadata["render_modes"], ["rgb_array", "html"])

    def test_many_environments_are_those_alone(self):
        arguments = dict(fish="b", actions=("bias", "frequency"), act_every=0.06, observations=("velocity", "neighbours"),
                         vary={"fish[1].start.heading": (170, 190)})
        many, one = shoal.SwimVectorEnv(3, PAIR, threads=2, **arguments), shoal.SwimVectorEnv(3, PAIR, threads=1, **arguments)
        alone = [shoal.SwimEnv(PAIR, **arguments) for _ in range(3)]
        observations, infos = many.reset(seed=4)
        one.reset(seed=4)
        self.assertEqual((observations.shape, observations.dtype), ((3, 6), np.float32))
        np.testing.assert_array_equal(observations, [env.reset(seed=4 + i)[0] for i, env in enumerate(alone)])
        np.testing.assert_array_equal(infos["time"], np.zeros(3))
        actions = np.array([[0.1, 1], [-0.1, 0.9], [0, 1.1]])
        for _ in range(4):
            seen, rewards, terminated, truncated, infos = many.step(actions)
            for got, want in zip(one.step(actions)[:4], (seen, rewards, terminated, truncated)):
                np.testing.assert_array_equal(got, want)
            np.testing.assert_array_equal(seen, [env.step(action)[0] for env, action in zip(alone, actions)])
        self.assertTrue(truncated.all() and rewards.dtype == float)
        # the next step begins the next episode
        seen, rewards, _, truncated, infos = many.step(actions)
        self.assertEqual((rewards.tolist(), truncated.tolist(), infos["time"].tolist()), ([0] * 3, [False] * 3, [0] * 3))
        with self.assertRaisesRegex(shoal.CaseError, "shape"):
            many.step([0.1, 1])
        self.assertEqual(many.action_space.shape, (3, 2))
        many.close()
        one.close()

    def test_a_goal_is_set_for_an_episode_or_from_now_on(self):
        env = shoal.SwimEnv(PAIR, fish="b", observations=("goal",), goal=(1, 2))

        def goal_after_reset(**options):
            env.reset(options=options)
            return env.swimmer.place().tolist()

        self.assertEqual(goal_after_reset(), [1, 2])
        self.assertEqual(goal_after_reset(goal=(3, 4)), [3, 4])
        self.assertEqual(goal_after_reset(), [1, 2])
        env.set_goal((5, 6))
        self.assertEqual(env.swimmer.place().tolist(), [5, 6])
        self.assertEqual(goal_after_reset(), [5, 6])
        for options in {"gaol": (1, 2)}, {"goal": 3}, {"goal": None}:
            with self.assertRaises(shoal.CaseError):
                env.reset(options=options)

    def test_a_goal_moves(self):
        env = shoal.SwimEnv(PAIR, observations=("goal", "closing"), goal=lambda t: (1 + 2 * t, 3), act_every=0.04)
        env.reset()
        env.step([0])
        self.assertEqual(env.swimmer.place().tolist(), [1.08, 3])
        env.set_goal(lambda t: ("b", (t, 0)))
        np.testing.assert_allclose(env.swimmer.place(), env.run["com"][1] + [0.04, 0])
        with self.assertRaisesRegex(shoal.CaseError, "a goal is"):
            env.reset(options={"goal": lambda t: "here"})

    def test_many_environments_have_goals_of_their_own(self):
        many = shoal.SwimVectorEnv(2, PAIR, threads=1, observations=("goal",), goal=(1, 2))
        many.reset(options={"goal": [(3, 4), ("b", (0, 1))]})
        self.assertEqual(many.envs[0].swimmer.place().tolist(), [3, 4])
        np.testing.assert_allclose(many.envs[1].swimmer.place(), many.envs[1].run["com"][1] + [0, 1])
        many.reset(options={"goal": [5, 6]})
        self.assertEqual([env.swimmer.place().tolist() for env in many.envs], [[5, 6]] * 2)
        many.set_goal(1, (7, 8))
        many.reset()
        self.assertEqual([env.swimmer.place().tolist() for env in many.envs], [[1, 2], [7, 8]])
        for wrong in (lambda: many.reset(options={"goal": [(1, 2)]}), lambda: many.set_goal(2, (1, 2))):
            with self.assertRaises(shoal.CaseError):
                wrong()

    def test_a_school_keeps_the_rules_of_parallel_environments(self):
        env = shoal.SchoolEnv(PAIR, actions=("bias", "frequency"), act_every=0.04)
        self.assertEqual(env.possible_agents, ["a", "b"])
        for seed in range(5):
            observations, infos = env.reset(seed=seed)
            self.assertEqual(env.agents, env.possible_agents)
            self.assertEqual(set(infos), set(env.agents))
            while env.agents:
                agents = list(env.agents)
                self.assertEqual((env.num_agents, env.max_num_agents), (2, 2))
                for name in agents:
                    self.assertIs(env.action_space(name), env.action_space(name))
                    self.assertTrue(env.observation_space(name).contains(observations[name]))
                actions = {name: env.action_space(name).sample() for name in agents}
                observations, *rest = env.step(actions)
                for part in observations, *rest:
                    self.assertEqual(set(part), set(agents))
                self.assertEqual(env.state().size, sum(env.observation_space(name).shape[0] for name in agents))
            self.assertTrue(all(rest[2].values()) and not any(rest[1].values()))

    @unittest.skipIf(importlib.util.find_spec("gymnasium"), "Gymnasium is installed")
    def test_gymnasium_and_pettingzoo_are_used_where_they_are(self):
        registers = "class Env: pass\ndef register(name, **places): print(name, *places.values())\n"
        for package, text in (("gymnasium", registers), ("gymnasium/vector", "class VectorEnv: pass"),
                              ("pettingzoo", "class ParallelEnv: pass")):
            os.makedirs(f"installed/{package}", exist_ok=True)
            pathlib.Path(f"installed/{package}/__init__.py").write_text(text)
        pathlib.Path("installed/gymnasium/spaces.py").write_text(
            "class Box:\n    def __init__(self, low, high, dtype): self.shape = low.shape\n")
        code = (f"import sys; sys.path.insert(0, {os.path.dirname(os.path.dirname(shoal.__file__))!r})\n"
                "if len(sys.argv) > 1: sys.path.insert(0, sys.argv[1])\n"
                f"import shoal; env = shoal.SwimEnv({PAIR!r}); school = shoal.SchoolEnv({PAIR!r})\n"
                "print(env.action_space.__class__.__module__, 'gymnasium' in sys.modules, 'pettingzoo' in sys.modules)\n"
                "if len(sys.argv) > 1:\n"
                "    import gymnasium, pettingzoo\n"
                "    print(isinstance(env, gymnasium.Env), isinstance(school, pettingzoo.ParallelEnv))\n")
        said = [subprocess.run([sys.executable, "-c", code, *more], check=True, capture_output=True, text=True).stdout
                for more in ([], ["installed"])]
        self.assertEqual(said, ["shoal._environments False False\n", "shoal/Swim-v0 shoal:SwimEnv shoal:SwimVectorEnv\n"
                                "gymnasium.spaces True True\nTrue True\n"])


def main():
    """Run the tests of the script that was started, and print the line of a shell test."""
    result = unittest.main(verbosity=2, exit=False).result
    n_bad = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - n_bad - len(result.skipped)} passed, {n_bad} failed, {len(result.skipped)} skipped")
    sys.exit(n_bad > 0)


if __name__ == "__main__":
    main()
