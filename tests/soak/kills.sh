#!/usr/bin/env bash
# 200 kills and stops at random times, 50 of them while resuming (tests/soak/kills.py).
#
#   tests/soak/kills.sh PROGRAM
set -euo pipefail
exec /usr/bin/python3 "$(dirname "$0")/kills.py" "${1:?usage: tests/soak/kills.sh PROGRAM}" 200
