"""What the page says of its traces in its elements: bands are quantiles of the result, headings have no jump."""
import re
import netCDF4
import numpy as np

page, data = open("browser.out", encoding="utf-8").read(), netCDF4.Dataset("crowd.nc")


def element(name, key):
    canvas = re.search(rf'<canvas[^>]*data-name="{name}"[^>]*>', page)[0]
    return re.search(rf'data-{key}="([^"]*)"', canvas)[1]


power = np.quantile(data["actuation_power"][-1], [0, 0.25, 0.5, 0.75, 1])
got = np.array(element("actuation_power", "bands").split(), float)
assert np.allclose(got, power, rtol=1e-5, atol=1e-5 * np.ptp(power)), (got, power)
low, high = float(element("heading", "low")), float(element("heading", "high"))
assert high - low < 60, (low, high)
assert element("speed", "constant") == "true", "a speed of rounding is constant"
assert 'data-overview="200"' in page, "the school is in the corner"
assert re.search(r'id="scale"[^>]*>heading \[degree\]', page), "a scale of colours"
