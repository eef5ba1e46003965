#!/usr/bin/python3
"""wheel.py CASE: whether the module shoal of an environment runs a case with its own library."""

import pathlib
import sys

import numpy
import shoal

here = pathlib.Path(shoal.__file__).parent
assert here.is_relative_to(sys.prefix), here
assert (here / "libshoal.so.0").is_file() and (here / "bin/shoal").is_file()
with shoal.Run(sys.argv[1], {"time.end": 0.1}) as run:
    start = numpy.array(run["x"])
    for _ in range(3):
        run.step()
    assert numpy.isfinite(run["x"]).all() and not numpy.array_equal(run["x"], start)
