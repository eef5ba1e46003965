#!/usr/bin/env bash
# Build and test shoal on other systems, each in a separate empty chroot.
#
#   scripts/platforms.sh [--write FILE] [PLATFORM[:CHECK,...]]...
#
# PLATFORM is a name of the table below, by default every platform with all checks:
#
#   demo      make demo
#   test      make test
#   c_tests   make test-c
#   same      demo and pair differ by at most 1e-12 m after 1 s from the results of this machine's build/shoal
#   wheel     the wheel of this machine, with its libraries inside: demo, picture, Python, in a chroot without them
#   packages  the steps of scripts/packaging/Dockerfile, in two chroots: make deb, and a trial of the packages
#
# The script needs root and a mirror of Debian, which it takes from the sources of apt. Where a chroot cannot be made it
# skips all platforms and gives the reason. Logs are left in build/platforms. --write replaces the rows of these platforms in
# the table of FILE that follows the line `make test-platforms`. KEEP=1 keeps the chroots, REUSE=1 takes those that were kept.
# The last line printed counts the checks: "N passed, N failed, N skipped".
set -euo pipefail

# name, release, architecture, compiler, checks
readonly platforms='
debian12-gcc    bookworm  amd64  gcc    demo,test,packages
debian13-gcc    trixie    amd64  gcc    demo,test,packages,wheel
debian13-clang  trixie    amd64  clang  demo,test
debian12-arm64  bookworm  arm64  gcc    demo,c_tests,same
debian13-arm64  trixie    arm64  gcc    demo,c_tests,same'

top=$(realpath "$(dirname "$0")/..")
readonly top work=$top/build/platforms
cd "$top"
passed=0 failed=0

skip_all() {
    echo "platforms: $1" >&2
    echo "$passed passed, $failed failed, 1 skipped"
    exit $((failed > 0))
}

# Run a command in a chroot, in the sources, with separate /proc and /dev; kill all remaining processes afterwards.
enter() {  # chroot, command...
    # shellcheck disable=SC2016 # expanded by the inner shell
    unshare --mount --pid --fork --kill-child --propagation private bash -c '
        root=$1
        shift
        mount -t proc proc "$root/proc"
        mount --rbind /dev "$root/dev"
        exec chroot "$root" /usr/bin/env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 \
            DEBIAN_FRONTEND=noninteractive ${http_proxy:+http_proxy="$http_proxy"} TIME_LIMIT="$TIME_LIMIT" \
            bash -euo pipefail -c "cd /shoal && $*"' - "$@" </dev/null
}

# Make an empty chroot: Debian with apt and make.
make_chroot() {  # folder, release, architecture
    rm -rf "$1"
    timeout 1800 mmdebstrap --quiet --variant=apt --architectures="$3" --include=make,ca-certificates "$2" "$1" "$mirror"
    cp -L /etc/resolv.conf /etc/hosts "$1/etc/"
    mkdir "$1/shoal"
}

# Let the kernel run programs of another architecture. The flag F opens the emulator now, for all chroots.
emulate() {  # architecture
    local name=/proc/sys/fs/binfmt_misc/qemu-aarch64
    [[ $1 != "$(dpkg --print-architecture)" ]] || return 0
    [[ $1 == arm64 ]] || return 1
    scripts/install-deps.sh qemu-user-static || return 1
    [[ -e $name ]] || cat /usr/lib/binfmt.d/qemu-aarch64.conf >/proc/sys/fs/binfmt_misc/register
    [[ -e $name ]]
}

# ---- the checks: each gets a chroot and a compiler

check_demo() {
    enter "$1" make CC="$2" demo
    [[ -s $1/shoal/demo.png ]]
}

check_test() {
    enter "$1" make CC="$2" test
}

check_c_tests() {
    enter "$1" make CC="$2" test-c
}

check_same() {
    local case
    make --no-print-directory
    enter "$1" make CC="$2"
    for case in demo pair; do
        build/shoal run cases/$case.yaml --set time.end=1 --force -q -o "$work/here.nc"
        enter "$1" build/shoal run cases/$case.yaml --set time.end=1 --force -q -o /tmp/there.nc
        scripts/packaging/same_nodes.py "$work/here.nc" "$1/tmp/there.nc"
    done
}

# A new chroot has Python with the packages that draw, and no library of shoal.
check_wheel() {
    local other=$1-wheel
    scripts/install-deps.sh patchelf python3-pip python3-setuptools python3-wheel
    rm -f "$work"/shoal-*.whl
    PIP_NO_INDEX=1 /usr/bin/python3 -m pip wheel --quiet --no-build-isolation --no-deps -w "$work" . \
        --config-settings libraries=inside
    make_chroot "$other" "$release" "$architecture"
    cp "$work"/shoal-*.whl cases/demo.yaml "$other/shoal/"
    enter "$other" apt-get update -qq
    enter "$other" apt-get install -y -qq --no-install-recommends python3-venv python3-matplotlib python3-netcdf4
    enter "$other" 'python3 -m venv --system-site-packages /env
        /env/bin/pip install --quiet --no-index --no-deps shoal-*.whl
        ! ldconfig -p | grep -E "sundials|libklu"
        /env/bin/shoal demo
        /env/bin/shoal-plot time demo.nc time.png
        /env/bin/python -c "import netCDF4, shoal; run = shoal.Run(\"demo.yaml\"); run.advance(0.1); print(run.time)"
        test -s demo.png -a -s time.png'
    [[ -n ${KEEP-} ]] || rm -rf "$other"
}

# Run the steps of a stage of the Dockerfile, shared with the Apptainer definition.
container_stage() {  # chroot, stage
    local line
    while read -r line; do
        grep -qxF "    $line" scripts/packaging/apptainer.def
        enter "$1" "$line"
    done < <(awk -v stage="$2" '/^FROM/ { n++ } n == stage && sub(/^RUN /, "")' scripts/packaging/Dockerfile)
}

check_packages() {
    local other=$1-packages
    container_stage "$1" 1
    make_chroot "$other" "$release" "$architecture"
    cp -r "$1/shoal/build/deb/"*.deb scripts/packaging/try-packages.sh "$other/shoal/"
    container_stage "$other" 2
    enter "$other" ./try-packages.sh
    [[ -n ${KEEP-} ]] || rm -rf "$other"
}

# ---- a platform

version_of() {  # chroot, package
    chroot "$1" dpkg-query -W -f '${Version}' "$2" | sed 's/^[0-9]*://; s/[-+].*//'
}

# The row of a platform in the table.
row() {  # chroot, compiler, checks
    local root=$1
    shift
    # shellcheck source=/dev/null
    printf '| %s | Debian %s | %s %s | %s | %s | %s | %s |\n' "$name" "$(cat "$root/etc/debian_version")" \
        "$1" "$(chroot "$root" "$1" -dumpfullversion 2>/dev/null || chroot "$root" "$1" -dumpversion)" \
        "$(version_of "$root" libsundials-dev)" "$(version_of "$root" libsuitesparse-dev)" \
        "$(version_of "$root" libnetcdf-dev)" "${2//,/, }"
}

run_platform() {  # name, release, architecture, compiler, checks
    local name=$1 release=$2 architecture=$3 compiler=$4 checks=$5 root=$work/$1 check code started all=yes
    emulate "$architecture" || skip_all "$name: programs of $architecture cannot be run here"
    if [[ -z ${REUSE-} || ! -d $root/shoal ]]; then
        make_chroot "$root" "$release" "$architecture" || skip_all "$name: no chroot of $release for $architecture from $mirror"
    fi
    find "$root/shoal" -mindepth 1 -maxdepth 1 ! -name build -exec rm -rf {} +
    scripts/packaging/copy-sources.sh "$root/shoal"
    # demo shows that make installs the packages; without demo a failing mirror is not an error of shoal
    [[ $checks == demo* || $checks == wheel ]] || enter "$root" timeout 1800 scripts/install-deps.sh ||
        skip_all "$name: packages cannot be installed"
    [[ $compiler != clang ]] || enter "$root" scripts/install-deps.sh clang libomp-dev

    for check in ${checks//,/ }; do
        started=$SECONDS
        # in a condition, bash would let a check go on after an error
        set +e
        (set -e; "check_$check" "$root" "$compiler") >"$work/$name-$check.log" 2>&1
        code=$?
        set -e
        if ((code == 0)); then
            passed=$((passed + 1))
            echo "$name $check: passed, $((SECONDS - started)) s"
        else
            failed=$((failed + 1)) all=no
            tail -n 60 "$work/$name-$check.log" | sed 's/^/    /'
            echo "$name $check: FAILED, $((SECONDS - started)) s; $work/$name-$check.log"
        fi
    done
    if [[ $all == yes && $checks != wheel ]]; then row "$root" "$compiler" "$checks" >"$work/$name.row"; else : >"$work/$name.row"; fi
    [[ -n ${KEEP-} ]] || rm -rf "$root"
}

# Put the rows into the table of a document, sorted by name.
write_rows() {  # document, name...
    local document=$1
    shift
    scripts/packaging/write_platforms.py "$document" "$work" "$@"
}

document=''
if [[ ${1-} == --write ]]; then
    document=$2
    shift 2
fi
chosen=("$@")
((${#chosen[@]} > 0)) || mapfile -t chosen < <(awk 'NF { print $1 }' <<<"$platforms")

((EUID == 0)) || skip_all 'making a chroot takes root'
command -v apt-get >/dev/null || skip_all 'this is not Debian'
unshare --mount --pid --fork true 2>/dev/null || skip_all 'this system has no namespaces for a chroot'
scripts/install-deps.sh mmdebstrap debian-archive-keyring || skip_all 'mmdebstrap cannot be installed'
mirror=$(apt-get indextargets --format '$(REPO_URI)' 'Created-By: Packages' 'Origin: Debian' | grep -v security | head -n 1)
[[ -n $mirror ]] || skip_all 'the sources of apt name no mirror of Debian'
export TIME_LIMIT=${TIME_LIMIT:-3600}  # seconds for one test: an emulated processor is slow
mkdir -p "$work"

names=()
for one in "${chosen[@]}"; do
    read -r name release architecture compiler checks < <(grep "^${one%%:*} " <<<"$platforms") ||
        { echo "platforms: there is no platform '${one%%:*}'" >&2; exit 2; }
    [[ $one != *:* ]] || checks=${one#*:}
    run_platform "$name" "$release" "$architecture" "$compiler" "$checks"
    names+=("$name")
done
[[ -z $document ]] || write_rows "$document" "${names[@]}"
echo "$passed passed, $failed failed, 0 skipped"
((failed == 0))
