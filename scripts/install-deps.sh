#!/usr/bin/env bash
# Install the Debian packages that building, testing and the scripts need. Only missing packages are installed, without
# questions; if all are there, the script says and changes nothing. It needs root, or sudo without a password.
#
#   scripts/install-deps.sh [PACKAGE|@SET]...      additional packages, or one of the sets below
set -euo pipefail

declare -rA sets=(
    [@extra]='python3-scipy ffmpeg chromium python3-vtk9 python3-jsonschema python3-yaml groff mandoc man-db bsdextrautils
        python3-pip python3-venv python3-setuptools python3-wheel'  # make test-extra
    [@site]='python3-sphinx python3-myst-parser furo doxygen python3-breathe jupyter-nbconvert python3-ipykernel'
    [@slurm]='slurm-wlm munge'
    [@deb]='build-essential debhelper dh-python lintian'
)
more=()
for word in "$@"; do
    # shellcheck disable=SC2206  # a set has several words
    more+=(${sets[$word]-$word})
done

readonly packages=(
    gcc g++ make libc6-dev pkg-config
    libsundials-dev libsuitesparse-dev liblapacke-dev liblapack-dev libblas-dev libnetcdf-dev libyaml-dev zlib1g-dev
    libcmocka-dev netcdf-bin clang-format  # tests and style
    python3 python3-numpy python3-matplotlib python3-netcdf4 python3-xarray  # the module, and pictures
    "${more[@]}"
)

if ! command -v dpkg-query >/dev/null; then
    echo "install-deps: this is not Debian, nothing was installed; needed is what Debian calls: ${packages[*]}" >&2
    exit 0
fi

# the names that dpkg does not report as installed
mapfile -t missing < <(comm -23 \
    <(printf '%s\n' "${packages[@]}" | sort) \
    <(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "${packages[@]}" 2>/dev/null |
        sed -n 's/ installed$//p' | sort -u))
((${#missing[@]} > 0)) || exit 0

as_root=()
if ((EUID != 0)); then
    as_root=(sudo -n)
    if ! sudo -n true 2>/dev/null; then
        echo "install-deps: some packages are missing and installing them takes root; please run" >&2
        echo "    sudo apt-get update && sudo apt-get install --no-install-recommends ${missing[*]}" >&2
        exit 1
    fi
fi

apt() {
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -q -y -o DPkg::Lock::Timeout=300 -o Acquire::Retries=3 "$@"
}

echo "install-deps: installing ${missing[*]}" >&2
log=$(mktemp)
trap 'rm -f "$log"' EXIT
# an update that fails (no network) matters only if the packages are not in the cache either
if ! { apt update || true; apt install --no-install-recommends "${missing[@]}"; } >"$log" 2>&1 </dev/null; then
    cat "$log" >&2
    echo "install-deps: apt-get failed; its output is above. Once it is mended, run the same command again, or" >&2
    echo "    apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 1
fi
