# Configuration of the documentation site (make site): Sphinx with MyST; scripts/site/make-site.sh collects the pages.
import os
import sys
import warnings

# NumPy silences this notice about modules of other versions, and Sphinx undoes that
warnings.filterwarnings("ignore", message="numpy.ndarray size changed")
sys.path.insert(0, os.environ["SHOAL_SCRIPTS"])

project = "Shoal"
author = "the authors of Shoal"
copyright = author
release = os.environ["SHOAL_VERSION"]

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "breathe"]
root_doc = "index"
myst_heading_anchors = 4  # anchors as on GitHub
suppress_warnings = ["myst.header"]  # README.md begins without a level between the title and the sections

autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "undoc-members": False}

breathe_projects = {"shoal": os.environ["SHOAL_XML"]}
breathe_default_project = "shoal"
breathe_domain_by_extension = {"h": "c"}

html_extra_path = [os.environ["SHOAL_EXTRA"]]
html_theme = "furo"
html_title = f"Shoal {release}"
html_show_sphinx = False
html_show_copyright = False
nitpicky = True
# types of the C library and Python's built-in types have no page here
nitpick_ignore_regex = [("c:identifier", ".*"), ("py:.*", ".*")]


def mark_code(app, what, name, obj, options, lines):
    """An indented block of a docstring is code, as in a reader's editor."""
    for i in range(len(lines) - 1, 0, -1):
        if lines[i].startswith("    ") and not lines[i - 1].strip() and (i < 2 or not lines[i - 2].startswith("    ")):
            lines[i:i] = [".. code-block:: python", ""]


def setup(app):
    app.connect("autodoc-process-docstring", mark_code)
