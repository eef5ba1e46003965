#!/usr/bin/env bash
# Install the program, the library, the Python module, cases, scripts and documents, or remove them: the rules `install`
# and `uninstall` of the Makefile, which sets the variables.
#
#   scripts/packaging/install.sh [--remove]
set -euo pipefail

: "${B:?}" "${VERSION:?}" "${SOVERSION:?}" "${PYTHON:?}" "${prefix:?}" "${libdir:?}" "${private_libraries:?}"
top=${DESTDIR-}$prefix lib=${DESTDIR-}$libdir
share=$top/share/shoal
soname=libshoal.so.$SOVERSION

# the folder under the prefix in which Python looks for modules; else one for PYTHONPATH
modules=$(prefix=$prefix "$PYTHON" -c '
import os, site, sys
begin = os.environ["prefix"] + "/lib"
folders = [f for f in [*sys.path, site.getusersitepackages()] if f.startswith(begin) and f.endswith("-packages")]
print((folders + ["%s/python%d.%d/site-packages" % (begin, *sys.version_info[:2])])[0])')

if [[ ${1-} == --remove ]]; then
    rm -f "$top/bin/shoal" "$top/include/shoal.h" "$lib"/libshoal.{a,so,so."$SOVERSION",so."$VERSION"} "$lib/pkgconfig/shoal.pc" \
        "$top"/share/man/man1/shoal.1 "$top"/share/man/man5/shoal-{case,output}.5 "$top/share/bash-completion/completions/shoal"
    rm -rf "${DESTDIR-}$modules/shoal" "$share"
    exit
fi

# Install files with a mode into a folder, which is made.
put() {  # mode, folder, files...
    local mode=$1 folder=$2
    shift 2
    install -d "$folder"
    install -m "$mode" "$@" "$folder"
}

put 755 "$top/bin" "$B/shoal"
put 644 "$top/include" include/shoal.h
put 644 "$lib" "$B/libshoal.a"
install -m 755 "$B/$soname" "$lib/libshoal.so.$VERSION"
ln -sf "libshoal.so.$VERSION" "$lib/$soname"
ln -sf "$soname" "$lib/libshoal.so"
install -d "$lib/pkgconfig"
cat >"$lib/pkgconfig/shoal.pc" <<PC
prefix=$prefix
libdir=$libdir
Name: shoal
Description: Swimming of fish and schools with their wakes
Version: $VERSION
Cflags: -I\${prefix}/include
Libs: -L\${libdir} -lshoal
Libs.private: $private_libraries
PC

put 644 "$share/cases" cases/*.yaml
put 644 "$share/cases/article" cases/article/*.yaml
put 644 "$share/cases/include" cases/include/*.yaml
put 644 "$share/cases/studies" cases/studies/*.yaml cases/studies/*.csv
put 755 "$share/scripts" scripts/animate.py scripts/plot.py
put 755 "$share/doc/examples" doc/examples/*.py
put 644 "$share/doc" LICENSE CITATION.cff CHANGES.md doc/*.md doc/shoal.ipynb doc/case.schema.json
put 644 "$share/doc/figures" doc/figures/*.png doc/figures/*.gif
put 644 "$share/doc/figures/gallery" doc/figures/gallery/*.png
put 644 "$top/share/man/man1" "$B/doc/shoal.1"
put 644 "$top/share/man/man5" "$B"/doc/shoal-{case,output}.5
put 644 "$top/share/bash-completion/completions" "$B/doc/completion"
mv "$top/share/bash-completion/completions/"{completion,shoal}

# the module where Python looks, and beside the installed scripts
rm -f "${DESTDIR-}$modules/shoal.py"
put 644 "${DESTDIR-}$modules/shoal" scripts/shoal/*.py
ln -sfn "${modules/#$prefix\//../../../}/shoal" "$share/scripts/shoal"
[[ -n ${DESTDIR-} ]] || "$PYTHON" -c 'import sys; sys.exit(sys.argv[1] not in sys.path)' "$modules" ||
    echo "for 'import shoal': export PYTHONPATH=$modules"
