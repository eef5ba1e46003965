#!/usr/bin/env bash
# test_python.sh PROGRAM [TESTS]: the module shoal, in a folder of its own with the library of that build; TESTS is a script
# of Python, tests/library/test_python.py by default.
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

library=$(dirname "$program")/libshoal.so.0

preload=''
if nm -D --undefined-only "$library" | grep __asan >/dev/null; then
    # Python is built without sanitizers, and frees nothing at exit
    preload="$(gcc -print-file-name=libasan.so) $(gcc -print-file-name=libubsan.so)"
    export ASAN_OPTIONS=${ASAN_OPTIONS:-}:detect_leaks=0
fi
SHOAL=$program SHOAL_PROGRAM=$program SHOAL_LIBRARY=$library MPLBACKEND=Agg LD_PRELOAD=$preload \
    /usr/bin/python3 -W error::ResourceWarning "${2:-$root/tests/library/test_python.py}" 2>&1
