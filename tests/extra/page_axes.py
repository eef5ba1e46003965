"""Ticks of the traces: texts differ, and with the base of the axis each one is in the range; colours cover the range."""
import html
import re
import sys

page = html.unescape(open("browser.out", encoding="utf-8").read())
for canvas in re.findall(r"<canvas[^>]*data-name=[^>]*>", page):
    ticks, base, low, high = (re.search(rf'data-{key}="([^"]*)"', canvas)[1] for key in ("ticks", "base", "low", "high"))
    ticks, base, low, high = ticks.split(), float(base or 0), float(low), float(high)
    at, room = [base + float(text) for text in ticks], 0.07 * (high - low)
    assert 2 <= len(ticks) == len(set(ticks)) and max(map(len, ticks)) <= 8, ticks
    assert low - room <= min(at) and max(at) <= high + room, (low, at, high)
    steps = [b - a for a, b in zip(at, at[1:])]
    assert max(steps) - min(steps) < 1e-3 * max(steps), ticks
    if sys.argv[1:] == [re.search(r'data-name="([^"]*)"', canvas)[1]]:
        ends = re.search(r'id="scale"[^>]*>[^<]*\] ([^ <]*)<i [^>]*></i>([^<]*)<', page).groups()
        assert [abs(float(a) - b) < 6e-3 * (high - low) for a, b in zip(ends, (low, high))] == [True, True], (ends, low, high)
