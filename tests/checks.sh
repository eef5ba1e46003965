# checks.sh: what shell tests of the program share. A test sources it first and is then in a new folder, with
#
#     $program    the program, which is the first argument of the test
#     $root       the top of the tree
#     $folder     the new folder; removed at the end of the test, and the process $pid is killed
#
# shellcheck shell=bash
set -uo pipefail
export LC_ALL=C.UTF-8

program=$(realpath "${1:?usage: $0 PROGRAM}")
root=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")
folder=$(mktemp -d)
pid=
python=
leave() {
    [[ -z $pid ]] || kill -KILL "$pid" 2>/dev/null
    [[ -z $python ]] || { kill "$python" && wait "$python"; } 2>/dev/null
    chmod -R u+rwx "$folder"
    rm -rf "$folder"
}
trap leave EXIT
cd "$folder" || exit 2

# A process of its own for grep, sleep or timeout takes longer than a check. The calls of a test happen a thousand times, so
# they are made of the shell's own commands; the time limit is that of the test (scripts/run-tests.sh).
readonly time_limit=${TIME_LIMIT:-600}  # seconds to wait for something: a guard against a hang, not a limit to reach
n_passed=0 n_failed=0 n_skipped=0

pass() {
    echo "ok      $1"
    n_passed=$((n_passed + 1))
}

fail() {  # name, reason
    echo "FAILED  $1: $2"
    n_failed=$((n_failed + 1))
}

skip() {  # name, reason
    echo "skipped $1: $2"
    n_skipped=$((n_skipped + 1))
}

# Pass or fail, by the code of the command that follows the name. The reason has what the command printed, and the errors of
# the program if it ran in this folder.
check() {  # name, command...
    local name=$1
    shift
    if "$@" >check.out 2>&1; then
        pass "$name"
    else
        fail "$name" "$* : $(head -c 600 check.out) $(head -c 600 err 2>/dev/null)"
    fi
}

# As check; skip where a program, or with "import MODULE" a module of Python, is missing.
check_with() {  # program or import, name, command...
    if [[ $1 == import\ * ]] && /usr/bin/python3 -c "$1" 2>/dev/null || command -v "$1" >/dev/null; then
        check "${@:2}"
    else
        skip "$2" "${1#import } is missing"
    fi
}

# Wait for some seconds: the pipe has no writer and never gets a byte.
exec {silence}<> <(:)
pause() {  # seconds
    read -rt "$1" -u "$silence"
    true
}

# Run the program; sets $code, and leaves the files out and err.
run() {
    code=0
    "$program" "$@" >out 2>err </dev/null || code=$?
}

has() {  # file, text
    local content=
    IFS= read -rd '' content <"$1"
    [[ $content == *"$2"* ]] || { echo "'$2' is not in $1"; return 1; }
}

refused() {  # name, code, text on standard error, arguments...
    run "${@:4}"
    if ((code != $2)); then
        fail "$1" "exit code $code instead of $2: $(head -c 600 err)"
    else
        check "$1" has err "$3"
    fi
}

# Wait until a command succeeds; exit code 1 after $time_limit seconds.
wait_for() {  # command...
    local deadline=$((SECONDS + time_limit))
    until "$@" >/dev/null 2>&1; do
        ((SECONDS < deadline)) || return 1
        pause 0.01
    done
}

# Does a process have a handler for a signal yet? An earlier signal would kill the process. Before the shell's child becomes
# the program, it has the handlers of the shell.
handles() {  # process, signal
    local name caught
    [[ /proc/$1/exe -ef $program ]] || return 1
    while read -r name caught && [[ $name != SigCgt: ]]; do :; done <"/proc/$1/status"
    ((16#$caught >> ($(kill -l "$2") - 1) & 1))
}

# Run the program until it handles a signal and a command has succeeded, then send the signal; sets $code, and leaves the
# files out and err.
run_until() {  # signal, command, arguments...
    env --default-signal="$1" "$program" "${@:3}" >out 2>err </dev/null &
    pid=$!
    wait_for handles "$pid" "$1"
    wait_for eval "$2"
    kill -s "$1" "$pid" 2>/dev/null
    code=0
    wait "$pid" || code=$?
    pid=
}

# Start the process in which `python` runs the scripts of this test: loading numpy and netCDF4 takes longer than all of them.
start_python() {
    mkfifo "$folder/python.asked" "$folder/python.answered"
    exec {asked}<>"$folder/python.asked" {answered}<>"$folder/python.answered"
    OPENBLAS_NUM_THREADS=1 /usr/bin/python3 "$root/tests/run_scripts.py" <"$folder/python.asked" >"$folder/python.answered" 2>&1 &
    python=$!
}

# Run a script of Python with arguments: prints what the script prints, and has its exit code.
python() {
    local answer output=
    printf '%s\0' "$#" "$PWD" "$@" >&"$asked"
    read -rt "$time_limit" -u "$answered" answer
    [[ $answer =~ ^[0-9]+$ ]] || { echo "$answer"; return 1; }
    IFS= read -rd '' output <"$folder/python.printed"
    printf '%s' "$output"
    return "$answer"
}

# The last line of a test, and the exit code of the test.
finish() {
    echo "$n_passed passed, $n_failed failed, $n_skipped skipped"
    ((n_failed == 0))
}
