#!/usr/bin/python3
"""Teach a fish to hold a place behind a leader: cross-entropy method, NumPy only, two minutes on two cores.

    doc/examples/hold_place.py [--generations 20] [--policies 24] [--seed 1] [--processes 2] [--figure hold_place.png]

Twice a beat the follower sees where its place is, how fast it comes nearer, and its own heading, and sets bias and
frequency: tanh of a linear function of the five numbers, 12 weights. Each generation draws policies around a mean, lets
each swim the same episode, and moves the mean and the spread to those of the best quarter.
"""

import argparse
import multiprocessing
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))  # not needed once installed
import shoal  # noqa: E402

PLACE = (1.5, 0.5)  # behind and beside the leader, m
ACT_EVERY = 0.48  # s
FISH = {"force": "reactive", "nodes": 7, "sheet_points": 21, "start": {"speed": 1.1}}  # near the speed that they end up with
CASE = {
    "time": {"end": 24, "shedding_interval": 0.04},
    "solver": {"rtol": 1e-4},
    "defaults": {"fish": FISH},
    "fish": [
        {"name": "leader", "control": {"law": "course", "desired_heading": 180, "gain": 2}},
        {"name": "follower", "start": {"position": [1.8, 0.6]}},
    ],
}
OBSERVATIONS = ("goal", "closing", "heading")
# What of the observation the policy uses, and its size: the place forwards and to the left (its distance would be the
# third), how fast it comes nearer in both directions, and the sine of the heading.
FEATURES, SIZE = [0, 1, 3, 4, 6], np.array([0.5, 0.5, 0.1, 0.1, 0.2])


def environment():
    return shoal.SwimEnv(
        CASE,
        fish="follower",
        actions={"bias": (-0.2, 0.2), "frequency": (0.6, 1.4)},
        observations=OBSERVATIONS,
        reward={"goal": 1.0},
        goal=("leader", PLACE),
        act_every=ACT_EVERY,
        vary={"fish[1].start.position": ([1.5, 0.2], [2.4, 1.0])},
        far=4,
    )


_env = None  # one in each process


def episode(policy, seed):
    """Swim once; returns the mean reward, minus 4 for each action that is missing at the end, and the distances."""
    global _env
    _env = _env or environment()
    space, n_actions = _env.action_space, round(CASE["time"]["end"] / ACT_EVERY)
    weights = policy.reshape(space.shape[0], -1)
    seen, _ = _env.reset(seed=seed)
    rewards, over = [], False
    while not over:
        wish = np.tanh(weights @ np.append(seen[FEATURES] / SIZE, 1))
        seen, reward, terminated, truncated, _ = _env.step(space.low + (space.high - space.low) * (1 + wish) / 2)
        rewards.append(reward)
        over = terminated or truncated
    return (sum(rewards) - 4 * (n_actions - len(rewards))) / n_actions, -np.array(rewards)


def learn(n_generations, n_policies, processes, seed):
    """The policy that is learnt, and the rewards of all policies in each generation."""
    random = np.random.default_rng(seed)
    n = environment().action_space.shape[0] * (len(FEATURES) + 1)
    mean, spread = np.zeros(n), np.ones(n)
    history = []
    with multiprocessing.Pool(processes) as pool:
        for generation in range(n_generations):
            policies = mean + spread * random.standard_normal((n_policies, n))
            tasks = [(policy, generation) for policy in policies]  # the same start for all of a generation
            rewards = np.array([result[0] for result in pool.starmap(episode, tasks, chunksize=1)])
            best = policies[np.argsort(rewards)[-(n_policies // 4) :]]
            mean, spread = best.mean(axis=0), best.std(axis=0) + 0.1 * 0.9**generation
            history.append(rewards)
            print(f"generation {generation + 1:3d}: mean reward {rewards.mean():.3f}, best {rewards.max():.3f}", flush=True)
    return mean, history


def draw(path, history, before, after):
    import matplotlib

    matplotlib.use("Agg")
    from matplotlib import pyplot

    figure, (left, right) = pyplot.subplots(1, 2, figsize=(9, 3.5), layout="constrained")
    number = np.arange(1, len(history) + 1)
    left.fill_between(number, [h.min() for h in history], [h.max() for h in history], color="0.88", label="all policies")
    left.plot(number, [h.mean() for h in history], "k-", label="mean of a generation")
    left.plot(number, [h.max() for h in history], "C0--", label="best of a generation")
    left.set(xlabel="generation", ylabel="mean reward: minus distance / length", title="learning curve")
    left.set_xticks(number[4::5])
    left.legend(frameon=False, loc="lower right")
    for runs, style, label in ((before, {"color": "0.6", "ls": "--"}, "untaught"), (after, {"color": "C0"}, "taught")):
        for i, distances in enumerate(runs):
            time = ACT_EVERY * np.arange(1, len(distances) + 1)
            right.plot(time, distances, lw=1, label=label if i == 0 else None, **style)
    right.set(xlabel="time (s)", ylabel="distance from the place / length", ylim=(0, None))
    right.set_title(f"{len(after)} starts that were not trained on")
    right.legend(frameon=False)
    figure.savefig(path, dpi=110)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--generations", type=int, default=20)
    parser.add_argument("--policies", type=int, default=24, help="in a generation")
    parser.add_argument("--seed", type=int, default=1, help="of the policies that are drawn")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--figure", default="hold_place.png")
    options = parser.parse_args()
    policy, history = learn(options.generations, options.policies, options.processes, options.seed)
    tests = range(1000, 1008)
    before = [episode(np.zeros_like(policy), seed) for seed in tests]
    after = [episode(policy, seed) for seed in tests]
    for name, runs in (("untaught", before), ("taught", after)):
        last = [run[1][-len(run[1]) // 4 :] for run in runs]
        print(f"{name}: distance from the place in the last quarter {np.mean([d.mean() for d in last]):.3f} lengths, "
              f"at most {max(d.max() for d in last):.3f}")
    draw(options.figure, history, [run[1] for run in before], [run[1] for run in after])
    print(options.figure)


if __name__ == "__main__":
    main()
