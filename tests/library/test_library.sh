#!/usr/bin/env bash
# test_library.sh PROGRAM: the installed library as others use it: found by pkg-config, linked from C and from C++, shared
# and static, silent, and with no name of its own but shoal_*.
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"
start_python

build=$(dirname "$program")

sanitize=() preload=''
if nm -D --undefined-only "$build/libshoal.so.0" | grep __asan >/dev/null; then
    sanitize=(-fsanitize=address,undefined -fno-sanitize-recover=all)
    preload="$(gcc -print-file-name=libasan.so) $(gcc -print-file-name=libubsan.so)"  # Python is built without
fi

cat >case.yaml <<'CASE'
format: 1
name: pair
time: {end: 0.1, shedding_interval: 0.02, output_interval: 0.02}
fish:
  - {name: a, force: reactive, nodes: 7, sheet_points: 21}
  - {name: b, force: reactive, nodes: 9, sheet_points: 21, start: {position: [0.2, 0.7]}}
CASE

install_it() {
    make -C "$root" --no-print-directory install B="$build" prefix="$folder/usr" ${sanitize[0]:+SANITIZE=1} >install.out
}

compile() {  # output, compiler and options...
    local output=$1
    shift
    # shellcheck disable=SC2046  # pkg-config prints several words
    "$@" -Wall -Wextra -Wconversion -Werror -g "${sanitize[@]}" -o "$output" \
        $(PKG_CONFIG_PATH=$folder/usr/lib/pkgconfig pkg-config --cflags --libs shoal)
}

silent() {  # command...: nothing on standard error, standard output kept in said
    LD_LIBRARY_PATH=$folder/usr/lib "$@" >said 2>err && [[ ! -s err ]]
}

one_name() {
    [[ -z $(nm -D --defined-only usr/lib/libshoal.so | awk '$3 !~ /^shoal_/') ]] &&
        objdump -p usr/lib/libshoal.so | grep 'SONAME *libshoal.so.0$'
}

every_function_is_declared() {
    diff <(nm -D --defined-only usr/lib/libshoal.so | awk '{ print $3 }' | sort) \
        <(grep -oE '\bshoal_[a-z_]+\(' usr/include/shoal.h | tr -d '(' | sort -u)
}

static_library() {
    local with_static
    with_static=$(PKG_CONFIG_PATH=$folder/usr/lib/pkgconfig pkg-config --static --libs shoal)
    # shellcheck disable=SC2086  # several words
    gcc -g "${sanitize[@]}" -I usr/include "$root/tests/library/client.c" usr/lib/libshoal.a ${with_static//-lshoal/} \
        -o client_static && ./client_static case.yaml >said_static && cmp said said_static
}

module() {
    LD_PRELOAD=$preload ASAN_OPTIONS=detect_leaks=0 PYTHONPATH=$(echo usr/lib/python3*/site-packages) /usr/bin/python3 \
        "$root/tests/library/one_step.py"
}

check 'installs into a prefix' install_it
check 'shares shoal_* only, under a soname' one_name
check 'header and library have the same functions' every_function_is_declared
check 'a C program compiles' compile client gcc -std=c11 -D_XOPEN_SOURCE=700 "$root/tests/library/client.c"
check 'and runs, and the library is silent' silent ./client case.yaml
check 'it has done its work' has said '9 node, nose at '
check 'the static library gives the same' static_library
check 'the installed module finds the installed library' module
check 'a C++ program compiles' compile client++ g++ -std=c++17 -pthread "$root/tests/library/client.cpp"
check 'two threads with two runs give the bits of single runs' silent ./client++ case.yaml
for i in 0 1; do
    check "result $i of a thread is that of the program" python "$root/tests/run/same_result.py" alone$i.nc together$i.nc
done

finish
