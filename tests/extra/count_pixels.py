"""count_pixels.py PICTURE PART: counts the clearly red and blue pixels of the upper part; its width, whether it is light."""

import sys
import numpy as np
from matplotlib import image

picture = image.imread(sys.argv[1])[:, :, :3]
height = int(float(sys.argv[2]) * picture.shape[0])
r, g, b = np.moveaxis(picture[:height], 2, 0)
print((r - b > 0.25).sum(), (b - r > 0.25).sum(), picture.shape[1], picture.mean() > 0.5)
