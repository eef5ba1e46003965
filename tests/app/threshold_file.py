"""ends: two values just outside of the bar. study: whether the file has all points."""
import json
import sys
import netCDF4

found = json.load(open("flag.json"))
if sys.argv[1] == "ends":
    print(found["threshold"] - 2 * found["bar"], found["threshold"] + 2 * found["bar"])
else:
    with netCDF4.Dataset("flag/study.nc") as data:
        values, growth = data["fish_body_modulus"][:], data["steady_growth"][:]
    points = found["points"]
    sys.exit(not (found["unstable"] == "below" and found["kind"] == "flutter" and found["by_error"] == 0
                  and 0 < found["bar"] < 100 and len(values) == len(points)
                  and all(v == p["value"] and abs(g - p["growth"]) < 1e-8 for v, g, p in zip(values, growth, points))))
