#!/usr/bin/env bash
# Make the documentation site: the Markdown files of the repository as they are, with an API page for Python (docstrings)
# and for C (comments of include/shoal.h), and a search.
#
#   scripts/site/make-site.sh FOLDER VERSION      writes FOLDER/html; a warning or a broken link is an error
set -euo pipefail

cd "$(dirname "$0")/../.."
folder=$(realpath -m "$1")
source=$folder/source
rm -rf "$folder"
mkdir -p "$source/doc" "$folder/xml" "$folder/extra"

# pages, in the layout of the repository, so that their links hold
cp -r doc/*.md doc/shoal.ipynb doc/figures doc/examples "$source/doc/"
cp -r CONTRIBUTING.md CHANGES.md LICENSE CITATION.cff cases "$source/"
cp doc/case.schema.json "$source/doc/"
rm -f "$source/doc/figures/README.md"
sed -i 's|](README.md)|](index.md)|; s|](../README.md)|](../index.md)|' "$source"/*.md "$source"/doc/*.md
{
    sed '/figures\/moving.gif/a \\n<a href="school.html">A school that plays in your browser</a>' README.md
    printf '\n```{toctree}\n:hidden:\n:caption: %s\n\n' Manual
    printf '%s\n' doc/tutorial doc/install doc/cases doc/output doc/studies doc/steady doc/gallery doc/python doc/notebook doc/glossary
    printf '```\n\n```{toctree}\n:hidden:\n:caption: %s\n\n' Reference
    printf '%s\n' doc/api-python doc/api-c doc/model doc/numerics doc/article
    printf '```\n\n```{toctree}\n:hidden:\n:caption: %s\n\n' Evidence
    printf '%s\n' doc/validation doc/verification doc/performance doc/reliability
    printf '```\n\n```{toctree}\n:hidden:\n:caption: %s\n\n' Development
    printf '%s\n' doc/architecture doc/style CONTRIBUTING CHANGES
    printf '```\n'
} >"$source/index.md"
cat >"$source/doc/api-python.md" <<'PAGE'
# Python API

[The guide](python.md) has examples.

```{eval-rst}
.. automodule:: shoal
   :imported-members:
```

## shoal.plot

```{eval-rst}
.. automodule:: shoal.plot
   :imported-members:
```
PAGE
cat >"$source/doc/api-c.md" <<'PAGE'
# C API

`#include <shoal.h>`; `pkg-config --cflags --libs shoal` prints the options of the compiler.

```{eval-rst}
.. doxygenfile:: shoal.h
   :sections: briefdescription detaileddescription enum func

.. doxygenstruct:: shoal_array
   :members:
```
PAGE

# a school that plays in the browser, as a page of its own
build/shoal run cases/school.yaml -q --force -o "$folder/school.nc" --set time.end=6
build/shoal view "$folder/school.nc" -q --force -o "$folder/extra/school.html"

# the notebook, with the outputs that it has (scripts/notebook.py), as a page of its own
cat >"$source/doc/notebook.md" <<'PAGE'
# Notebook

<a href="../notebook.html">The notebook doc/shoal.ipynb, executed</a>: a run, a movie, a steady state, an error bar.
PAGE
PYTHONWARNINGS=ignore /usr/bin/python3 -m nbconvert --log-level=ERROR --to html \
    --output-dir="$folder/extra" --output=notebook.html doc/shoal.ipynb 2>"$folder/notebook.log"
# the template loads MathJax and RequireJS from folders of Debian, and the notebook needs neither
sed -i '/<script[^>]*src="file:/d' "$folder/extra/notebook.html"

doxygen - >"$folder/doxygen.log" 2>&1 <<OPTIONS
PROJECT_NAME = shoal
INPUT = include/shoal.h
INPUT_FILTER = "sed -f scripts/site/comments.sed"
OUTPUT_DIRECTORY = "$folder"
EXTRACT_ALL = YES
OPTIMIZE_OUTPUT_FOR_C = YES
GENERATE_HTML = NO
GENERATE_LATEX = NO
GENERATE_XML = YES
ENABLE_PREPROCESSING = YES
MACRO_EXPANSION = YES
AUTOLINK_SUPPORT = NO
QUIET = YES
OPTIONS

SHOAL_VERSION=$2 SHOAL_XML=$folder/xml SHOAL_EXTRA=$folder/extra SHOAL_SCRIPTS=$PWD/scripts \
    /usr/bin/python3 -m sphinx -q -W --keep-going -b html -c scripts/site "$source" "$folder/html"

# the theme's script imports another one, which a browser permits in a module only, and a module not from a file: one script
scripts=$folder/html/_static/scripts
sed '/^import Gumshoe/d' "$scripts/furo.js" | cat "$scripts/gumshoe-patched.js" - >"$scripts/whole.js"
mv "$scripts/whole.js" "$scripts/furo.js"
