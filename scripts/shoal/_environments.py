"""Learning: the protocols of Gymnasium (SwimEnv, SwimVectorEnv) and PettingZoo (SchoolEnv)."""

from __future__ import annotations

import concurrent.futures
import contextlib
import ctypes
import importlib
import importlib.util
import math
import os
from typing import Mapping

import numpy as np

from . import _library as lib
from ._draw import picture_of, snapshot_of
from ._library import CaseError, SolverError, check, choice_of, index_of, kind, number_of, numbers_of, refuse_masked
from ._run import Run
from ._vision import Vision


def _from(module, name, otherwise):
    """A name of a module, if installed."""
    if importlib.util.find_spec(module.split(".")[0]) is None:
        return otherwise
    return getattr(importlib.import_module(module), name, otherwise)


class _Box:
    """A replacement of gymnasium.spaces.Box without Gymnasium, with the methods used here."""

    def __init__(self, low, high, dtype=np.float32):
        self.low, self.high = np.asarray(low, dtype), np.asarray(high, dtype)
        self.shape, self.dtype = self.low.shape, np.dtype(dtype)
        self._random = np.random.default_rng()

    def seed(self, seed=None):
        self._random = np.random.default_rng(seed)
        return [seed]

    def sample(self):
        return self._random.uniform(self.low, self.high).astype(self.dtype)

    def contains(self, x):
        x = np.asarray(x)
        return x.shape == self.shape and bool(np.all(x >= self.low) and np.all(x <= self.high))

    __contains__ = contains

    def __repr__(self):
        return f"Box({self.low.min(initial=0):g}, {self.high.max(initial=0):g}, {self.shape}, {self.dtype})"


_make_box = _from("gymnasium.spaces", "Box", _Box)

_KEYS = {"bias": b"control.bias", "amplitude": b"wave.amplitude", "frequency": b"wave.frequency", "heave": b"motion.heave"}
_SENSORS = ((0.5, 0.0), (0.0, 0.3), (0.0, -0.3))
_RENDER_MODES = ("rgb_array", "html")


class _Event:
    """The variables of a run at the last event, each read once, and the random numbers of what is seen of them."""

    def __init__(self, run, random):
        self.random = random
        self.begin(run)

    def begin(self, run):
        """The run is at another event, or another one."""
        self.run, self.time, self._values = run, run.time, {}

    def __call__(self, name):
        values = self._values.get(name)
        if values is None:
            values = self._values[name] = np.asarray(self.run.view(name))
        return values


class _Swimmer:
    """One controlled fish of a run: actions, observations and rewards. Observed vectors are in the frame of the fish,
    forwards and to the left, in body lengths."""

    def __init__(self, event, fish, actions, observations, reward, goal, course, sensors, vision):
        self.event, self.fish, self.vision = event, fish, Vision(vision)
        run = event.run
        self.length, self.mass = float(run["body_length"][fish]), float(run["body_mass"][fish])
        self.n_joints, self.n_fish = int(run["n_joints"][fish]), len(run["n_joints"])
        self.n_sensors, self.density = int(np.sum(np.isfinite(run["sensor_place"][fish]))), float(run["fluid_density"])
        self.others = [f for f in range(self.n_fish) if f != fish]
        frequency = float(run["frequency"][fish])
        usual = {"bias": (-0.5, 0.5), "amplitude": (0.2, 0.6), "frequency": (0.5 * frequency, 1.5 * frequency)}
        if isinstance(actions, str) or isinstance(observations, str):
            raise TypeError('actions and observations are tuples of names, ("bias",)')
        for name in actions:
            choice_of(name, list(_KEYS), "an action")
            if name not in usual and not isinstance(actions, Mapping):
                raise CaseError(f"{name} has no usual bounds: give them, actions={{{name!r}: (0.1, 0.2)}}")
        self.actions = {name: self._bounds(name, actions[name]) if isinstance(actions, Mapping) else usual[name]
                        for name in actions}
        self.observations = [choice_of(name, list(self._SEEN), "an observation") for name in observations]
        self.reward_of, self.goal, self.course = reward, self._checked_goal(goal), number_of(course, "course, degree,")
        self.sensors = numbers_of(sensors, "sensors").reshape(-1, 2)
        self._earned = []
        if not callable(reward):
            if not isinstance(reward, Mapping):
                raise TypeError(f'reward is a function, or a dict of weights {{"speed": 1.0}}, not {kind(reward)}')
            self._earned = [(number_of(weight, f"reward: {choice_of(name, list(self._EARNED), 'a reward')}"),
                             self._EARNED[name]) for name, weight in reward.items()]
        if vision is not None and "sight" not in self.observations:
            raise CaseError("vision belongs to the observation 'sight', which this environment does not have")
        for name in [*self.observations, *(() if callable(reward) else reward)]:
            if name == "pressure" and not (self.n_sensors and self.density > 0):
                raise CaseError("'pressure' needs sensors in the case, fish.sensors, and a fluid")
            if goal is None and name in ("goal", "closing"):
                raise CaseError(f"{name!r} needs a goal: (x, y), or (fish, (x, y)) for a place beside a fish")
        self._parts, first = [], 0
        for name in self.observations:
            see, bound = self._SEEN[name]
            self._parts.append((see, slice(first, first + self._size(name)), bound))
            first += self._size(name)
        self._bound = np.concatenate([np.full(part.stop - part.start, float(bound)) for _, part, bound in self._parts]
                                     or [np.empty(0)])
        low, high = np.array(list(self.actions.values()), np.float32).reshape(-1, 2).T
        self._low, self._high = low.astype(float), high.astype(float)
        self._keys = [_KEYS[name] for name in self.actions]
        self._box = list(zip(self._low.tolist(), self._high.tolist()))

    @staticmethod
    def _bounds(name, bounds):
        values = numbers_of(bounds, f"the bounds of {name}")
        if values.shape != (2,) or not np.all(np.isfinite(values)) or not values[0] < values[1]:
            raise CaseError(f"the bounds of {name} are two finite numbers, the lower one first, not {bounds!r}")
        return tuple(values)

    def _checked_goal(self, goal):
        if goal is None or callable(goal):
            return goal
        try:
            first, second = goal
            if isinstance(first, str) or np.ndim(second) == 1:
                other, offset = index_of(first, self.run.names, "goal"), numbers_of(second, "goal")
            else:
                other, offset = None, numbers_of([first, second], "goal")
            if offset.shape == (2,) and np.all(np.isfinite(offset)):
                return other, (float(offset[0]), float(offset[1]))
        except (TypeError, ValueError) as error:
            if isinstance(error, CaseError):
                raise
        raise CaseError("a goal is (x, y), m, (fish, (x, y)) for a place beside a fish, or a function of the time, s, "
                        f"with one of these as its value, not {goal!r}")

    def set_goal(self, goal):
        """Set the goal from now on."""
        if goal is None and {"goal", "closing"} & {*self.observations, *(self.reward_of if self._earned else ())}:
            raise CaseError("observations or rewards of this environment need a goal")
        self.goal = self._checked_goal(goal)

    # -- spaces

    def action_space(self):
        return _make_box(self._low.astype(np.float32), self._high.astype(np.float32), dtype=np.float32)

    def observation_space(self):
        bound = self._bound.astype(np.float32)
        return _make_box(-bound, bound, dtype=np.float32)

    def _size(self, name):
        sizes = {"curvature": self.n_joints, "muscle": self.n_joints, "flow": self.sensors.size,
                 "pressure": 2 * self.n_sensors, "goal": 3,
                 "neighbours": 4 * (self.n_fish - 1), "sight": 5 * (self.n_fish - 1), "action": len(self.actions)}
        return sizes.get(name, 2)

    # -- actions

    @property
    def run(self) -> Run:
        """The run in which the fish swims."""
        return self.event.run

    def begin(self):
        self.action = np.zeros(len(self.actions))
        self._mark()

    def act(self, action):
        refuse_masked(action, "an action")
        values = np.asarray(action, float).reshape(-1)
        numbers = values.tolist()
        if len(numbers) != len(self._box) or not all(low <= x <= high for x, (low, high) in zip(numbers, self._box)):
            bounds = ", ".join(f"{name} {low:g} to {high:g}" for name, low, high in zip(self.actions, self._low, self._high))
            raise CaseError(f"an action is {len(self.actions)} numbers within the box ({bounds}), not {action!r}")
        self.action = values
        number = ctypes.c_double()
        with self.run._using() as pointer:
            for key, value in zip(self._keys, numbers):
                number.value = value
                code = lib.library.shoal_set(pointer, self.fish, key, 1, number)
                if code:
                    check(code)
        self._mark()

    def _mark(self):
        self._before = self.event.time, self._pair("com"), float(self.event("actuation_work")[self.fish])
        self._goal_before = None if self.goal is None else self._to_goal()

    # -- observations

    def _pair(self, name):
        """Two numbers of this fish, as floats of Python."""
        return self.event(name)[self.fish].tolist()

    @property
    def com(self) -> np.ndarray:
        """The centre of mass, m: (2,)."""
        return np.array(self._pair("com"))

    def _turn(self):
        angle = math.radians(float(self.event("heading")[self.fish]))
        self._cos, self._sin = math.cos(angle), math.sin(angle)

    def _own(self, x, y):
        c, s = self._cos, self._sin
        return (c * x + s * y) / self.length, (c * y - s * x) / self.length

    def _place(self):
        other, (x, y) = self._checked_goal(self.goal(self.event.time)) if callable(self.goal) else self.goal
        if other is not None:
            of_fish = self.event("com")[other].tolist()
            x, y = x + of_fish[0], y + of_fish[1]
        return x, y

    def place(self) -> np.ndarray:
        """The place of the goal now, m: (2,)."""
        return np.array(self._place())

    def _to_goal(self):
        x, y = self._place()
        own = self._pair("com")
        return x - own[0], y - own[1]

    def to_goal(self) -> np.ndarray:
        """From the centre of mass to the goal, m: (2,)."""
        return np.array(self._to_goal())

    def _see_velocity(self):
        return self._own(*self._pair("com_velocity"))

    def _see_heading(self):
        return self._cos, self._sin

    def _see_goal(self):
        x, y = self._own(*self._to_goal())
        return x, y, math.hypot(x, y)

    def _see_closing(self):
        time = self.event.time - self._before[0]
        if not time > 0:
            return 0.0, 0.0
        before, now = self._goal_before, self._to_goal()
        return self._own((before[0] - now[0]) / time, (before[1] - now[1]) / time)

    def _see_flow(self):
        c, s = self._cos, self._sin
        turned = self.length * self.sensors @ np.array([[c, s], [-s, c]])
        velocity = self.run.flow(self.event("x")[self.fish, 0] + turned)[0]
        return (velocity @ np.array([[c, -s], [s, c]])).ravel() / self.length

    def _see_pressure(self):
        pressure = [self.event(f"sensor_pressure_{side}")[self.fish, : self.n_sensors] for side in ("left", "right")]
        return np.ravel(pressure, order="F") / (self.density * self.length**2)

    def _see_neighbours(self):
        c, s = self._cos, self._sin
        com, velocity = self.event("com"), self.event("com_velocity")
        seen = np.empty((len(self.others), 4))
        seen[:, :2] = com[self.others] - com[self.fish]
        seen[:, 2:] = velocity[self.others] - velocity[self.fish]
        return (seen.reshape(-1, 2) @ np.array([[c, -s], [s, c]])).ravel() / self.length

    def _see_sight(self):
        bodies = [None if f == self.fish else x[np.isfinite(x[:, 0])] for f, x in enumerate(self.event("x"))]
        headings = np.radians(self.event("heading"))
        return self.vision.look(self.event("x")[self.fish, 0], headings[self.fish], self.length, bodies,
                                self.event("com"), headings, self.event.random).ravel()

    _SEEN = {  # name: (function, bound)
        "velocity": (_see_velocity, 20),
        "heading": (_see_heading, 1),
        "curvature": (lambda self: self.event("curvature")[self.fish, : self.n_joints] * self.length, 500),
        "muscle": (lambda self: self.event("natural_curvature")[self.fish, : self.n_joints] * self.length, 500),
        "flow": (_see_flow, 20),
        "pressure": (_see_pressure, 100),
        "goal": (_see_goal, 1000),
        "closing": (_see_closing, 20),
        "neighbours": (_see_neighbours, 1000),
        "sight": (_see_sight, 1000),
        "action": (lambda self: self.action, 20),
    }

    def see(self):
        self._turn()
        seen = np.empty(self._bound.size)
        for see, part, _ in self._parts:
            seen[part] = see(self)
        np.minimum(np.maximum(seen, -self._bound, out=seen), self._bound, out=seen)
        return seen.astype(np.float32)

    # -- rewards

    def _moved(self):
        time, com, work = self._before
        now = self._pair("com")
        return (self.event.time - time, (now[0] - com[0], now[1] - com[1]),
                float(self.event("actuation_work")[self.fish]) - work)

    def _earn_speed(self):
        time, way, _ = self._moved()
        return math.hypot(*way) / (time * self.length) if time > 0 else 0.0

    def _earn_cost(self):
        _, way, work = self._moved()
        return -work / (self.mass * max(math.hypot(*way), 0.01 * self.length))

    def _earn_course(self):
        _, way, _ = self._moved()
        if self.goal is not None:
            aim = self._to_goal()
        else:
            aim = math.cos(math.radians(self.course)), math.sin(math.radians(self.course))
        angle = math.atan2(way[1], way[0]) - math.atan2(aim[1], aim[0])
        return -abs((angle + math.pi) % (2 * math.pi) - math.pi) / math.pi

    _EARNED = {
        "speed": _earn_speed,
        "cost_of_transport": _earn_cost,
        "course": _earn_course,
        "goal": lambda self: -math.hypot(*self._to_goal()) / self.length,
    }

    def earn(self):
        if callable(self.reward_of):
            return float(self.reward_of(self))
        return float(sum(weight * function(self) for weight, function in self._earned))


class _Swim:
    """The common part of the environments: a run that is restarted for each episode, and the swimmers."""

    _OPTIONS = ["assignments"]

    def __init__(self, case, assignments, act_every, vary, far, render_mode):
        if assignments is not None and not isinstance(assignments, Mapping):
            raise TypeError(f'assignments are a dict {{"time.end": 2}}, not {kind(assignments)}')
        if render_mode is not None:
            choice_of(render_mode, _RENDER_MODES, "render_mode")
        if vary is not None and not isinstance(vary, Mapping):
            raise TypeError(f'vary is a dict of bounds {{"fish[0].wave.amplitude": (0.3, 0.5)}}, not {kind(vary)}')
        self.render_mode = render_mode
        self._case, self._assignments = case, dict(assignments or {})
        self._vary = {key: self._checked_range(key, bounds) for key, bounds in (vary or {}).items()}
        self._far = None if far is None else number_of(far, "far, lengths,")
        if far is not None and not self._far > 0:
            raise CaseError(f"far, a distance from the goal in lengths, is above 0, not {far!r}")
        self._kept = None
        self.run = Run(case, self._assignments)
        self._random = np.random.default_rng()
        self.event = _Event(self.run, self._random)
        self._n_steps = 1 if act_every is None else self._n_events(number_of(act_every, "act_every, s,"))

    @staticmethod
    def _checked_range(key, bounds):
        """Bounds of a value that is drawn: two numbers, or two lists of numbers."""
        values = numbers_of(bounds, f"vary: the bounds of {key}")
        if values.ndim < 1 or len(values) != 2 or not np.all(np.isfinite(values)) or not np.all(values[0] <= values[1]):
            raise CaseError(f"vary: the bounds of {key} are two finite numbers or lists, the lower one first, not {bounds!r}")
        return values.tolist()

    def _n_events(self, act_every):
        interval = self.run.interval
        events = act_every / interval
        n = round(events)
        if n >= 1 and abs(events - n) <= 1e-6 * n:
            return n
        below = max(math.floor(events), 1)
        raise CaseError(f"act_every: {act_every:g} s is no multiple of the time between two events, {interval:g} s: take "
                        f"{below * interval:g} or {(below + 1) * interval:g} s, or change time.shedding_interval")

    def __getstate__(self):
        # copies of a run do not survive a pickle as copies of one another: the next reset opens the case again
        return {**self.__dict__, "_kept": None}

    def _begin(self, seed, options):
        """Begin an episode."""
        self._choose_run(seed, options)
        self.event.begin(self.run)
        self._interval, self._end = self.run.interval, self.run.end

    def _check_options(self, options):
        if options is not None and not isinstance(options, Mapping):
            raise TypeError(f'reset: options are a dict {{"assignments": {{...}}}}, not {kind(options)}')
        for name in options or {}:
            choice_of(name, self._OPTIONS, "reset: an option")

    def _choose_run(self, seed, options):
        self._check_options(options)
        if seed is not None:
            self._random = self.event.random = np.random.default_rng(seed)
        changes = dict((options or {}).get("assignments", {}))
        for key, (low, high) in self._vary.items():
            changes[key] = self._random.uniform(low, high)
        if changes:
            self.run = Run(self._case, {**self._assignments, **changes})
            return
        if self._kept is None:
            self._kept = Run(self._case, self._assignments)
            self.run = self._kept.clone()
        else:
            try:
                self.run.restore(self._kept)
            except CaseError:  # the last episode was of another case
                self.run = self._kept.clone()

    def _advance(self):
        """Advance by one action, or to the end; returns the message of a failure of the solver, or None. The GIL is
        released for all events together."""
        interval, end = self._interval, self._end
        event = round(self.event.time / interval)
        failure = None
        try:
            with self.run._using() as pointer:
                lib.call(lib.library.shoal_advance, pointer, min((event + self._n_steps) * interval, end))
        except SolverError as error:
            failure = str(error)
        finally:  # also after Ctrl-C, which leaves the run at an event
            self.event.begin(self.run)
        return failure

    def _ended(self):
        return self.event.time >= self._end

    def _is_lost(self, swimmer):
        if self._far is None or swimmer.goal is None:
            return False
        return math.hypot(*swimmer._to_goal()) > self._far * swimmer.length

    @property
    def unwrapped(self):
        return self

    def render(self):
        """Bodies and wakes now: an array (height, width, 3) of bytes with render_mode "rgb_array", a string of html with
        "html", None without a mode."""
        if self.render_mode == "rgb_array":
            return picture_of(self.run)
        return snapshot_of(self.run) if self.render_mode == "html" else None

    def close(self):
        """Release the runs."""
        for run in (self.run, self._kept):
            if run is not None:
                run.close()
        self._kept = None


class SwimEnv(_Swim, _from("gymnasium", "Env", object)):
    """One fish that learns, by the protocol of Gymnasium.

    * case, assignments: as for shoal.Run. An episode ends (is truncated) at time.end.
    * fish: the fish that learns, by number or name.
    * actions: names among bias, amplitude and frequency, or a dict with their bounds, {"bias": (-0.3, 0.3)}, which may also have
      heave (motion.heave, m). An action outside the box is refused.
    * observations: names among velocity, heading, curvature, muscle, flow, goal, closing, neighbours, sight and action.
    * reward: weights of speed, cost_of_transport, course and goal, or a function of the swimmer.
    * goal: a point (x, y), m; a place beside a fish, ("leader", (1.2, 0)); or a function of the time, s, for a goal that moves.
    * course: the desired course, degree.
    * sensors: places (n, 2) at which the fish feels the flow, from the nose, in lengths.
    * act_every: time between two actions, s, a multiple of time.shedding_interval.
    * vary: bounds of assignments that are drawn at each reset, {"fish[1].start.heading": (170, 190)}.
    * vision: the eye of the observation sight, a dict of range (lengths), angle (degree), noise (of the distance, as a
      fraction, and of the direction, rad) and occlusion; {"range": 5, "angle": 300, "noise": (0, 0), "occlusion": True} by default.
    * far: distance from the goal, in lengths, at which an episode is over (terminated). A failed integration terminates an
      episode too.
    * render_mode: rgb_array, html or None.
    """

    metadata = {"render_modes": list(_RENDER_MODES), "render_fps": 25}
    spec = None
    _OPTIONS = ["assignments", "goal"]

    def __init__(self, case, assignments=None, fish=0, actions=("bias",), observations=("velocity", "heading"),
                 reward=None, goal=None, course=180.0, sensors=_SENSORS, act_every=None, vary=None, far=None,
                 vision=None, render_mode=None):
        _Swim.__init__(self, case, assignments, act_every, vary, far, render_mode)
        number = index_of(fish, self.run.names, "fish")
        self.swimmer = _Swimmer(self.event, number, actions, observations, reward or {"speed": 1.0}, goal, course, sensors,
                                vision)
        self.action_space, self.observation_space = self.swimmer.action_space(), self.swimmer.observation_space()
        self._last, self._goal = None, goal

    def set_goal(self, goal):
        """Set the goal from now on, in later episodes too."""
        self.swimmer.set_goal(goal)
        self._goal = goal

    def reset(self, *, seed=None, options=None):
        """Begin an episode; returns observation and info. options: {"assignments": {...}} changes the case, {"goal": ...}
        the goal, both for this episode."""
        self._check_options(options)
        self.swimmer.set_goal((options or {}).get("goal", self._goal))
        self._begin(seed, options)
        self.swimmer.begin()
        self._last = self.swimmer.see()
        return self._last, {"time": self.event.time}

    def step(self, action):
        """Act, and advance to the next action; returns observation, reward, terminated, truncated, info."""
        if self._last is None:
            raise CaseError("step: call reset() first")
        self.swimmer.act(action)
        info, failure = {}, self._advance()
        if failure:
            info["failure"] = failure
        else:
            self._last = self.swimmer.see()
        info["time"] = self.event.time
        reward = 0.0 if failure else self.swimmer.earn()
        return self._last, reward, bool(failure) or self._is_lost(self.swimmer), self._ended(), info


def _cores():
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class SwimVectorEnv(_from("gymnasium.vector", "VectorEnv", object)):
    """Several SwimEnv that step together in threads, by the protocol of Gymnasium's vector environments.

    num_envs: number of environments. threads: number of threads (None: one per available processor). The other arguments
    belong to SwimEnv. Observations are (num_envs, n), rewards (num_envs,). After the end of an episode the following step
    starts the next episode, ignores the action and has the reward 0 (autoreset mode NEXT_STEP). Results do not depend on
    the number of threads.
    """

    def __init__(self, num_envs: int, case, assignments=None, threads: int | None = None, **arguments):
        for name, value in (("num_envs", num_envs), ("threads", 1 if threads is None else threads)):
            if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < 1:
                raise CaseError(f"{name} is an integer from 1, not {value!r}")
        self.num_envs = int(num_envs)
        self.envs = [SwimEnv(case, assignments, **arguments) for _ in range(self.num_envs)]
        first = self.envs[0]
        self.single_observation_space, self.single_action_space = first.observation_space, first.action_space
        self.observation_space, self.action_space = (
            _make_box(np.tile(space.low, (self.num_envs, 1)), np.tile(space.high, (self.num_envs, 1)), dtype=np.float32)
            for space in (first.observation_space, first.action_space))
        mode = "NextStep"
        with contextlib.suppress(ImportError, AttributeError):
            mode = importlib.import_module("gymnasium.vector").AutoresetMode.NEXT_STEP
        self.metadata = {**SwimEnv.metadata, "autoreset_mode": mode}
        self.render_mode, self.spec = first.render_mode, None
        self._threads = min(int(threads or _cores()), self.num_envs)
        self._pool, self._owner = None, None
        self._over = np.zeros(self.num_envs, bool)

    def __getstate__(self):
        return {**self.__dict__, "_pool": None, "_owner": None}

    def _map(self, function):
        """function(i) for all environments, in threads; a fork of the process creates new threads."""
        if self._threads == 1:
            return [function(i) for i in range(self.num_envs)]
        if self._pool is None or self._owner != os.getpid():
            self._pool, self._owner = concurrent.futures.ThreadPoolExecutor(self._threads), os.getpid()
        return list(self._pool.map(function, range(self.num_envs)))

    @staticmethod
    def _gather(infos):
        gathered = {}
        for i, info in enumerate(infos):
            for key, value in info.items():
                if key not in gathered:
                    gathered[key] = np.full(len(infos), None) if isinstance(value, str) else np.zeros(len(infos))
                    gathered[f"_{key}"] = np.zeros(len(infos), bool)
                gathered[key][i], gathered[f"_{key}"][i] = value, True
        return gathered

    def reset(self, *, seed=None, options=None):
        """Begin all episodes; returns observations and infos. seed: of the first environment, the others follow; or a
        sequence of num_envs seeds. options: as for SwimEnv; "goal" may be a list of num_envs goals."""
        seeds = [None if seed is None else seed + i for i in range(self.num_envs)] if np.ndim(seed) == 0 else list(seed)
        if len(seeds) != self.num_envs:
            raise CaseError(f"reset: {len(seeds)} seeds for {self.num_envs} environments")
        self.envs[0]._check_options(options)
        goals = (options or {}).get("goal")
        own = [options] * self.num_envs
        is_list = isinstance(goals, (list, np.ndarray)) and len(goals) > 0
        if is_list and not isinstance(goals[0], str) and not np.isscalar(goals[0]):
            if len(goals) != self.num_envs:
                raise CaseError(f"reset: {len(goals)} goals for {self.num_envs} environments")
            own = [{**options, "goal": goal} for goal in goals]
        done = self._map(lambda i: self.envs[i].reset(seed=seeds[i], options=own[i]))
        self._over[:] = False
        return np.stack([one[0] for one in done]), self._gather([one[1] for one in done])

    def step(self, actions):
        """Act in all environments; returns observations, rewards, terminations, truncations, infos."""
        actions = np.asarray(actions)
        if actions.shape != self.action_space.shape:
            raise CaseError(f"actions have the shape {self.action_space.shape}, not {actions.shape}")

        def one(i):
            if self._over[i]:
                observation, info = self.envs[i].reset()
                return observation, 0.0, False, False, info
            return self.envs[i].step(actions[i])

        observations, rewards, terminations, truncations, infos = zip(*self._map(one))
        terminations, truncations = np.array(terminations), np.array(truncations)
        self._over = terminations | truncations
        return np.stack(observations), np.array(rewards), terminations, truncations, self._gather(infos)

    def set_goal(self, i: int, goal):
        """Set the goal of environment i from now on, in later episodes too."""
        if not 0 <= i < self.num_envs:
            raise CaseError(f"set_goal: there is no environment {i}: {self.num_envs}, numbered from 0")
        self.envs[i].set_goal(goal)

    def render(self):
        """The pictures of all environments, a tuple."""
        return tuple(env.render() for env in self.envs)

    def close(self, **_):
        """Release threads and runs."""
        if self._pool is not None and self._owner == os.getpid():
            self._pool.shutdown()
        self._pool = None
        for env in self.envs:
            env.close()


class SchoolEnv(_Swim, _from("pettingzoo", "ParallelEnv", object)):
    """A school of fish that learn together, by the protocol of PettingZoo's parallel environments.

    Arguments as for SwimEnv; fish: the names of those that learn, None: all. goal: one for all, or a dict by name.
    """

    metadata = {"render_modes": list(_RENDER_MODES), "name": "shoal_v0", "render_fps": 25}

    def __init__(self, case, assignments=None, fish=None, actions=("bias",),
                 observations=("velocity", "heading", "neighbours"), reward=None, goal=None, course=180.0,
                 sensors=_SENSORS, act_every=None, vary=None, far=None, vision=None, render_mode=None):
        _Swim.__init__(self, case, assignments, act_every, vary, far, render_mode)
        names = self.run.names
        self.possible_agents = [names[index_of(one, names, "fish")] for one in ([fish] if isinstance(fish, str) else
                                                                               names if fish is None else fish)]
        self.agents, self._last = [], {}
        self.swimmers = {}
        for name in self.possible_agents:
            own_goal = goal.get(name) if isinstance(goal, Mapping) else goal
            self.swimmers[name] = _Swimmer(self.event, names.index(name), actions, observations, reward or {"speed": 1.0},
                                           own_goal, course, sensors, vision)
        self.action_spaces = {name: swimmer.action_space() for name, swimmer in self.swimmers.items()}
        self.observation_spaces = {name: swimmer.observation_space() for name, swimmer in self.swimmers.items()}

    num_agents = property(lambda self: len(self.agents))
    max_num_agents = property(lambda self: len(self.possible_agents))

    def action_space(self, agent):
        """The space of the actions of a fish."""
        return self.action_spaces[choice_of(agent, self.possible_agents, "an agent")]

    def observation_space(self, agent):
        """The space of the observations of a fish."""
        return self.observation_spaces[choice_of(agent, self.possible_agents, "an agent")]

    def reset(self, seed=None, options=None):
        """Begin an episode; returns observations and infos by name."""
        self._begin(seed, options)
        self.agents = list(self.possible_agents)
        for swimmer in self.swimmers.values():
            swimmer.begin()
        self._last = {name: self.swimmers[name].see() for name in self.agents}
        return dict(self._last), {name: {} for name in self.agents}

    def step(self, actions):
        """All act at once; returns observations, rewards, terminations, truncations, infos by name. The end of the
        episode for one fish is the end for all fish."""
        agents = self.agents
        missing = [name for name in agents if name not in actions]
        if missing:
            raise CaseError(f"step: no action of {missing[0]}: actions are a dict with {', '.join(agents)}")
        for name in agents:
            self.swimmers[name].act(actions[name])
        failure = self._advance()
        if not failure:
            self._last = {name: self.swimmers[name].see() for name in agents}
        rewards = {name: 0.0 if failure else self.swimmers[name].earn() for name in agents}
        over = bool(failure) or any(self._is_lost(self.swimmers[name]) for name in agents)
        ended = self._ended()
        infos = {name: {"failure": failure} if failure else {} for name in agents}
        if over or ended:
            self.agents = []
        return dict(self._last), rewards, dict.fromkeys(agents, over), dict.fromkeys(agents, ended), infos

    def state(self):
        """The observations of all fish in one array."""
        return np.concatenate([self._last[name] for name in self.possible_agents])


def _register():
    """Tell Gymnasium, if installed, the names of the environments: gymnasium.make("shoal/Swim-v0", case=...)."""
    register = _from("gymnasium", "register", None)
    if register is not None:
        register("shoal/Swim-v0", entry_point="shoal:SwimEnv", vector_entry_point="shoal:SwimVectorEnv")


_register()
