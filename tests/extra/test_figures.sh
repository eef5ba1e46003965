#!/usr/bin/env bash
# scripts/figures.py knows every figure of the documents, draws figures by their commands, and says which are older than
# which of their inputs.
#
#   tests/extra/test_figures.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

export MPLCONFIGDIR=$folder/matplotlib
start_python

check the_documents_have_every_figure python "$root/tests/extra/documents_have.py" "$root" "$program"

if /usr/bin/python3 -c 'import PIL' 2>/dev/null; then
    check a_figure_is_drawn_and_knows_its_inputs python "$root/tests/extra/draws.py" "$root" "$program"
else
    skip a_figure_is_drawn_and_knows_its_inputs "there is no PIL: scripts/install-deps.sh python3-pil"
fi

finish
