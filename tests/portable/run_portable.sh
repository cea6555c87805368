#!/usr/bin/env bash
# Runs the tests and the benchmark of this folder on the machine at hand and prints one report.
#   ./run_portable.sh [REPORT]     writes REPORT.txt and REPORT.json as well (default: lightwell-report here)
# The device is the first GPU found, else the software device; LIGHTWELL_DEVICE chooses another for the benchmark.
# The exit code is 1 if a test failed or the benchmark did not run.
set -u
folder=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
report=${1:-lightwell-report}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# The carried libraries only where the machine's own are missing or too old: a driver belongs to its own dispatcher.
# LIGHTWELL_CARRIED=1 forces them.
loader=()
unmet=$(ldd "$folder/portable_bench" 2>&1 | grep 'not found')
if [[ -n ${LIGHTWELL_CARRIED:-} || $unmet == *GLIBC* ]]; then
  loader=("$folder"/lib/c/ld-linux*.so.* --library-path "$folder/lib/c:$folder/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}")
elif [[ -n $unmet ]]; then
  export LD_LIBRARY_PATH="$folder/lib${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH}"
fi

quoted() {  # a JSON string
  local text=${1//\\/\\\\}
  text=${text//\"/\\\"}
  printf '"%s"' "$(tr -d '\000-\037' <<<"$text")"
}

machine_rows() {  # name TAB value
  printf 'date\t%s\n' "$(date -u +%Y-%m-%dT%H:%MZ)"
  printf 'system\t%s\n' "$(uname -srm)"
  printf 'processor\t%s, %s threads\n' "$(sed -n 's/^model name[^:]*: //p' /proc/cpuinfo | head -n 1)" "$(nproc)"
  printf 'load average\t%s\n' "$(cut -d' ' -f1-3 /proc/loadavg)"
  if command -v nvidia-smi >/dev/null; then
    printf 'NVIDIA driver\t%s\n' "$(nvidia-smi --query-gpu=name,driver_version --format=csv,noheader | head -n 1)"
  fi
}

run_tests() {  # prints a line a program; leaves a JSON object a line in $scratch/tests
  local program name output passed failed code
  for program in "$folder"/tests/*; do
    name=${program##*/}
    output=$scratch/$name.out
    timeout 1800 "${loader[@]}" "$program" --gtest_color=no >"$output" 2>&1
    code=$?
    passed=$(grep -c '^\[       OK \]' "$output")
    failed=$(sed -n 's/^\[  FAILED  \] \([^ ,]*\) (.*/\1/p' "$output" | sort -u | tr '\n' ' ')
    [[ $code -eq 0 ]] || all_good=false
    printf '  %-24s %3d passed, exit code %d%s\n' "$name" "$passed" "$code" "${failed:+, failed: $failed}"
    grep -E '^(soup|terrain|closed|instanced|masked|blended|built without)' "$output" | sed 's/^/    /'
    [[ $code -eq 0 ]] || grep -B 12 '^\[  FAILED  \]' "$output" | head -n 60 | sed 's/^/    | /'
    printf '{"name": %s, "passed": %d, "exit_code": %d, "failed": %s}\n' \
      "$(quoted "$name")" "$passed" "$code" "$(quoted "${failed% }")" >>"$scratch/tests"
  done
}

all_good=true
{
  echo 'Lightwell on this machine'
  machine_rows | sed 's/\t/: /'
  echo
  echo 'tests'
  run_tests
  echo
  echo 'benchmark'
  "${loader[@]}" "$folder/portable_bench" ${LIGHTWELL_DEVICE:+--device "$LIGHTWELL_DEVICE"} --json "$scratch/benchmark" 2>&1 ||
    { echo "portable_bench ended with exit code $?"; all_good=false; }
} > >(tee "$report.txt") 2>&1
wait $!
{
  printf '{"machine": {'
  comma=
  while IFS=$'\t' read -r name value; do
    printf '%s%s: %s' "$comma" "$(quoted "$name")" "$(quoted "$value")"
    comma=', '
  done < <(machine_rows)
  printf '},\n"tests": [%s],\n"benchmark": ' "$(paste -sd, "$scratch/tests")"
  cat "$scratch/benchmark" 2>/dev/null || echo null
  echo '}'
} >"$report.json"
$all_good
