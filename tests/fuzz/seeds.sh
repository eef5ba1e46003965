#!/usr/bin/env bash
# Makes a folder with the seeds of the fuzz targets, all of them small: cases/, results/ (a run, a study, a member, a
# field) and checkpoints/.
#
#   tests/fuzz/seeds.sh PROGRAM FOLDER
set -euo pipefail
program=$(realpath "$1")
tests=$(realpath "$(dirname "$0")/..")
mkdir -p "$2/cases" "$2/results" "$2/checkpoints"
cd "$2"
for file in "$tests"/../cases/*.yaml "$tests"/../cases/studies/*.yaml; do
    cp "$file" "cases/$(basename "$(dirname "$file")")-$(basename "$file")"
done
# bad cases, without the messages
awk '/^====? / { file = "cases/bad-" $2 ".yaml"; if ($1 == "===") print "format: 1\ntime: {end: 1}" >file; next }
     /^----$/ { file = "" }
     file { print >file }' "$tests/case/bad_cases.txt"
cat >swimmer.yaml <<'end'
format: 1
name: swimmer
time: {end: 0.04, shedding_interval: 0.02, output_interval: 0.02}
fish: [{force: reactive, nodes: 4, sheet_points: 5}]
end
"$program" run swimmer.yaml -q --force -o results/run.nc
"$program" field results/run.nc -q --force --at 0.04 --grid 4,4 -o results/field.nc
"$program" study swimmer.yaml -q -o study --set 'sweep=[{key: "fish[*].wave.amplitude", values: [0.2, 0.3]}]' >table
cp study/study.nc study/member-0000.nc results
for shedding in sheet impulsive continuous; do
    "$program" run swimmer.yaml -q --force --checkpoint-at 0.02,0.04 --set wake.shedding=$shedding -o $shedding.nc
    cp $shedding.ckpt $shedding.ckpt.previous checkpoints
done
