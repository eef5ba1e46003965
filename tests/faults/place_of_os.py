"""place_of_os.py: print the file by which Python finds its library."""

import os

print(os.__file__)
