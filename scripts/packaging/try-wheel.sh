#!/usr/bin/env bash
# Build the wheel and try it in a virtual environment, without network: pip sees no index.
set -euo pipefail

cd "$(dirname "$0")/../.."
scripts/install-deps.sh python3-pip python3-venv python3-setuptools python3-wheel
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

/usr/bin/python3 -m pip --disable-pip-version-check wheel --quiet --no-index --no-build-isolation --no-deps -w "$folder" .
/usr/bin/python3 -m venv --system-site-packages "$folder/environment"  # NumPy is Debian's
"$folder/environment/bin/pip" --disable-pip-version-check install --quiet --no-index "$folder"/shoal-*.whl

cp cases/demo.yaml "$folder"
cd "$folder"
env -u PYTHONPATH environment/bin/python - <<'PYTHON'
import pathlib, sys
import numpy, shoal

here = pathlib.Path(shoal.__file__).parent
assert str(here).startswith(sys.prefix), here
assert (here / "libshoal.so.0").is_file() and (here / "bin/shoal").is_file()
with shoal.Run("demo.yaml", {"time.end": 0.1}) as run:
    start = numpy.array(run["x"])
    for _ in range(3):
        run.step()
    assert numpy.isfinite(run["x"]).all() and not numpy.array_equal(run["x"], start)
print(f"shoal {shoal.version()} runs from {here}")
PYTHON
environment/bin/pip uninstall --quiet --yes shoal
[[ ! -e $(echo environment/lib/python3*/site-packages)/shoal ]]
