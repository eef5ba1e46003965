#!/usr/bin/env bash
# test_python_examples.sh PROGRAM: optima, examples and documents of the module shoal, tests/extra/python_examples.py.
here=$(dirname "$0")
exec bash "$here/../library/test_python.sh" "$1" "$(realpath "$here")/python_examples.py"
