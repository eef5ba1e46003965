#!/usr/bin/python3
"""Measure the table of doc/steady.md.

How to call it: scripts/measure/tables.py.
"""

import math

from tables import main, short, table


@table("case", "speed [m/s]", "cost [m/s2]", "Strouhal", "residual per beat", "beats", "decay per beat")
def steady_states(bench):
    """cruising speed, cost and stability of the cases of cases/ (minutes)"""
    for name in ("swim", "fish_pressure", "heaving_plate", "tandem_plates", "diamond_plates"):
        state = bench.steady(name)
        largest = max(math.hypot(*value) for value in state["steady_multiplier"])
        strouhal = state["steady_strouhal"][0]
        yield (name, f"{state['steady_speed'][0]:.4f}",
               f"{state['steady_cost_of_transport'][0]:.4f}", "" if strouhal is None else f"{strouhal:.3f}",
               short(state["steady_residual"]), state["steady_beats"], f"{largest:.2f}")


if __name__ == "__main__":
    main("doc/steady.md")
