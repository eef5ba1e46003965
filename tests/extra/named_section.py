"""Only the second of the fish in named.nc has the section of its nodes."""

import sys
sys.path.insert(0, sys.argv[1] + "/scripts")
from shoal._files import Results
assert [bool(mean) for mean in Results("named.nc").mean_section] == [True, False]
