"""The look of all pictures, and the colours and lines that tell things apart. Used by shoal.plot and the scripts that draw.

Colours can be told apart by the colour-blind and, with marks and dashes, in grey.
"""

try:
    import matplotlib
    import numpy as np
    from matplotlib import ticker
except ImportError as missing:
    raise ImportError(f"{missing}: apt install python3-matplotlib, and run this with /usr/bin/python3") from missing

# of all pictures
STYLE = {
    "font.size": 9,
    "axes.linewidth": 0.6,
    "axes.labelsize": 9,
    "xtick.direction": "in",
    "ytick.direction": "in",
    "xtick.major.width": 0.6,
    "ytick.major.width": 0.6,
    "legend.frameon": False,
    "legend.fontsize": 8,
    "svg.fonttype": "none",
    "pdf.fonttype": 42,
    "savefig.dpi": 200,
    "savefig.bbox": "tight",
    "savefig.pad_inches": 0.05,
}
WIDTH = 7.0  # of a picture, inches: two columns of a journal

# The ends of the red-blue scale of ColorBrewer: dark and light in grey.
RED, BLUE = "#b2182b", "#4393c3"
BODY, BODY_EDGE, PATH, GRID, WALL = "#d9d9d9", "#222222", "#555555", "#cccccc", "#777777"
# Okabe and Ito's colours, in an order that falls from dark to light in grey.
LINES = ["#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]
MARKS = ["o", "s", "^", "D", "v", "P", "X", "*"]
DASHES = ["-", "--", "-.", ":", (0, (5, 1)), (0, (3, 1, 1, 1)), (0, (1, 1)), (0, (8, 2))]
# A phase comes round: black, blue, light blue, orange, and black again.
PHASES = matplotlib.colors.LinearSegmentedColormap.from_list(
    "phases", ["#000000", "#0072b2", "#56b4e9", "#d55e00", "#000000"]
)
BEYOND = 1e6  # where hatching ends, far outside of any picture [m]
SPAN = 30  # positive values that span more than this are drawn on a logarithmic axis


class Wall:
    """A wall along x on axes: a line, and hatching where no fluid is. inward: 1 where the fluid is above it, -1 below."""

    def __init__(self, axes, y, inward):
        self.inward = inward
        self.line = axes.axhline(y, color=WALL, lw=1.2, zorder=2.5)
        self.solid = matplotlib.patches.Rectangle(
            (0, 0), 1, BEYOND, transform=axes.get_yaxis_transform(), fc="white", ec=GRID, hatch="////", lw=0, zorder=2.4
        )
        axes.add_artist(self.solid)
        self.move(y)

    def move(self, y):
        """Put it elsewhere."""
        self.line.set_ydata([y, y])
        self.solid.set_y(y - BEYOND if self.inward > 0 else y)


def scale_of(values):
    """The scale of an axis for some values: "log" or "linear"."""
    values = np.asarray(values, float)
    values = values[np.isfinite(values)]
    return "log" if values.size and values.min() > 0 and values.max() > SPAN * values.min() else "linear"


def few_ticks(axis):
    """Ticks of a logarithmic axis that spans less than SPAN: a few plain numbers, which do not overlap."""
    low, high = axis.get_view_interval()
    if high > SPAN * low:
        return
    first, last = int(np.floor(np.log10(low))), int(np.ceil(np.log10(high)))
    axis.set_major_locator(ticker.FixedLocator([m * 10.0**e for e in range(first, last + 1) for m in (1, 2, 3, 5)]))
    axis.set_major_formatter("{x:g}")
    axis.set_minor_formatter(ticker.NullFormatter())
