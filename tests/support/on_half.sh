#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Runs a program on the first or the second half of the processors, so that two suites that run in real time do not disturb each other.
# IDLE: on what all others leave of the processors.
#   on_half.sh 1|2|IDLE PROGRAM [ARG...]
set -eu
half=$1
shift
if [ "$half" = IDLE ]; then
    ! chrt --idle 0 true 2>/dev/null || exec chrt --idle 0 "$@"
    exec nice -n 19 "$@"
fi

# The processors of that half; empty on a single processor.
cpus=$(awk -v half="$half" '/^Cpus_allowed_list/ {
    split($2, runs, ",")
    for (i = 1; i in runs; ++i) {
        split(runs[i], ends, "-")
        for (cpu = ends[1]; cpu <= (2 in ends ? ends[2] : ends[1]); ++cpu) all[n++] = cpu
    }
    from = half == 1 ? 0 : int(n / 2)
    end = half == 1 ? int(n / 2) : n
    for (i = from; i < end && n > 1; ++i) printf "%s%s", all[i], i + 1 < end ? "," : ""
}' /proc/self/status)
[ -z "$cpus" ] || exec taskset -c "$cpus" "$@"
exec "$@"
