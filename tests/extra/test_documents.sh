#!/usr/bin/env bash
# The output of commands that README.md and doc/*.md show is what these commands print now, within what the tolerance of
# the solver allows. Only commands that take seconds run here; `make numbers` runs all and compares digits. Output that
# is wrong must be found by scripts/documents.py.
#
#   tests/extra/test_documents.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

compare() { timeout "$time_limit" "$root/scripts/documents.py" --seconds --program "$program" "$@" 2>/dev/null; }

n=0
for document in "$root"/README.md "$root"/doc/*.md; do
    # tests/extra/python_examples.py runs the scripts of doc/python.md
    grep -q '^```output' "$document" || continue
    n=$((n + 1))
    check "output in ${document#"$root"/} is true" compare --rough "$document"
done
check "there are documents with output" test "$n" -ge 3

"$program" keys --json >keys.json
check "every key has a user" /usr/bin/python3 "$root/tests/extra/key_users.py" "$root" <keys.json
mkdir -p lacking/doc
cp -r "$root/cases" lacking
sed '/`fish.load.tip`/d' "$root/doc/cases.md" >lacking/doc/cases.md
check "a key without a user is found" bash -c '! "$@" <keys.json' bash /usr/bin/python3 "$root/tests/extra/key_users.py" lacking

# ---- a document with output that is true, and the same with one change each

true_page() {
    cat <<'end'
Write `a.yaml`:

```yaml
format: 1
end: 3
```

```sh
cat a.yaml
printf '%s\n' 'speed 0.12345 m/s in 1234 steps' 'method  steps  wall, s  settings' 'ida  12  0.5  rtol 1e-5' 'CPU x 2.3'
```

```output
format: 1
...
speed 0.12344 m/s in 1230 steps
method  steps  wall, s  settings
   ida     12     0.7  rtol 1e-5
CPU x 1.7
```

```python
half = 0.5
print(2 * half)  # 1.0
```

```sh minutes
sleep 1000
```

```output
nothing is compared
```

```python
print(half, "m")
```

```output
... m
```
end
}
# The page after a change by sed is found to be false.
changed() {
    true_page | sed "$1" >changed.md
    ! compare changed.md >out && grep -q differs out
}
true_page >true.md
check true_output_is_accepted compare true.md
check another_word changed 's/^speed/velocity/'
check another_number changed 's/0.12344/0.12343/'
check another_count changed 's/ 1230 / 1200 /'
check another_small_count changed 's/   12  /   13  /'
check a_line_more changed '/^```output/,$s/^format: 1$/&\nformat: 2/'
check a_line_less changed '/^CPU x 1.7/d'
check another_unit changed 's/^\.\.\. m/... s/'
check another_comment changed 's/# 1.0/# 1.5/'
check a_command_that_fails changed 's/^cat a.yaml/exit 3/; s/^```output/```yaml/'
check a_script_that_fails changed 's/2 \* half/2 * none/'

# --write puts the present numbers in the place of the false ones, also between omitted lines
true_page | sed '/^```output/,$s/speed 0.12344/speed 0.5/' >written.md
"$root/scripts/documents.py" --seconds --write --program "$program" written.md >out 2>&1
check false_numbers_are_replaced compare written.md
check omitted_lines_stay_omitted test "$(grep -c '^\.\.\.' written.md)" = 2

finish
