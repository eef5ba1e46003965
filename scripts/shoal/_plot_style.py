"""The look of all pictures, and the colours and lines that tell things apart. Used by shoal.plot and the scripts that draw.

Colours can be told apart by the colour-blind and, with marks and dashes, in grey.
"""

import re

try:
    import matplotlib
    import numpy as np
    from matplotlib import colorbar, ticker
    from matplotlib.transforms import Bbox, ScaledTranslation
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
MANY = 6  # more lines than these are drawn as bands
SPAN = 30  # positive values that span more than this are drawn on a logarithmic axis


class Wall:
    """A wall along x on axes: a line, and hatching outside the fluid. inward: 1 for fluid above the wall, -1 below."""

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


# ---- words


def unit_text(unit):
    """A unit as print shows it, with raised exponents: "m s-1" is m s$^{-1}$."""
    return re.sub(r"(?<=[A-Za-z])(-?\d+)", r"$^{\1}$", unit)


def with_unit(words, unit):
    """The label of a quantity: the unit in brackets, none for "1"."""
    return words if unit == "1" else f"{words} [{unit_text(unit)}]"


def number_text(value):
    """A number of two digits as print shows it: 2.6e-04 is 2.6 x 10^-4 with a raised exponent."""
    if value == 0 or 1e-2 <= abs(value) < 1e4:
        return f"{value:.2g}"
    digits, exponent = f"{value:.1e}".split("e")
    return rf"{digits}$\times$10$^{{{int(exponent)}}}$"


# ---- parts of a panel

ROUNDING = 1e-9  # relative range of values that are constant but for rounding
NEAR_ZERO = 1e-12  # the same for values around 0, relative to the scale of the unit


def calm(panels, scale=0.0, rounding=ROUNDING):
    """Where the lines of panels with one scale are constant but for rounding, widen the scale and say so; scale: of values
    like these. True if they are constant."""
    lines = [line for axes in panels for line in axes.lines]
    values = np.concatenate([np.ravel(line.get_ydata()) for line in lines] or [np.zeros(0)]).astype(float)
    values = values[np.isfinite(values)]
    if values.size == 0 or np.ptp(values) > max(rounding * np.abs(values).max(), NEAR_ZERO * scale):
        for axes in panels:
            if axes.get_yscale() == "linear":
                axes.ticklabel_format(axis="y", useOffset=False)
        return False
    middle = float(values.mean())
    if abs(middle) <= NEAR_ZERO * scale:
        middle = 0.0
    half = 0.05 * abs(middle) or 1.0
    for axes in panels:
        axes.set_yscale("linear")
        axes.set_ylim(middle - half, middle + half)
        axes.ticklabel_format(axis="y", useOffset=False)
        for line in axes.lines:
            line.set_ydata(np.where(np.isfinite(np.asarray(line.get_ydata(), float)), middle, np.nan))
        axes.annotate(f"constant: {middle:.6g}", (0.99, 0.9), xycoords="axes fraction", ha="right", va="top", size=7)
    return True


def draw_bands(axes, x, values, who="fish"):
    """Median, quartiles and range of many lines, values: (x, line); returns handles for a legend."""
    low, lower, median, upper, high = np.nanquantile(values, [0, 0.25, 0.5, 0.75, 1], axis=1)
    band = axes.fill_between(x, lower, upper, color="#b0b0b0", lw=0, label=f"half of {values.shape[1]} {who}")
    edge = [axes.plot(x, end, color="#555555", lw=0.8, ls=":")[0] for end in (low, high)][0]
    edge.set_label("lowest and highest")
    middle = axes.plot(x, median, color="black", lw=1.3, label="median")[0]
    return [middle, band, edge]


BAR_WIDTH = 0.12  # of a colour bar, inches


class BesidePanels:
    """The position of a colour bar: right of the panels, with the exact height of the panels, also for a fixed aspect."""

    def __init__(self, panels):
        self.panels = panels

    def __call__(self, axes, _renderer):
        for panel in self.panels:
            panel.apply_aspect()
        box = Bbox.union([panel.get_position() for panel in self.panels])
        width, height = axes.figure.get_size_inches()
        # matplotlib gives the bar an aspect, which would make a high bar shorter
        axes.set_box_aspect(box.height * height / BAR_WIDTH)
        if hasattr(axes, "_colorbar_info"):
            axes._colorbar_info["aspect"] = box.height * height / BAR_WIDTH
        return Bbox.from_bounds(box.x1 + 0.1 / width, box.y0, BAR_WIDTH / width, box.height)


def colour_bar(figure, mappable, panels, label, **options):
    """A colour bar as high as the panels."""
    axes, words = colorbar.make_axes(list(panels), pad=0.02, aspect=25, fraction=0.06)
    words.pop("orientation", None), words.pop("ticklocation", None)
    axes.set_axes_locator(BesidePanels(list(panels)))
    bar = figure.colorbar(mappable, cax=axes, label=label, **options)
    if hasattr(bar.formatter, "set_useOffset"):
        bar.formatter.set_useOffset(False)
        bar.update_ticks()
    return bar


# ---- legends and labels that fit


def add_legend(axes, handles, above=0, n_columns=None, side="left"):
    """A legend some points above a panel, flush with its side, as wide as it needs to be; fit() narrows it where the figure is
    too narrow. Returns it."""
    place = axes.transAxes + ScaledTranslation(0, above / 72, axes.figure.dpi_scale_trans)
    legend = axes.legend(
        handles=handles, loc=f"lower {side}", bbox_to_anchor=(0 if side == "left" else 1, 1), bbox_transform=place,
        ncol=n_columns or len(handles), borderpad=0, borderaxespad=0.4, columnspacing=1.5,
    )
    # the layout would make the panel as wide as the legend: what it takes into account is a text of its height
    legend.set_in_layout(False)
    legend.room = axes.annotate("", (0, 1), (0, above), "axes fraction", "offset points", va="bottom", alpha=0)
    legend.above, legend.side = above, side
    reserve(legend)
    return legend


def reserve(legend):
    """Keep as much room above the panel as the legend is high."""
    n_rows = -(-len(legend.get_texts()) // legend._ncols)
    legend.room.set(text="\n".join("|" * n_rows), size=1.15 * legend.get_texts()[0].get_size())


def narrowed(legend, n_columns, shift=0.0):
    """The legend anew with another number of columns, moved to the left by some pixels."""
    axes, above, side, room = legend.axes, legend.above, legend.side, legend.room
    size = legend.get_texts()[0].get_size()
    place = axes.transAxes + ScaledTranslation(-shift / axes.figure.dpi, above / 72, axes.figure.dpi_scale_trans)
    legend = axes.legend(
        legend.legendHandles, [text.get_text() for text in legend.get_texts()], loc=f"lower {side}", bbox_transform=place,
        bbox_to_anchor=(0 if side == "left" else 1, 1), ncol=n_columns, borderpad=0, borderaxespad=0.4, columnspacing=1.5, fontsize=size,
    )
    legend.set_in_layout(False)
    legend.above, legend.side, legend.room = above, side, room
    reserve(legend)
    return legend


def is_over_another(legend, box):
    """Whether a legend covers a panel beside its own, with its letter, or the legend of one. The panel above moves away."""
    beside = [axes for axes in legend.axes.figure.axes if axes.get_visible() and axes is not legend.axes]
    beside = [axes for axes in beside if axes.get_window_extent().y0 < box.y0]
    extents = [axes.get_window_extent() for axes in beside]
    boxes = [Bbox.from_extents(one.x0 - LETTER, one.y0, one.x1, one.y1 + legend.above) for one in extents]
    boxes += [axes.get_legend().get_window_extent() for axes in beside if axes.get_legend()]
    return any(box.overlaps(one) for one in boxes)


def fit_legends(figure):
    """Give each legend above a panel as many columns as there is room for in the figure, beside other panels, and move it into
    the figure."""
    width = figure.bbox.width
    for axes in figure.axes:
        legend = axes.get_legend()
        if not hasattr(legend, "room"):
            continue
        box = legend.get_window_extent()
        while legend._ncols > 1 and (box.width > width or is_over_another(legend, box)):
            legend = narrowed(legend, legend._ncols - 1)
            box = legend.get_window_extent()
        beyond = max(box.x1 - width, 0) if legend.side == "left" else min(box.x0, 0)
        if abs(beyond) > 1:
            narrowed(legend, legend._ncols, min(beyond, box.x0))


def fit_labels(figure):
    """Break the label of an axis that is longer than the panel or leaves the figure; the layout lets it be cut."""
    whole = figure.bbox.padded(1)
    rules = (
        ("yaxis", lambda box, panel: box.height > panel.height),
        ("xaxis", lambda box, panel: box.width > 1.3 * panel.width or box.x0 < whole.x0 or box.x1 > whole.x1),
    )
    for axes in figure.axes:
        for label, is_long in ((getattr(axes, name).label, rule) for name, rule in rules):
            words = label.get_text().split(" ")
            if axes.get_visible() and "\n" not in label.get_text() and len(words) > 1 and is_long(label.get_window_extent(), axes.get_window_extent()):
                at = min(range(1, len(words)), key=lambda i: abs(len(" ".join(words[:i])) - len(" ".join(words[i:]))))
                label.set_text(" ".join(words[:at]) + "\n" + " ".join(words[at:]))


def fit(figure):
    """Let legends and labels fit a figure of its size."""
    for _ in range(2):  # panels move as legends and labels change
        figure.draw_without_rendering()
        fit_labels(figure)
        fit_legends(figure)
    return figure


# ---- figures of a paper

MILLIMETRES = 25.4  # of an inch
NARROW = 120  # below this width text is smaller [mm], and there are two panels of fish in a row
STREAMLINES = "streamlines"  # the mark of lines and arrows that are finer there
LETTER = 12  # room above a panel for its letter [points]


def paper(figure, width=170):
    """Make a figure ready for a journal: the width in millimetres that is left after trimming (85: one column, 170: two),
    and letters on the panels if there are several."""
    shown = [axes for axes in figure.axes if axes.get_visible() and axes.get_label() != "<colorbar>"]
    for i, axes in enumerate(shown if len(shown) > 1 else []):
        axes.annotate(f"({chr(ord('a') + i % 26)})", (0, 1), (-4, 3), xycoords="axes fraction", textcoords="offset points",
                      ha="right", va="bottom", fontweight="bold")
    was, height = figure.get_size_inches()
    target = width / MILLIMETRES
    figure.set_size_inches(target, height * max(target / was, 0.8))
    if width < NARROW:
        for text in figure.findobj(matplotlib.text.Text):
            text.set_size(0.8 * text.get_size())
        for lines in figure.findobj(lambda artist: artist.get_gid() == STREAMLINES):
            lines.set_linewidth(0.5 * np.asarray(lines.get_linewidth()))
            if hasattr(lines, "set_mutation_scale"):  # an arrow
                lines.set_mutation_scale(0.5 * lines.get_mutation_scale())
    for legend in (axes.get_legend() for axes in shown if len(shown) > 1):
        if hasattr(legend, "room"):
            legend.above = max(legend.above, LETTER)
            legend.room.set_position((0, legend.above))
            narrowed(legend, legend._ncols)
    fit(figure)
    for _ in range(3):  # the layout changes with the size
        figure.draw_without_rendering()
        legends = [axes.get_legend() for axes in shown if axes.get_legend()]
        box = figure.get_tightbbox(bbox_extra_artists=[*figure.get_default_bbox_extra_artists(), *legends])
        missing = target - box.width - 2 * STYLE["savefig.pad_inches"]
        size = figure.get_size_inches()
        figure.set_size_inches(max(size[0] + missing, target / 3), size[1])
    return figure


# ---- scales of axes


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
