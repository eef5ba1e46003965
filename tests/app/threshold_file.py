"""ends: two values on both sides. study: whether the file has all points."""
import json
import sys
import netCDF4

found = json.load(open("flag.json"))
if sys.argv[1] == "ends":
    print(found["threshold"] - 2 * found["by_secant"], found["threshold"] + 2 * found["by_secant"])
else:
    with netCDF4.Dataset("flag/study.nc") as data:
        values, growth = data["fish_body_modulus"][:], data["steady_growth"][:]
    points = found["points"]
    sys.exit(not (found["unstable"] == "below" and found["kind"] == "flutter" and found["by_error"] == 0
                  and 0 < found["by_secant"] < 100
                  and abs(found["bar"] / (found["by_secant"] + found["by_interval"] + found["by_bodies"]) - 1) < 1e-3 and len(values) == len(points)
                  and all(v == p["value"] and abs(g - p["growth"]) < 1e-8 for v, g, p in zip(values, growth, points))))
