// SPDX-License-Identifier: Apache-2.0
#include "engine/run/contact_loop.h"

#include "engine/types/clock.h"

namespace fathom {

void ContactLoop::run(const std::atomic<bool>& stop) {
    while (!stop.load(std::memory_order_relaxed)) {
        if (channels_.queryAt.refresh()) {
            answerOne(channels_.queryAt.front());
        } else {
            clock_.sleepUntil(clock_.now() + pause_);
        }
    }
}

void ContactLoop::answerOne(const QueryPlace& at) {
    ContactSet& set = channels_.contacts.back();
    const auto begin = Clock::now();
    if (!answers_.answer(at, set)) {
        return;
    }
    const auto end = Clock::now();
    note_.query = set.query;
    note_.micros = micros(begin, end);
    set.leavesBehind(note_.behind);
    // The note comes first: the writer must know the answer before any step obeys it.
    channels_.queries.push(note_);
    channels_.contacts.publish();
    if (trace_ != nullptr) {
        trace_->query(begin, end, set.size()); // still readable until the next back()
    }
}

} // namespace fathom
