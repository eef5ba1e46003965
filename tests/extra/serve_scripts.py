"""serve_scripts.py FOLDER: run scripts of this folder; see test_scripts.sh."""

import contextlib, importlib, sys, traceback

sys.path.insert(0, sys.argv[1])
for line in sys.stdin:
    name, *arguments = line.rstrip("\n").split("\t")
    sys.argv = [name, *arguments]
    with open("out", "w") as out, open("err", "w") as err:
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = 0
            try:
                importlib.import_module(name.removesuffix(".py")).main(arguments)
            except SystemExit as end:
                code = end.code or 0
            except BaseException:
                traceback.print_exc()
                code = 1
    if "matplotlib.pyplot" in sys.modules:
        sys.modules["matplotlib.pyplot"].close("all")
    print(code, flush=True)
