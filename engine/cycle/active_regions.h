// SPDX-License-Identifier: Apache-2.0
// Age and changes of the regions that the haptic step obeys.
#pragma once

#include "engine/cycle/step_record.h"

#include <limits>

namespace fathom {

// One thread; noexcept, no allocation.
class ActiveRegions {
public:
    // [s] age of the scene in this step; set: active, null = none. Once the source of frames has ended, the
    // scene no longer ages.
    double age(const StepInput& input, const ContactSet* set) noexcept;
    // True if the regions differ from those of the last call: another fixture set, or edited() shapes.
    bool changed(const ContactSet* set) noexcept;
    // The placed shapes were replaced.
    void edited() noexcept { edited_ = true; }

private:
    uint64_t generation_ = 0;
    bool edited_ = false;
    double age_ = std::numeric_limits<double>::infinity(); // [s]
};

} // namespace fathom
