#!/usr/bin/python3
"""article_bounds.py: whether scripts/article.py tells fish that turn enough from fish that turn too little."""

import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
import article  # noqa: E402


class Fake(article.Run):
    def __init__(self, heading):
        self.data = {"time": np.arange(201) / 10, "heading": np.full((201, 1), float(heading))}

    def __getitem__(self, name):
        return self.data[name]


assert article.figure6_turn(Fake(137.9))[2] and not article.figure6_turn(Fake(138.1))[2]
assert article.figure6_free(Fake(166))[2] and not article.figure6_free(Fake(164))[2]
assert article.figure8(Fake(191))[2] and not article.figure8(Fake(193))[2]
