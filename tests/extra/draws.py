"""draws.py ROOT PROGRAM: a figure is drawn by its commands; then it is older than nothing, until one of its inputs changes."""
from load_figures import *
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
