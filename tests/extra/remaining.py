"""remaining.py SCRIPTS RUN: the remaining strength of a vortex over age, as in the program (tests/wake/test_wake.c): all, half,
nothing."""

import sys

sys.path.insert(0, sys.argv[1])
from shoal._files import Results, np
run = Results(sys.argv[2])
lifetime, decay, interval = (float(run[name]) for name in ("wake_lifetime", "wake_decay", "shedding_interval"))
ages = lifetime - interval / 2 - decay * np.array([1.1, 1, 0.5, 0])
assert np.allclose(run.remaining(ages), [1, 1, 0.5, 0], atol=1e-12), run.remaining(ages)
