// SPDX-License-Identifier: Apache-2.0
// Keeps the active contact set, and the newer one that the haptic cycle may adopt.
#pragma once

#include "engine/cycle/haptic_cycle.h"

#include <utility>

namespace fathom {

// Handle: owns or points to a ContactSet, empty by default, movable, noexcept: a lease, a unique_ptr, a
// pointer. A set on offer that the cycle does not adopt stays on offer until a newer one
// replaces it. Haptic thread only.
template <class Handle>
class ActiveContacts {
public:
    // Replaces the set on offer by newest(). Releases the old one first, so that at most two sets are held.
    // Does not offer the active set again.
    template <class Newest>
    void offer(Newest&& newest) noexcept {
        offered_ = Handle{};
        offered_ = newest();
        if (offered_ && active_ && offered_->query == active_->query) {
            offered_ = Handle{};
        }
    }

    // Runs one step of the cycle. The set on offer becomes active if the cycle adopts it.
    StepRecord step(HapticCycle& cycle, StepInput input) noexcept {
        input.active = active_ ? &*active_ : nullptr;
        input.offered = offered_ ? &*offered_ : nullptr;
        StepRecord record = cycle.step(input);
        if (record.adopted) {
            active_ = std::move(offered_);
            offered_ = Handle{};
        }
        return record;
    }

    // The set that the last step obeyed; null if there was none.
    const ContactSet* active() const noexcept { return active_ ? &*active_ : nullptr; }
    const ContactSet* offered() const noexcept { return offered_ ? &*offered_ : nullptr; }

private:
    Handle active_{}, offered_{};
};

} // namespace fathom
