"""widths.py: figures of a paper have its width in mm, or that of one column."""

from matplotlib import image

widths = [image.imread(name).shape[1] / 200 * 25.4 for name in ("two_columns.png", "one_column.png")]
assert abs(widths[0] - 170) < 0.5 and abs(widths[1] - 85) < 0.5, widths
