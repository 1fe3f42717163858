// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/active_regions.h"

#include <algorithm>

namespace fathom {

double ActiveRegions::age(const StepInput& input, const ContactSet* set) noexcept {
    // The active set may be older than the newest fixture set. While they are the same, the frame that
    // confirms it may be newer.
    const bool newest = set == nullptr || set->generation == input.generation;
    const double age = input.time - (newest ? input.captureTime : set->captureTime);
    age_ = input.sourceEnded ? std::min(age, age_) : age;
    if (input.sourceEnded && newest && age_ > kStaleAfter) {
        age_ = 0.0; // the last frame does not age, however late its regions became active
    }
    return age_;
}

bool ActiveRegions::changed(const ContactSet* set) noexcept {
    const uint64_t generation = set != nullptr ? set->generation : generation_;
    const bool changed = generation != generation_ || edited_;
    generation_ = generation;
    edited_ = false;
    return changed;
}

} // namespace fathom
