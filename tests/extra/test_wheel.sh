#!/usr/bin/env bash
# test_wheel.sh PROGRAM: the wheel that pip builds without network works in a virtual environment with NumPy.
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

if [[ $program != "$root/build/shoal" ]]; then
    skip 'wheel' 'make builds it in build/, and this is another build'
    finish
    exit
fi
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_NO_INDEX=1 PIP_ROOT_USER_ACTION=ignore
unset PYTHONPATH SHOAL_LIBRARY SHOAL_PROGRAM

new_environment() {
    # NumPy comes from the system
    /usr/bin/python3 -m venv --system-site-packages environment
}

wheel_runs() {
    environment/bin/python "$root/tests/extra/wheel.py" "$root/cases/demo.yaml"
}

check 'pip builds a wheel without network' \
    /usr/bin/python3 -m pip wheel --quiet --no-build-isolation --no-deps -w . "$root"
check 'a virtual environment' new_environment
check 'pip installs the wheel' environment/bin/pip install --quiet shoal-*.whl
check 'its module runs a case with its own library' wheel_runs
check 'its command is the program' environment/bin/shoal demo -q
check 'with a picture by this Python' test -s demo.png
check 'its commands draw' environment/bin/shoal-plot time demo.nc time.png
check 'and make movies' environment/bin/shoal-animate demo.nc demo.gif
check 'their messages have their names' eval '! environment/bin/shoal-plot no.nc 2>err && grep -q ^shoal-plot: err'
check 'pip removes it' environment/bin/pip uninstall --quiet --yes shoal
check 'and nothing of it stays' test -z "$(find environment -path '*shoal*')"

finish
