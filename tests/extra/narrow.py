"""narrow.py SCRIPTS: in one column of a paper legends and labels keep clear of other panels."""

import sys

sys.path.insert(0, sys.argv[1])
from matplotlib import pyplot
from shoal import plot
from shoal._plot_style import add_legend

with pyplot.rc_context(plot.STYLE):
    figure, (left, right) = pyplot.subplots(1, 2, layout="constrained", figsize=(plot.WIDTH, 3))
    for axes in (left, right):
        axes.plot([0, 1], label="a rather long name")
        axes.plot([1, 0], label="another long name")
    left.set(aspect="equal", xlabel="a label of the left panel")
    right.set(xlabel="a long label of the right panel, in words")
    add_legend(left, left.get_legend_handles_labels()[0])
    plot.paper(figure, 85)
    figure.draw_without_rendering()
    legend = left.get_legend().get_window_extent()
    for one in (right.get_window_extent(), *(text.get_window_extent() for text in right.texts)):
        assert not legend.overlaps(one), (legend, one)
    assert right.xaxis.label.get_window_extent().x1 <= figure.bbox.x1 + 1, right.get_xlabel()
