#!/usr/bin/env bash
# Build the Debian packages and check them with lintian: scripts/packaging/make-deb.sh FOLDER VERSION
# DEB_BUILD_OPTIONS=nocheck leaves out the tests in C.
set -euo pipefail

folder=${1:?usage: scripts/packaging/make-deb.sh FOLDER VERSION}
version=$2
here=$(realpath "$(dirname "$0")")
rm -rf "$folder"
mkdir -p "$folder/shoal-$version"
cd "$folder/shoal-$version"
"$here/copy-sources.sh" .
cp -r "$here/debian" .
[[ $(dpkg-parsechangelog -S Version) == "$version" ]] ||
    { echo "scripts/packaging/debian/changelog is not of version $version" >&2; exit 1; }
dpkg-buildpackage --no-sign --build=binary
lintian --allow-root --fail-on error,warning ../*.changes
ls -l ../*.deb
