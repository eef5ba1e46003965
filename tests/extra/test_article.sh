#!/usr/bin/env bash
# The cases of the article's figures (cases/article) do what the article says of them, and the table of doc/article.md
# has their numbers. scripts/article.py holds the bounds.
#
#   tests/extra/test_article.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

check "the figures of the article come out" timeout "$time_limit" "$root/scripts/article.py" --check --program "$program"
check "a case for each of them" test "$(ls "$root"/cases/article | wc -l)" = 6

# a fish that turns too little, and numbers that the document does not have
/usr/bin/python3 "$root/tests/extra/article_bounds.py" >out 2>err
check "a figure that misses its bound is found" test ! -s err

finish
