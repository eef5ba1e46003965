#!/usr/bin/env bash
# Copy the sources without build products: scripts/packaging/copy-sources.sh FOLDER
set -euo pipefail

folder=$(realpath "${1:?usage: scripts/packaging/copy-sources.sh FOLDER}")
cd "$(dirname "$0")/../.."
if [[ -e .git ]]; then git ls-files -z; else find . -path './build*' -prune -o -type f -print0; fi |
    tar -c --null --files-from=- | tar -x -C "$folder" --no-same-owner
