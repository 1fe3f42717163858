// SPDX-License-Identifier: Apache-2.0
// Largest errors of each pass of a frame against its float64 twin, each twin fed with what the pass itself
// was fed, so that the errors of one pass do not count in the next.
#pragma once

#include "apps/stability/precision_rig.h"
#include "engine/reference/hold.h"

namespace fathom::stability {

// Lengths as shares of the range unless said otherwise. `wrong`: decisions that differ although the twin is
// sure of them (farther from their threshold than float32 can see).
struct PassError {
    double error = 0.0;
    uint64_t values = 0, wrong = 0, unsure = 0;

    void add(double e) {
        error = e > error || e != e ? e : error;
        ++values;
    }
    void add(const PassError& other);
};

PassError classifyError(const PrecisionRig& rig);
PassError surfaceError(const PrecisionRig& rig, double range);
PassError thinError(const PrecisionRig& rig, double range);
PassError sphereError(const PrecisionRig& rig, double range);
PassError treeError(const PrecisionRig& rig,
                    double range); // wrong: children outside their parents, counts; radii rounded outward
PassError momentsError(const PrecisionRig& rig, double range); // mean
PassError guidanceError(const PrecisionRig& rig);              // normal [rad]
PassError occlusionError(const PrecisionRig& rig, double range);
// One frame of a sequence: the twin's memory goes along. now, before: capture times [s].
PassError holdError(const PrecisionRig& rig, reference::HoldMemory& twin, double now, double before,
                    double range);

} // namespace fathom::stability
