#!/usr/bin/python3
"""panels.py STUDY QUANTITY...: whether the picture of a study has panels of these quantities, in this order."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "scripts"))
from shoal._plot_study import Study, panels_of  # noqa: E402

study = Study(sys.argv[1])
found = panels_of(study, study.axes[0][0])
sys.exit(0 if found == sys.argv[2:] else str(found))
