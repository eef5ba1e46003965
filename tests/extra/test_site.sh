#!/usr/bin/env bash
# The documentation site builds without a warning (a broken link is one), and its pages have the words of the interfaces;
# every cell of the notebook runs.
#
#   tests/extra/test_site.sh PROGRAM
# shellcheck source=tests/checks.sh
. "$(dirname "$0")/../checks.sh"

for need in doxygen 'import sphinx' 'import myst_parser' 'import furo' 'import breathe' 'import nbconvert' 'import ipykernel'; do
    if [[ $need == import\ * ]]; then /usr/bin/python3 -c "$need" 2>/dev/null; else command -v "$need" >/dev/null; fi && continue
    skip the_site_builds_without_a_warning "${need#import } is missing"
    finish
    exit
done

export SHOAL_LIBRARY=${program%/*}/libshoal.so.0 PYTHONWARNINGS=ignore
if grep -q __asan_init "$program"; then
    skip the_site_builds_without_a_warning "Python does not load a library with sanitizers"
    finish
    exit
fi

check the_site_builds_without_a_warning timeout "$time_limit" "$root/scripts/site/make-site.sh" "$folder/site" 0.0.0
html=$folder/site/html
pages_of_documents() {
    local document
    for document in "$root"/doc/*.md; do
        [[ -s $html/doc/$(basename "$document" .md).html ]] || { echo "no page of $document"; return 1; }
    done
}
functions_on_the_c_page() {
    local function
    for function in $(grep -oE 'shoal_[a-z_]+\(' "$root/include/shoal.h" | tr -d '(' | sort -u); do
        has "$html/doc/api-c.html" "id=\"c.$function\"" || return 1
    done
}
names_on_the_python_page() {
    local entry
    for entry in Run Run.advance run steady study view SwimEnv SwimVectorEnv SchoolEnv plot.swim plot.study; do
        has "$html/doc/api-python.html" "id=\"shoal.$entry\"" || return 1
    done
}
check every_document_is_a_page pages_of_documents
check every_function_is_on_the_c_page functions_on_the_c_page
check every_class_and_function_is_on_the_python_page names_on_the_python_page
the_notebook_ran() {
    has "$html/notebook.html" "steady_lift of foil: 0.2434" && has "$html/notebook.html" "<iframe srcdoc" && ! grep -n Traceback "$html/notebook.html"
}
check the_notebook_shows_a_run_a_movie_and_an_error_bar the_notebook_ran
check the_notebook_has_the_outputs_of_its_cells "$root/scripts/notebook.py" --check
no_path_of_the_machine() { ! grep -rlE 'src="file:|href="file:' "$html" --include='*.html'; }
check no_page_loads_a_file_of_the_machine no_path_of_the_machine
# a page opens in a browser with an empty console
opens_without_a_message() {
    timeout "$time_limit" chromium --headless=new --no-sandbox --disable-gpu --enable-logging=stderr --dump-dom \
        --user-data-dir="$folder/browser" "file://$html/$1" >browser.out 2>browser.err </dev/null
    ! grep -a ':CONSOLE' browser.err && has browser.out "$2"
}
if command -v chromium >/dev/null; then
    check the_first_page_has_the_movie_and_a_school opens_without_a_message index.html 'href="school.html"'
    check a_page_has_its_contents_and_the_switch opens_without_a_message doc/model.html theme-toggle
    check the_notebook_opens opens_without_a_message notebook.html iframe
    check the_school_plays opens_without_a_message school.html canvas
else
    skip the_pages_open_without_a_message "there is no chromium"
fi
check the_search_index_has_the_documents has "$html/searchindex.js" doc/tutorial
finish
