#!/usr/bin/env bash
# The cases of the article's figures (cases/article) do what the article says of them, and the table of doc/article.md
# has their numbers. scripts/article.py holds the bounds.
#
#   tests/app/test_article.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

check "the figures of the article come out" timeout "$time_limit" "$root/scripts/article.py" --check --program "$program"
check "a case for each of them" test "$(ls "$root"/cases/article | wc -l)" = 6

# a fish that turns too little, and numbers that the document does not have
/usr/bin/python3 - "$root" >out 2>err <<'END'
import sys

sys.path.insert(0, f"{sys.argv[1]}/scripts")
import article
import numpy as np


class Fake(article.Run):
    def __init__(self, heading):
        self.data = {"time": np.arange(201) / 10, "heading": np.full((201, 1), float(heading))}

    def __getitem__(self, name):
        return self.data[name]


assert article.figure6_turn(Fake(137.9))[2] and not article.figure6_turn(Fake(138.1))[2]
assert article.figure6_free(Fake(166))[2] and not article.figure6_free(Fake(164))[2]
assert article.figure8(Fake(191))[2] and not article.figure8(Fake(193))[2]
END
check "a figure that misses its bound is found" test ! -s err

finish
