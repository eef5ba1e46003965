"""common.py: shared by the tests that disturb the program. The first argument is the program; the test is in a new folder,
which goes with it; the last line is how many passed and failed."""
import atexit, collections, os, resource, shutil, signal, subprocess, sys, tempfile
import netCDF4

program = os.path.abspath(sys.argv[1])
build = os.path.dirname(program)
counts = collections.Counter()
folder = tempfile.mkdtemp()
os.chdir(folder)
# a background job of a shell ignores SIGINT, and so would the program
signal.signal(signal.SIGINT, signal.default_int_handler)
atexit.register(shutil.rmtree, folder, ignore_errors=True)


def argument(i, default):
    return type(default)(sys.argv[i]) if len(sys.argv) > i else default


def shoal(*arguments, limits=(), seconds=300, **environment):
    """Run the program; limits: pairs of a resource and the most of it."""
    def lower():
        for what, most in limits:
            resource.setrlimit(what, (most, most))
    # the address sanitizer accepts a preloaded library in front of it
    environment = {"ASAN_OPTIONS": "verify_asan_link_order=0:detect_leaks=0", **environment}
    return subprocess.run([program, *arguments], env={**os.environ, **environment}, stdin=subprocess.DEVNULL,
                          capture_output=True, text=True, errors="replace", timeout=seconds, preexec_fn=lower)


def succeed(*arguments, **options):
    done = shoal(*arguments, **options)
    assert done.returncode == 0, f"{arguments}: exit code {done.returncode}: {done.stderr}"


def write(name, text):
    with open(name, "wb") as file:
        file.write(text if isinstance(text, bytes) else text.encode())


def read(name):
    with open(name, "rb") as file:
        return file.read()


def same(one, other):
    """Whether both files are there with the same bytes."""
    return os.path.exists(one) and os.path.exists(other) and read(one) == read(other)


def parts():
    return [name for name in os.listdir(".") if ".part" in name]


def values(path):
    """The status of a result, and the array of each variable."""
    with netCDF4.Dataset(path) as data:
        data.set_auto_mask(False)
        return data.run_status.strip("\0"), {name: data[name][...] for name in data.variables if name != "wall_time"}


def different(path, whole, rows=False):
    """The names of the variables of a result without the bits of whole; rows: as many rows as there are."""
    found = values(path)[1]
    n = len(found["time"]) if rows else None
    with netCDF4.Dataset(path) as data:
        grows = {name for name in found if "time" in data[name].dimensions}
    return [name for name in whole if name not in found or
            found[name].tobytes() != (whole[name][:n] if rows and name in grows else whole[name]).tobytes()]


def judge(name, wrong):
    """Count a check; wrong: what is wrong, or nothing."""
    counts["failed" if wrong else "passed"] += 1
    if wrong:
        print(f"FAILED  {name}: {str(wrong).strip()[:2000]}", flush=True)


def finish():
    print(f"{counts['passed']} passed, {counts['failed']} failed, 0 skipped")
    sys.exit(counts["failed"] > 0)
