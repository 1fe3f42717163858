// SPDX-License-Identifier: Apache-2.0
#include "engine/run/record_drain.h"

#include <algorithm>

namespace fathom {

void RecordDrain::drain(bool all) {
    takeFrames();
    takeQueries();
    for (TickRow row;;) {
        if (!waiting_) {
            if (!channels_.ticks.pop(row)) {
                return;
            }
            waiting_ = row;
            // The set and the answer that this step obeyed were published before it, so they have arrived or
            // are in the queues.
            takeFrames();
            takeQueries();
        }
        if (!all && waiting_->generation > newestGeneration_) {
            return;
        }
        pass(*waiting_);
        waiting_.reset();
    }
}

void RecordDrain::takeFrames() {
    PublishedFrame* frame = nullptr;
    while (channels_.frames.pop(frame)) {
        if (frame->changed) {
            kept_.push_back(frame);
            newestGeneration_ = frame->fixtures.generation;
        }
        ++frames_;
        sink_.frame(*frame, kept_.back()->fixtures); // the first frame of a run always changes the set
        if (!frame->changed) {
            channels_.emptied.push(frame);
        }
    }
    while (kept_.size() > kKept) {
        giveBack(1); // steps may still obey the front
    }
}

void RecordDrain::giveBack(size_t i) {
    channels_.emptied.push(kept_[i]);
    kept_.erase(kept_.begin() + static_cast<std::ptrdiff_t>(i));
}

void RecordDrain::takeQueries() {
    QueryNote note;
    while (channels_.queries.pop(note)) {
        sink_.query(note);
        notes_.push_back(std::move(note));
    }
}

void RecordDrain::pass(const TickRow& row) {
    // The set before the obeyed one stays: if the device is lost, the CPU may answer about it again.
    while (kept_.size() > 2 && kept_[1]->fixtures.generation < row.generation) {
        giveBack(0);
    }
    while (!notes_.empty() && notes_.front().query < row.query) {
        notes_.pop_front();
    }
    sink_.step(row, obeyedBy(row));
}

ObeyedSet RecordDrain::obeyedBy(const TickRow& row) const {
    if (row.generation == 0) { // it obeyed no set
        return {nullptr, true, {}};
    }
    const auto found = std::ranges::find_if(
        kept_, [&](const PublishedFrame* frame) { return frame->fixtures.generation == row.generation; });
    if (found == kept_.end()) {
        return {};
    }
    ObeyedSet obeyed{*found, !notes_.empty() && notes_.front().query == row.query, {}};
    if (obeyed.known) {
        obeyed.behind = notes_.front().behind;
    }
    return obeyed;
}

} // namespace fathom
