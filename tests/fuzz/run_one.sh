#!/usr/bin/env bash
# Fuzzes with one program for a time; says how it went in a line, or shows what failed.
#   run_one.sh PROGRAM SECONDS
# LIGHTWELL_FUZZ_SEED (1) chooses the sequence of inputs: the same for every run of CI, so that its failures can be repeated.
# Found inputs stay beside the program in corpus/NAME, so that a later run goes on where this one ended.
set -euo pipefail
program=$1 seconds=$2
name=${program##*/fuzz_}
folder=$(dirname "$program")
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
corpus=$folder/corpus/$name
log=$folder/fuzz_$name.log
mkdir -p "$corpus"
# OpenEXR takes as much memory as a chunk of pixels says it has, in 32 bits, and gives it back at the file's end.
memory_mb=2048
[[ $name != image ]] || memory_mb=6144
dictionary=()
[[ ! -f $here/$name.dict ]] || dictionary=("-dict=$here/$name.dict")
if "$program" -seed="${LIGHTWELL_FUZZ_SEED:-1}" -max_total_time="$seconds" -max_len=8192 -rss_limit_mb="$memory_mb" -print_final_stats=1 "${dictionary[@]}" \
  -artifact_prefix="$folder/failed_$name-" "$corpus" "$here/seeds/$name" > "$log" 2>&1; then
  runs=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  echo "fuzz: $name held for $seconds s, $runs inputs" >&2
else
  tail -n 100 "$log" >&2
  echo "fuzz: $name FAILED; $log has it all" >&2
  exit 1
fi
