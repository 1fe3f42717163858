#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Runs a suite as two processes at the same time, each on half of the processors: one runs the cases of the files given, the other
# runs the rest. For suites that wait more than they compute. Fails if either process fails.
#   in_two.sh PROGRAM FILE,FILE...
set -u
said=$(mktemp)
trap 'rm -f "$said"' EXIT

# Two lists of processors; empty on a single processor.
halves=$(awk '/^Cpus_allowed_list/ {
    split($2, runs, ",")
    for (i = 1; i in runs; ++i) {
        split(runs[i], ends, "-")
        for (cpu = ends[1]; cpu <= (2 in ends ? ends[2] : ends[1]); ++cpu) all[n++] = cpu
    }
    for (i = 0; i < n && n > 1; ++i) printf "%s%s", all[i], i + 1 == int(n / 2) ? " " : i + 1 < n ? "," : ""
}' /proc/self/status)

on() { # on WHICH COMMAND...
    cpus=$(echo "$halves" | cut -d' ' -f"$1")
    shift
    if [ -n "$cpus" ]; then taskset -c "$cpus" "$@"; else "$@"; fi
}

on 1 "$1" -d=true -sf="$2" >"$said" 2>&1 &
other=$!
on 2 "$1" -d=true -sfe="$2"
here=$?
wait $other
there=$?
cat "$said"
[ $here = 0 ] && exit $there
exit $here
