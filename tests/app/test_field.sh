#!/usr/bin/env bash
# `shoal field` writes the flow of a result on a grid, refuses what it cannot read with a message, and its file can be
# drawn.
#
#   tests/app/test_field.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

run run "$root/cases/demo.yaml" -q -o run.nc --set time.end=0.5 --set output.wake_interval=0.2 \
    --set time.output_interval=0.1
check "a short run" test "$code" = 0

run field run.nc --at 0.2 --grid 40,30
check "field: exit 0" test "$code" = 0
check "field: the file has the name of the run" test -s run-field.nc
check "field: it says what it wrote" has out "run-field.nc: 40 x 30 points at t = 0.2 s"
run info run-field.nc
check "info of a field: exit 0" test "$code" = 0
check "info of a field: the run" grep -q '^  run  *run.nc$' out
check "info of a field: the time" grep -q '^  time  *0.2 s$' out
check "info of a field: the grid" has out "40 points from"
check "info of a field: what is left out" has out "omitted"
run info --case run-field.nc
cp out case.yaml
run check case.yaml
check "info --case of a field is a case" test "$code" = 0

run field run.nc --at 0.2 --box -1,-2,3.5,4e-1 --grid 3,2 -o box.nc -q
check "field with a box: exit 0" test "$code" = 0
check "field -q is quiet" test ! -s out
check "field with a box: its corners" test "$(ncdump -v x,y box.nc | grep -cE '^ (x = -1, 1.25, 3.5|y = -2, 0.4) ;')" = 2
run field run.nc --at 0.2 --box 0,0,1,4 -o long.nc
check "field without a grid: 400 points along the longer side" has out "long.nc: 101 x 400 points at t = 0.2 s"
run field run.nc -o last.nc
check "field without a time: the last row with its wake" has out "at t = 0.5 s"

refused "field: an existing file" 4 "run-field.nc exists" field run.nc --at 0.2
refused "field: no such row" 2 "no row at t = 0.25 s: the nearest are at 0.2 s and 0.3 s" field run.nc --at 0.25 -o a.nc
refused "field: a row without its wake" 2 "the nearest rows with a wake are at 0.2 s and 0.4 s" field run.nc --at 0.3 -o a.nc
refused "field: after the end" 2 "outside of the rows, 0 s to 0.5 s" field run.nc --at 3 -o a.nc
refused "field: a time that is none" 2 "--at soon: expects a time in s" field run.nc --at soon -o a.nc
refused "field: one number for two" 2 "--grid 30: expects NX,NY" field run.nc --grid 30 -o a.nc
refused "field: three numbers for two" 2 "--grid 3,3,3: expects NX,NY" field run.nc --grid 3,3,3 -o a.nc
refused "field: no integer" 2 "--grid 3.5,3: expects NX,NY, integers" field run.nc --grid 3.5,3 -o a.nc
refused "field: a line" 2 "--grid 3,1: expects NX,NY, integers from 2 on" field run.nc --grid 3,1 -o a.nc
refused "field: too many points" 2 "more than 10000000 points" field run.nc --grid 99999,99999 -o a.nc
refused "field: a box upside down" 2 "--box 0,1,1,0: expects the lower left corner" field run.nc --box 0,1,1,0 -o a.nc
refused "field: a box without an end" 2 "--box 0,0,1e999,1: expects X0,Y0,X1,Y1" field run.nc --box 0,0,1e999,1 -o a.nc
refused "field: half a box" 2 "--box 0,1: expects X0,Y0,X1,Y1" field run.nc --box 0,1 -o a.nc
refused "field: a column" 2 "--grid 1,3: expects NX,NY, integers from 2 on" field run.nc --grid 1,3 -o a.nc
refused "field: no integer in y" 2 "--grid 3,3.5: expects NX,NY, integers" field run.nc --grid 3,3.5 -o a.nc
refused "field: a box without a width" 2 "--box 0,0,0,1: expects the lower left" field run.nc --box 0,0,0,1 -o a.nc
refused "field of a field" 4 "not the result of a run" field run-field.nc -o a.nc
refused "field of a case" 4 "case.yaml" field case.yaml -o a.nc
refused "field of nothing" 4 "nothing.nc" field nothing.nc
check "field: a failure leaves no file" test ! -e a.nc

# the rows from 0.4 s on are lost: one row with a wake is left
cp run.nc cut.nc
until "$program" info cut.nc | grep -q '^ *rows *4'; do truncate -s -400 cut.nc || break; done
refused "field: a row behind the last wake" 2 ": the nearest row with a wake is at 0.2 s" field cut.nc --at 0.3 -o a.nc
run field cut.nc -o last.nc --force
check "field without a time: the last row with its wake, of a file that was cut off" has out "at t = 0.2 s"

finish
