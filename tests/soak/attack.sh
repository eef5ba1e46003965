#!/usr/bin/env bash
# Hostile case files, crafted results and checkpoints, kills of every command (tests/soak/attack.py).
#
#   tests/soak/attack.sh PROGRAM
set -euo pipefail
exec /usr/bin/python3 "$(dirname "$0")/attack.py" "${1:?usage: tests/soak/attack.sh PROGRAM}"
