// SPDX-License-Identifier: Apache-2.0
#include "apps/binding/contact_loop.h"

namespace fathom {

void ContactLoop::run(const std::atomic<bool>& stop) {
    while (!stop.load(std::memory_order_relaxed)) {
        if (crossings_.proxy.refresh()) {
            answerOne(crossings_.proxy.front());
        } else {
            clock_.sleepUntil(clock_.now() + pause_);
        }
    }
}

void ContactLoop::answerOne(const ToolState& place) {
    ContactSet& set = crossings_.contacts.back();
    const auto begin = std::chrono::steady_clock::now();
    if (!answers_.answer(place, set)) {
        return;
    }
    const auto end = std::chrono::steady_clock::now();
    note_.query = set.query;
    note_.micros = std::chrono::duration<double, std::micro>(end - begin).count();
    note_.behind.clear();
    for (const ContactSet::Behind& b : set.behind) {
        note_.behind.push_back(b.leaf);
    }
    // First the note: the writer must know the answer before any turn obeys it.
    crossings_.queries.push(note_);
    crossings_.contacts.publish();
    if (trace_ != nullptr) {
        trace_->query(begin, end, set.size()); // ours until the next back(): readers only read it
    }
}

} // namespace fathom
