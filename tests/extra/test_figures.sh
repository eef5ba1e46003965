#!/usr/bin/env bash
# scripts/figures.py knows every figure of the documents, draws figures by their commands, and says which are older than
# which of their inputs.
#
#   tests/extra/test_figures.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

export MPLCONFIGDIR=$folder/matplotlib

cat >load.py <<'end'
"""The module figures, with the program of this test."""
import os, re, sys
root, program = sys.argv[1:3]
sys.path.insert(0, os.path.join(root, "scripts"))
import figures
figures.PROGRAM = program
end

cat >documents_have.py <<'end'
"""Each picture of the documents is a figure of the table and is there; no other picture is there; gallery.md is its page."""
from load import *
import plot
text = open(os.path.join(root, "doc", "gallery.md"), encoding="utf-8").read()
assert text == figures.page(), "doc/gallery.md is out of date: run scripts/figures.py"
missing = set(plot.PICTURES) - set(re.findall(r"plot\.py (\w+) ", text))
assert not missing, f"kinds of figures that are not in the gallery: {missing}"
shown = set()
for path in ["README.md", *(f"doc/{name}" for name in os.listdir(os.path.join(root, "doc")) if name.endswith(".md"))]:
    with open(os.path.join(root, path), encoding="utf-8") as file:
        pictures = re.findall(r"!\[[^]]*\]\(([^)]*)\)", file.read())
    shown |= {os.path.relpath(os.path.join(root, os.path.dirname(path), name), figures.FOLDER) for name in pictures}
there = {os.path.relpath(os.path.join(at, name), figures.FOLDER) for at, _, names in os.walk(figures.FOLDER) for name in names if name.endswith((".png", ".gif"))}
made = {figures.file_of(name) for name in figures.TABLE}
assert shown <= made and made == there, (shown - made, made ^ there)
sizes = [os.path.getsize(os.path.join(figures.FOLDER, name)) for name in made if name.startswith("gallery/")]
assert len(sizes) > 20 and max(sizes) <= figures.GALLERY_BYTES, sizes
assert os.path.getsize(os.path.join(figures.FOLDER, "moving.gif")) <= figures.MOVING_BYTES
end
documents_have() { timeout "$time_limit" /usr/bin/python3 documents_have.py "$root" "$program"; }
check the_documents_have_every_figure documents_have

cat >draws.py <<'end'
"""One figure is drawn by its commands; then it is older than nothing, until one of its inputs is another."""
from load import *
import ast
name, figures.FOLDER = "gallery/gait", os.path.abspath("pictures")
figures.TABLE = {name: figures.TABLE[name]}
os.makedirs("pictures/gallery")
os.makedirs("data")
def write_case(text):
    with open("data/gaits.yaml", "w") as file:
        file.write(text)
def older():
    now, row = figures.inputs_of(name, "data"), figures.recorded().get(name)
    return [key for key in figures.INPUTS if not row or row[key] != now[key]]
case = figures.CASES["gaits.yaml"]
write_case(case)
assert older() == ["case", "script", "results"]
seconds = figures.draw(name, "data")
assert os.path.getsize("pictures/gallery/gait.png") > 1000 and seconds > 0.1, seconds
figures.record(name, {**figures.inputs_of(name, "data"), "seconds": f"{seconds:.0f}"})
assert older() == []

# a comment in the case or another default that is written out changes nothing; a key does, which the result follows
write_case("# a comment\n" + case.replace("{name: default}", "{name: default, wave: {amplitude: 0.4}}"))
assert older() == [], older()
made = os.stat("data/gaits.nc").st_mtime_ns
figures.draw(name, "data")
assert os.stat("data/gaits.nc").st_mtime_ns == made, "the result is kept"
write_case(case.replace("{name: default}", "{name: default, wave: {amplitude: 0.3}}"))
assert older() == ["case"], older()
figures.draw(name, "data")
assert os.stat("data/gaits.nc").st_mtime_ns > made, "the result is made again"
write_case(case)
# a kept result that cannot be drawn is made again
figures.draw(name, "data")
made, call = os.stat("data/gaits.nc").st_mtime_ns, figures.call
def call_of_another_format(command, folder, may_fail=False):
    is_old = command.startswith("plot.py") and os.stat("data/gaits.nc").st_mtime_ns == made
    assert may_fail or not is_old
    return None if is_old else call(command, folder, may_fail)
figures.call = call_of_another_format
figures.draw(name, "data")
assert os.stat("data/gaits.nc").st_mtime_ns > made

# a comment in a script changes nothing, a statement does
read = figures.read
figures.read = lambda *path: read(*path) + ("\n# a comment\n" if path[-1].endswith(".py") else "")
assert older() == [], older()
figures.read = lambda *path: read(*path) + ("\nchanged = 1\n" if path[-1].endswith(".py") else "")
assert older() == ["script"], older()
# so does a result of the program in its first three digits
def other_results(factor):
    def changed(*path):
        lines = read(*path).splitlines()
        if path[-1] == "results.tsv":
            group, variable, value, scale = lines[1].split()
            lines[1] = f"{group} {variable} {float(f'{float(value):.2e}') * factor!r} {scale}"
        return "\n".join(lines)
    return changed
figures.read = other_results(1.0001)
assert older() == [], older()
figures.read = other_results(1.1)
assert older() == ["results"], older()
end
draws() { timeout "$time_limit" /usr/bin/python3 draws.py "$root" "$program"; }
if /usr/bin/python3 -c 'import PIL' 2>/dev/null; then
    check a_figure_is_drawn_and_knows_its_inputs draws
else
    skip a_figure_is_drawn_and_knows_its_inputs "there is no PIL: scripts/install-deps.sh python3-pil"
fi

finish
