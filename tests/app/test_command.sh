#!/usr/bin/env bash
# Tests the command line: help, exit codes, files that are in the way, signals and full disks.
#
#   tests/app/test_command.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

start_python
cases=$root/cases
readonly demo="$cases/demo.yaml" diamond="$cases/diamond.yaml"
export short="time.end=0.3"

# true if err has one line, the warning of a run shorter than two beats
only_few_beats() { [[ $(wc -l <err) -eq 1 ]] && grep -q '^shoal: warning: the run has [0-9.]* beats of fish' err; }

says() { has err "$1"; }
ended() { ((code == $1)); }
silent() { [[ ! -s out && ! -s err ]]; }
one_line() { (($(wc -l <err) == 1)); }
status_of() { ncdump -h "$1" 2>/dev/null | sed -n 's/.*:run_status = "\(.*\)" ;/\1/p'; }
rows_of() { ncdump -h "$1" 2>/dev/null | sed -n 's/.*time = UNLIMITED ; \/\/ (\([0-9]*\) currently).*/\1/p'; }
has_rows() { (($(rows_of "$1") >= $2)); }
status_is() { [[ $(status_of "$1") == "$2" ]]; }
readable() { ncdump -v time,heading,wake_count "$1" >/dev/null; }
# the name of the case's result and of nothing else: no half-made file is left behind
only_files() { [[ $(find "$1" -type f -printf '%f\n' | sort | tr '\n' ' ') == "$2" ]]; }

# ---- help ----

help_and_versions() {
    local command
    run --help
    check "--help ends with 0" ended 0
    check "--help lists the commands on standard output" grep -q '^  run  ' out
    check "--help says nothing on standard error, and -h the same" cmp err <("$program" -h | cmp - out 2>&1)
    for command in run steady study check show keys field info demo; do
        run "$command" --help
        check "$command --help ends with 0" ended 0
        check "$command --help: lines of at most 100 characters" test -z "$(sed 1d out | grep '.\{101\}')"
        check "$command --help shows its usage" grep -q "^Usage: shoal $command" out
    done
    run --version
    run --version
    check "--version names the libraries" grep -qE 'SUNDIALS.*KLU.*LAPACK [0-9.]+, NetCDF' out
    check "--version ends with 0" ended 0
}

# ---- wrong words ----

wrong_words() {
    run
    check "no command: exit 2" ended 2
    check "no command: says so" test -s err
    run swim "$demo"
    check "no command is near: none is named" test "$(grep -c 'did you mean' err)" = 0
    # code, message, arguments
    local want text arguments
    while IFS='|' read -r want text arguments; do
        # shellcheck disable=SC2086 # words
        refused "$arguments" "$want" "$text" $arguments
    done <<EOF_OF_TABLE
2|unknown command 'rnu'; did you mean 'run'?|rnu $demo
2|unknown command 'heys'; did you mean 'keys'?|heys
2|unknown command 'xw'; see shoal --help|xw
2|unexpected argument 'here'|demo here
2|unknown option '--colour'; see shoal run --help|run --colour $demo
2|option '-o' needs a value|run -o
2|CASE is missing; see shoal run --help|run
2|unexpected argument '$diamond'|run $demo $diamond
2|FILE is missing|info
4|nothing.yaml: error: the case file cannot be read|run nothing.yaml
4|nothing.nc|info nothing.nc
4|demo.yaml|info $demo
2|nonsense.key: unknown key|run $demo -q --set nonsense.key=1
2|expects PATH=VALUE|run $demo -q --set time.end
2|--case prints a case file, which is not JSON|info --json --case nothing.nc
2|no key has 'nonsense' in name or meaning; see shoal keys|keys nonsense
2|no variable has 'nonsense' in name or meaning|keys --output nonsense
2|--max-wall 0:00:00: expects HH:MM:SS|run $demo --max-wall 0:00:00
2|--max-wall 0:60:00: expects HH:MM:SS|run $demo --max-wall 0:60:00
2|--max-wall 0:00:60: expects HH:MM:SS|run $demo --max-wall 0:00:60
2|--max-wall 9:-1:00: expects HH:MM:SS|run $demo --max-wall 9:-1:00
2|--max-wall 9:00:-1: expects HH:MM:SS|run $demo --max-wall 9:00:-1
2|--max-wall -1:59:59: expects HH:MM:SS|run $demo --max-wall -1:59:59
2|--max-wall 0:00:09s: expects HH:MM:SS|study $demo --max-wall 0:00:09s
2|-j 2x: expects an integer above 0|study $demo -j 2x
2|-j 1000001: expects an integer above 0|study $demo -j 1000001
2|--limit 9s: expects a number above 0|study $demo --limit 9s
2|--limit : expects a number above 0|study $demo --limit=
2|--members -1: expects the number of a member|study $demo --members -1
2|--members 1x: expects the number of a member|study $demo --members 1x
2|--members 0-1x: expects the number of a member|study $demo --members 0-1x
2|--sweep =1,2: expects KEY=VALUE,VALUE|error $demo --of speed --sweep =1,2
2|--sweep fish.nodes=: expects KEY=VALUE,VALUE|error $demo --of speed --sweep fish.nodes=
EOF_OF_TABLE
    check "nothing was written" only_files . "check.out err out "
}

# ---- destination of the result ----

output_paths() {
    run run "$demo" -q --set "$short"
    check "run: exit 0" ended 0
    check "run: the name of the case with .nc" status_is demo.nc complete
    check "-q prints warnings only" eval 'test ! -s out && only_few_beats'

    echo precious >mine.nc
    run run "$demo" -q --set "$short" -o mine.nc
    check "existing file: exit 2 or 4" test "$code" = 2 -o "$code" = 4
    check "existing file of another program is untouched" grep -q precious mine.nc
    run run "$demo" -q --set "$short" -o mine.nc --force
    check "--force does not replace it" grep -q precious mine.nc
    run run "$demo" -q --set "$short"
    check "existing result: --force is named" says --force
    run run "$demo" -q --set "$short" --force
    check "--force replaces it" status_is demo.nc complete

    run run "$demo" -q --set "$short" -o no/such/folder.nc
    check "missing folder: exit 4" ended 4
    check "missing folder is named" says no/such
    run check "$demo" --set output.file=no/such/folder.nc
    check "check refuses the place that run refuses" says "there is no folder no/such"
    if ((EUID == 0)); then
        run run "$demo" -q --set "$short" -o /proc/x.nc
        check "a folder that takes no files" says "/proc/x.nc: the folder /proc takes no new files"
    else
        skip "a folder that takes no files" "only root may try to write to /proc"
    fi
    mkdir a_folder
    run run "$demo" -q --set "$short" -o a_folder
    check "output is a folder: exit 4" ended 4
    check "output is a folder: nothing in it" only_files a_folder ""
    run run "$demo" -q --set "$short" -o a_folder --force
    check "output is a folder, --force: it stays" test "$code" = 4 -a -d a_folder
    if ((EUID == 0)); then
        skip "read-only folder: exit 4" "root may write everywhere"
    else
        mkdir closed && chmod a-w closed
        run run "$demo" -q --set "$short" -o closed/x.nc
        check "read-only folder: exit 4" ended 4
    fi

    run run "$demo" -q --set time.end=0.2 --set "fish[0].nodes=9" -o set.nc
    check "--set beats the file" grep -q 'node = 9' <(ncdump -h set.nc)
    run run "$demo" -q -o end.nc --set time.end=0.13 --set time.output_interval=0.05
    check "the end is a row where it is no multiple of the output interval" \
        grep -q 'time = 0, 0.05, 0.1, 0.13 ;' <(ncdump -v time end.nc)
    run run "$demo" --set "$short" --set solver.rtol=1e-9 -o log.nc
    check "progress in a log: one line per 10 %" test "$(grep -c ' x real time' err)" = 10
    check "the name of the result on standard output" grep -qx log.nc out
    tail -n 1 <(grep ' steps/event ' err) >last
    run info log.nc --json
    check "the last line of progress has steps and vortices of the result" python "$root/tests/app/progress_line.py"
    # a run that pauses for three seconds near its begin has seconds left
    "$program" run "$demo" --set time.end=20 -o log.nc --force >out 2>err </dev/null &
    pid=$!
    wait_for has err ' 10 %  '
    kill -STOP "$pid"
    pause 3
    kill -CONT "$pid"
    wait "$pid"
    pid=
    # the rest of the run at the speed so far, which is printed with three digits
    check "the seconds left are the time left over the speed" awk '
        / s left / { left = (20 - $2) / $9; n += left > 1.5; if (($6 - left) ^ 2 > (0.6 + left / 50) ^ 2) exit wrong = 1 }
        END { exit wrong || n == 0 }' err
}

# ---- results that are not wanted, and results that can be repeated ----

failures() {
    run run "$demo" -q --set solver.max_steps=1 -o failed.nc
    check "integration fails: exit 1" ended 1
    check "integration fails: when" grep -qE 't = [0-9.]+' err
    check "integration fails: which fish" says fish
    check "integration fails: run_status" grep -q '^failed: ' <(status_of failed.nc)
    check "integration fails: its first row stays" has_rows failed.nc 1

    refused "a body of nothing: what to do" 1 'the Jacobian is singular: check the units of the body' \
        run "$demo" -q --set "fish[0].body.density=1e-300" --set "fish[0].nodes=17" --set "fish[0].start.speed=0" --force -o none.nc
    check "a body of nothing: no error that was not estimated" test -z "$(grep -E '0 tolerances|nan|x\[0\]' err)"
    refused "a fish of no size: what to do" 1 'check the units of sizes, speeds' \
        run "$demo" -q --set "fish[0].length=1e-90" --force -o none.nc
    check "a fish of no size: no code, and no residual of zero" test -z "$(grep -E 'code -|0 of its scale' err)"
    refused "a fish of no speed that can be: what to do" 1 "Newton's method did not converge: check the units of sizes, speeds" \
        run "$demo" -q --set "fish[0].start.speed=1e15" --force -o none.nc

    printf '%s\n' 'format: 1' 'name: overlap' 'time: {end: 1}' 'fish:' '  - {name: a}' \
        '  - {name: b, start: {position: [0, 0.05]}}' >overlap.yaml
    run run overlap.yaml -q
    check "overlapping fish: exit 2" ended 2
    check "overlapping fish: which" grep -qE "a.*b|overlap" err
    check "overlapping fish: no file" test ! -e overlap.nc
}

# ---- results that are nonsense

warnings() {
    printf '%s\n' 'format: 1' 'name: crossing' 'time: {end: 1, shedding_interval: 0.05}' 'fluid: {density: 0}' \
        'defaults: {fish: {wave: {amplitude: 0}, motion: {prescribed: all, speed: 15}}}' \
        'fish:' '  - {name: a}' '  - {name: b, start: {position: [-6, 0], heading: 0}}' >crossing.yaml
    run run crossing.yaml
    check "bodies that cross: exit 0" ended 0
    check "bodies that cross: a warning names them" grep -q '^shoal: warning: .*a and b touch or cross at t = 0.2' err
    run info crossing.nc
    check "info: the warning" grep -q 'warning .*a and b touch or cross' out
    check "info: the closest approach" grep -q 'closest approach .*0.0000 m between a and b' out
    run run crossing.yaml -q --force --strict
    check "--strict: exit 3" ended 3
    check "--strict: the warning and what made it an error" says 'crossing.nc: with --strict its 1 warning is an error'
    check "--strict: the result is complete" status_is crossing.nc complete
    run run "$demo" -q --strict --set "$short" --set 'fish[0].wave.amplitude=0' -o strict.nc
    check "--strict without a warning: exit 0" ended 0
    check "--strict without a warning: silent" silent
    run study crossing.yaml -q --strict --set 'sweep=[{key: "fish[0].motion.speed", values: [15, 16]}]'
    check "study --strict: exit 3" ended 3
    check "study -q: no tables" test ! -s out
    local warned='^members 0-1: warning: .*a and b touch or cross at t = 0.2 s: later results are invalid$'
    check "study: one line per warning, with its members" grep -q "$warned" err
    check "study: no other line about it" test "$(grep -c 'touch or cross' err)" = 1
    run gather crossing-study
    check "gather: the warnings" grep -q "$warned" out
    refused "gather --strict: exit 3" 3 '2 warnings about the members, with --strict' gather crossing-study -q --strict
    check "gather -q: no tables" test ! -s out
    run info crossing-study/study.nc
    check "info of a study: the warnings" grep -q "$warned" out
    refused "study --strict: one warning" 3 '1 warning about the members, with --strict' \
        study crossing.yaml -q --strict -o once --set 'sweep=[{key: "fish[*].motion.speed", values: [15, 0]}]'
    run study crossing.yaml -q --force --set 'sweep=[{key: "fish[1].start.heading", values: [0, 180, 0, 1]}]'
    check "study: the members of a warning, as ranges" grep -q '^members 0, 2-3: warning: .*touch or cross' err
    run study crossing.yaml -q --force --set 'sweep=[{key: "fish[0].motion.speed", values: [15, 5]}]'
    check "study: other numbers, the same warning" grep -q '^members 0-1: .* at t = 0.2 s: .* (numbers of member 0)$' err
}

# ---- help, keys, new, includes, names

helpers() {
    run help
    check "help lists the commands" grep -q '^  run  ' out
    run help study
    cp out help
    run study --help
    check "help COMMAND is COMMAND --help" cmp help out
    run help stuyd
    check "help of a mistyped command: the nearest one is named" says "did you mean 'study'?"

    run keys YOUNG
    check "keys WORD: words of the explanation, whatever their case" grep -q '^fish\[i\].body.modulus:' out
    check "keys WORD: no other keys" test "$(grep -c '^wake' out)" = 0
    run keys young --json
    check "keys WORD --json" python "$root/tests/app/key_paths.py" out fish.body.modulus
    run keys --output separat
    check "keys --output WORD: variables" grep -q '^separation_share' out
    check "keys --output WORD: warnings" grep -q '^separation at the nose:' out

    run new quiet.yaml -q
    check "new -q: prints nothing" silent
    run new mine.yaml
    check "new: exit 0" ended 0
    check "new: the name of the file" test "$(cat out)" = mine.yaml
    run check mine.yaml
    check "new: a case without errors and warnings" eval 'ended 0 && test ! -s err'
    check "new: comments" grep -q '# s$\|# s,' mine.yaml
    run show mine.yaml
    grep -v '^name: ' out >shown
    printf 'format: 1\ntime: {end: 5, output_interval: 0.1}\nfish: [{name: fish}]\n' >plain.yaml
    run show plain.yaml
    check "new: its values are the defaults" cmp shown <(grep -v '^name: ' out)
    echo kept >mine.yaml
    refused "new: no file is overwritten" 4 'mine.yaml exists' new mine.yaml
    check "new: the file is unchanged" test "$(cat mine.yaml)" = kept
    refused "new: a folder that is not there" 4 'No such file' new no/where.yaml

    # the case of the source tree, from elsewhere; its name does not count
    printf '%s\n' 'format: 1' 'include: [demo.yaml]' "time: {end: 0.1}" \
        'sweep: [{key: "fish[*].wave.amplitude", values: [0.3, 0.4]}]' >other.yaml
    run study other.yaml
    check "an include is found among the cases of the source tree" ended 0
    check "a study prints its folder" test "$(head -1 out)" = other-study
    check "a study has the name of the case file" test -e other-study/study.nc
    run run other.yaml --set 'sweep=[]' -q
    check "so has a run" test -e other.nc
    run error other.yaml --set 'sweep=[]' --set 'error={of: speed, confirm: false, keys: {rtol: [1e-4, 1e-5]}}' -q
    check "error -q is quiet" test "$code" != 2 -a ! -s out
    check "the folder of error has the name of the case file" test -e other-error/study.nc
    mkdir -p installed/bin installed/share/shoal/cases
    cp "$program" installed/bin/shoal
    echo 'time: {end: 0.1, shedding_interval: 0.05}' >installed/share/shoal/cases/demo.yaml
    printf '%s\n' 'format: 1' 'include: [demo.yaml]' 'fish: [{name: a}]' >there.yaml
    check "an installed program has its own cases" eval 'installed/bin/shoal check there.yaml | grep -q "0.1 s in 2 events"'
    echo 'time: {end: 0.2, shedding_interval: 0.05}' >demo.yaml
    check "a file beside the case comes first" eval 'installed/bin/shoal check there.yaml | grep -q "0.2 s in 4 events"'
    rm demo.yaml
}

# `shoal info --json` of a run and a study against their files.
summaries() {
    run run "$demo" -q -o summary.nc --set "$short"
    run info summary.nc --json
    cp out run.json
    run info other-study/study.nc --json
    cp out study.json
    check "info --json says what is in the file" python "$root/tests/app/json_summary.py"
    run run "$demo" -q -o marked.nc --set "$short" --checkpoint-at 0.1
    refused "info --json of a checkpoint" 2 'is a checkpoint' info marked.ckpt --json
}

# ---- progress on a terminal of 60 columns

progress() {
    if ! /usr/bin/python3 -c 'import pty; pty.openpty()' 2>no_terminal; then
        skip "progress on a terminal" "no pseudo terminal: $(tail -n 1 no_terminal)"
        return
    fi
    check "a run draws one line within 60 columns" python "$root/tests/app/terminal.py" 60 "$program" run "$demo" --force -o drawn.nc --set time.end=8
    check "a run draws one line within 35 columns" python "$root/tests/app/terminal.py" 35 "$program" run "$demo" --force -o drawn.nc --set time.end=8
    check "and one within 20 columns" python "$root/tests/app/terminal.py" 20 "$program" run "$demo" --force -o drawn.nc --set time.end=4
    check "and less within 19 columns" python "$root/tests/app/terminal.py" 19 "$program" run "$demo" --force -o drawn.nc --set time.end=4
    # shellcheck disable=SC2086 # words
    for words in 'study other.yaml -o drawn -j 1' 'error other.yaml --of speed -j 1 --set sweep=[]' 'compare other.yaml --methods rk4 --steps 5e-3 --set sweep=[]'; do
        check "so does ${words%% *}" python "$root/tests/app/terminal.py" 60 "$program" $words --force
    done
    printf '%s\n' 'format: 1' 'time: {end: 3, shedding_interval: 0.05, output_interval: 0.1}' \
        'fish: [{name: a, force: reactive, nodes: 17}]' >search.yaml
    check "and a search" python "$root/tests/app/terminal.py" 60 "$program" steady search.yaml --force
}

same_bits() { python "$root/tests/run/same_result.py" "$@"; }

repeats() {
    run run "$demo" -q --set time.end=0.5 -o first.nc
    run info --case first.nc
    check "info --case: exit 0" ended 0
    mv out again.yaml
    run run again.yaml -q -o second.nc
    check "a run repeated from its result: exit 0" ended 0
    check "a run repeated from its result: the same to the last bit" same_bits first.nc second.nc
}

# Threads on separate processors, on one shared processor, and as set by the environment: the same bits.
spread() {
    local spread=(run "$diamond" -q --force --set time.end=0.2)
    run "${spread[@]}" -o one.nc
    run "${spread[@]}" --threads 3 -o three.nc
    check "three threads: exit 0" ended 0
    check "three threads: the same bits" same_bits one.nc three.nc
    local processor
    processor=$(taskset -cp $$ | sed 's/.*: \([0-9]*\).*/\1/')
    code=0
    taskset -c "$processor" "$program" "${spread[@]}" --threads 2 -o shared.nc \
        >out 2>err </dev/null || code=$?
    check "two threads on one processor: exit 0" ended 0
    check "two threads on one processor: the same bits" same_bits one.nc shared.nc
    code=0
    OMP_WAIT_POLICY=passive OMP_PROC_BIND=true "$program" "${spread[@]}" --threads 2 -o bound.nc \
        >out 2>err </dev/null || code=$?
    check "threads where the environment says: exit 0" ended 0
    check "threads where the environment says: the same bits" same_bits one.nc bound.nc
}

# ---- signals: the run is started in the background ----

# Start a long run; wait for the first rows.
start_long_run() {
    rm -f long.nc
    env --default-signal=INT,TERM "$program" run "$diamond" -q --force -o long.nc >out 2>err </dev/null &
    pid=$!
    wait_for eval '[[ -e long.nc ]] && has_rows long.nc 4'
}

# Stop the long run and set $code.
end_long_run() {
    code=0
    kill "-$1" "$pid"
    wait "$pid" 2>/dev/null || code=$?
    pid=
}

# End a command by a signal while it writes: it has begun a part when it is stopped.
end_while_writing() {  # signal, part, command...
    local signal=$1 part=$2
    shift 2
    env --default-signal=INT,TERM,HUP "$program" "$@" >out 2>err </dev/null &
    pid=$!
    wait_for handles "$pid" "$signal"
    wait_for eval "compgen -G '$part'" >/dev/null || return 1
    end_long_run "$signal"
}

signals() {
    local signal
    printf '%s\n' 'format: 1' 'name: rows' 'time: {end: 40, shedding_interval: 0.01, output_interval: 0.01}' \
        'fluid: {density: 0}' 'solver: {rtol: 1e-2}' \
        'fish: [{nodes: 41, force: reactive, motion: {prescribed: all, speed: 1}}]' >rows.yaml
    run run rows.yaml -q
    for signal in INT TERM HUP; do
        check "SIG$signal while view writes: the page is begun" end_while_writing "$signal" rows.html.part view rows.nc
        check "SIG$signal while view writes: ended by the signal" ended $((128 + $(kill -l "$signal")))
        check "SIG$signal while view writes: no file" test -z "$(compgen -G 'rows.html*')"
        check "SIG$signal while export writes: a file is begun" end_while_writing "$signal" 'vtk/*.part' export rows.nc \
            --vtk vtk --force
        check "SIG$signal while export writes: no part" test -z "$(compgen -G 'vtk/*.part')"
    done
    rm -rf vtk rows.nc
    for signal in INT TERM; do
        check "SIG$signal: the run is going on" start_long_run
        end_long_run "$signal"
        check "SIG$signal: exit 75" ended 75
        check "SIG$signal: rows kept" has_rows long.nc 4
        check "SIG$signal: run_status stopped" status_is long.nc stopped
        check "SIG$signal: readable" readable long.nc
    done
    check "while it runs: the run is going on" start_long_run
    check "while it runs: readable" readable long.nc
    check "while it runs: run_status running" status_is long.nc running
    run info long.nc
    check "while it runs: info ends with 0" ended 0
    end_long_run KILL
    check "SIGKILL leaves a readable file" readable long.nc
    run info long.nc
    check "SIGKILL: info ends with 0" ended 0
}

# ---- an explicit method that fails ----

explicit() {
    refused "unstable: a stiff body is named" 1 "too stiff for an explicit method" \
        run "$demo" -q --set "$short" -o explicit.nc --set solver.method=heun --set solver.step=0.005
    check "unstable: no control, none named" test -z "$(grep control.gain err)"
    run run "$demo" -q --set "$short" -o steered.nc --set solver.method=heun --set solver.step=0.005 \
        --set "fish[0].control={law: course}"
    check "unstable and steered: the control is named too" says "lower control.gain"
}

# ---- notes ----

notes() {
    run check "$demo" --set "fish[0].length=50"
    check "a note does not make check fail" ended 0
    check "check prints notes" says "note: fish[0].length: 50 m is longer than any swimmer"
    run run "$demo" --set time.end=0.01 --set "fish[0].start.heading=3.14159" -o noted.nc
    check "run prints notes" says "note: fish[0].start.heading: 3.14159 is in degrees"
    run run "$demo" -q --set time.end=0.01 --set "fish[0].start.heading=3.14159" -o quiet.nc
    check "-q prints none" eval 'test ! -s out && only_few_beats'
}

# ---- full disk, closed output, out of memory ----

limited() {  # ulimit option, value of the option, arguments
    local option=$1 value=$2
    shift 2
    code=0
    (ulimit "$option" "$value" && exec "$program" "$@") >out 2>err </dev/null || code=$?
}

limits() {
    limited -f 150 run "$demo" -q -o limited.nc  # in units of 1024 bytes; a whole demo needs more
    check "file too large: exit 4" ended 4
    check "file too large: a message" test -s err
    check "file too large: whole rows stay readable" readable limited.nc
    check "file too large: there are rows" has_rows limited.nc 2

    # every other command that writes a file: the reason, and nothing is left
    local command
    run run "$demo" --set "$short" -q -o whole.nc
    printf 'format: 1\ntime: {end: 0.1}\nfish: [{nodes: 9, sheet_points: 25, force: reactive}]\n' >pair.yaml
    printf 'sweep: [{key: "fish[0].length", values: [1, 1.1]}]\n' >>pair.yaml
    run study pair.yaml -q -o pair-study
    cp pair-study/study.nc study.before
    find . -type f ! -name check.out | sort >"$folder.files"
    for command in "view whole.nc -o cut.html" "export whole.nc --vtk cut" "field whole.nc -o cut.nc" \
        "gather pair-study"; do
        # shellcheck disable=SC2086
        limited -f 4 $command
        check "file too large: $command: exit 4" ended 4
        check "file too large: $command: the reason" says "File too large"
        check "file too large: $command: one message" one_line
        [[ ! -d cut ]] || rmdir cut
        check "file too large: $command: nothing is left" diff <(find . -type f ! -name check.out | sort) "$folder.files"
    done
    check "file too large: gather keeps study.nc" cmp pair-study/study.nc study.before
    printf '%s\n' 'format: 1' 'time: {end: 1, shedding_interval: 0.1, output_interval: 0.1}' \
        'steady: {tolerance: 1e-2, multipliers: false}' 'fish: [{force: reactive, nodes: 9, sheet_points: 17}]' >steady.yaml
    limited -f 100 steady steady.yaml -q -o cut.nc
    check "file too large: steady: the reason, nothing is left, no row is promised" \
        eval 'says "at t = " && test ! -e cut.nc && ! has err "rows before are good"'
    refused "field of a study" 4 "the file of a study: give the file of one run" field pair-study/study.nc -o cut.nc
    (ulimit -f 0 && exec "$program" new cut.yaml) 2>&1 | cat >err
    check "file too large: new: the reason" says "File too large"
    check "file too large: new: nothing is left" test ! -e cut.yaml

    code=0
    "$program" --help >/dev/full 2>err || code=$?
    check "standard output full: exit 4" ended 4
    code=0
    "$program" error "$demo" --of speed --no-confirm --set time.end=0.1 -o full >/dev/full 2>err || code=$?
    check "error, standard output full: exit 4 and the table of the study" eval 'ended 4 && has err "cannot write to standard output" && test -s full/study.nc'
    code=0
    "$program" keys >&- 2>err || code=$?
    check "standard output closed: exit 4" ended 4

    if grep -q __asan_init "$program"; then
        skip "little memory" "the address sanitizer needs all of it"
    else
        # just enough for the program, but not for a school of fine bodies
        limited -v 200000 run "$diamond" -q -o memory.nc --set "fish[*].nodes=4000" --set "fish[*].sheet_points=4000"
        check "little memory: exit 4" ended 4
        check "little memory: says memory" grep -qi memory err
        check "little memory: one message" one_line
    fi
}

# ---- the attribute history

# the history of a result, without the date
history_of() { python "$root/tests/value.py" "$1" history | cut -d ' ' -f 2-; }

history() {
    mkdir "a folder" && cp "$demo" "a folder/it's \$mine.yaml"
    run run "a folder/it's \$mine.yaml" --set 'fish[0].start.position=[0, 0.5]' --set time.end=0.2 -o 'my file.nc'
    check "a result with odd names: exit 0" ended 0
    history_of 'my file.nc' >command.sh
    check "history ends with the arguments as given" grep -qF -- "-o 'my file.nc'" command.sh
    mv 'my file.nc' before.nc
    check "a shell repeats the command of the history" bash command.sh
    check "the repeated command makes the same file" test -f 'my file.nc'
    # one after the other: the process of `python` serves one caller
    history_of before.nc >one.history
    history_of 'my file.nc' >other.history
    check "with the same case" cmp one.history other.history

    # more than any fixed length
    local -a many=()
    local i
    for ((i = 0; i < 300; i++)); do many+=(--set "fish[0].start.position=[0, 0.5]"); done
    run run "$demo" --set time.end=0.1 "${many[@]}" -q -o many.nc
    check "a long command line: exit 0" ended 0
    check "a long command line is in history to the end" grep -q -- '-o many.nc$' <(history_of many.nc; echo)
}

help_and_versions
wrong_words
helpers
output_paths
failures
warnings
repeats
spread
signals
limits
history
explicit
notes
summaries
progress
finish
