// SPDX-License-Identifier: Apache-2.0
// Largest error of each frame pass against its float64 twin. Each twin gets the same input as its pass,
// so errors of one pass do not count in the next.
#pragma once

#include "apps/stability/precision_rig.h"
#include "engine/reference/hold.h"

namespace fathom::stability {

// Lengths are fractions of the range unless noted. `wrong` counts decisions that differ although the value is
// farther from the threshold than the float32 error.
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
                    double range); // wrong: children outside parents, bad counts; radii rounded up
PassError momentsError(const PrecisionRig& rig, double range); // error of the mean
PassError guidanceError(const PrecisionRig& rig);              // [rad] error of the normal
PassError occlusionError(const PrecisionRig& rig, double range);
// One frame of a sequence; updates the twin's memory. now, before: capture times [s].
PassError holdError(const PrecisionRig& rig, reference::HoldMemory& twin, double now, double before,
                    double range);

} // namespace fathom::stability
