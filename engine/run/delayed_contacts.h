// SPDX-License-Identifier: Apache-2.0
// The contact answers of a run in lockstep: each is put on offer a fixed number of queries later.
#pragma once

#include "engine/run/active_contacts.h"

#include <deque>
#include <memory>

namespace fathom {

// One thread.
class DelayedContacts {
public:
    void push(std::unique_ptr<ContactSet> answer) { waiting_.push_back(std::move(answer)); }

    // Puts the oldest answer that waits on offer, if more than `delay` wait. Call it once per query.
    void offerDue(size_t delay) {
        if (waiting_.size() > delay) {
            contacts_.offer([this] { return std::move(waiting_.front()); });
            waiting_.pop_front();
        }
    }

    // Like ActiveContacts.
    StepRecord step(HapticCycle& cycle, const StepInput& input) noexcept {
        return contacts_.step(cycle, input);
    }
    const ContactSet* active() const noexcept { return contacts_.active(); }

private:
    std::deque<std::unique_ptr<ContactSet>> waiting_; // oldest first
    ActiveContacts<std::unique_ptr<ContactSet>> contacts_;
};

} // namespace fathom
