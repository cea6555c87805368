#!/usr/bin/env bash
# Holds all C++ of the folder given against .clang-format. `check_format.sh ROOT --fix` mends it instead.
set -euo pipefail
cd "${1:?usage: check_format.sh ROOT [--fix]}"
arguments=(--dry-run -Werror --ferror-limit=3)
[[ ${2:-} != --fix ]] || arguments=(-i)
find renderer protocol server web_client tests -name node_modules -prune -o -type f \( -name '*.h' -o -name '*.cpp' \) \
  -print0 | xargs -0 -r -n 16 -P 4 clang-format "${arguments[@]}"
