// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/last_seconds.h"

#include "apps/operate/packed_image.h"
#include "apps/operate/recorder.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <thread>
#include <unistd.h>

namespace fathom::operate {

size_t LastSeconds::defaultMemory() {
    constexpr size_t kMax = size_t{1} << 30;
    const long pages = ::sysconf(_SC_PHYS_PAGES), size = ::sysconf(_SC_PAGESIZE);
    return pages > 0 && size > 0 ? std::min(kMax, static_cast<size_t>(pages) * static_cast<size_t>(size) / 8)
                                 : kMax / 4;
}

double KeptPast::seconds() const {
    return frames.empty() ? 0.0 : frames.back()->frame.t - frames.front()->frame.t;
}

void LastSeconds::edit(KeptScene scene) {
    const std::lock_guard lock(mutex_);
    scenes_.push_back(std::move(scene));
}

KeptPast LastSeconds::past() const {
    const std::lock_guard lock(mutex_);
    KeptPast past;
    past.frames.assign(frames_.begin(), frames_.end());
    if (!scenes_.empty()) {
        past.first = scenes_.front();
        past.later.assign(scenes_.begin() + 1, scenes_.end());
    }
    return past;
}

double LastSeconds::seconds() const {
    const std::lock_guard lock(mutex_);
    return frames_.empty() ? 0.0 : frames_.back()->frame.t - frames_.front()->frame.t;
}

size_t LastSeconds::bytes() const {
    const std::lock_guard lock(mutex_);
    return totalBytes();
}

// A run whose time begins again has no past.
void LastSeconds::forgetOld() {
    const auto outOfSpan = [&] {
        const double age = frames_.back()->frame.t - frames_.front()->frame.t;
        return age > kSpan || age < 0.0 || totalBytes() > most_;
    };
    while (!frames_.empty() && outOfSpan()) {
        bytes_ -= frames_.front()->bytes();
        frames_.pop_front();
    }
    while (scenes_.size() > 1 && !frames_.empty() && scenes_[1].number <= frames_.front()->frame.edit) {
        scenes_.pop_front();
    }
}

void LastSeconds::frame(const PublishedFrame& frame, const HostFixtures& set) {
    if (most_ > 0) {
        auto kept = std::make_shared<KeptFrame>();
        kept->frame.report = frame.report;
        kept->frame.t = frame.t;
        kept->frame.edit = frame.edit;
        kept->frame.allFrozen = frame.allFrozen;
        kept->baseTcamera = set.baseTcamera;
        kept->pixels = set.depth.size();
        kept->colourPixels = frame.colour.size();
        kept->depth = packDepth(set.depth);
        kept->colour = packColour(frame.colour);
        const std::lock_guard lock(mutex_);
        if (open_) {
            bytes_ += open_->bytes();
            frames_.push_back(std::move(open_));
        }
        open_ = std::move(kept);
        forgetOld();
    }
    ForwardingSink::frame(frame, set);
}

void LastSeconds::step(const TickRow& row, const ObeyedSet& obeyed) {
    if (open_) { // changed by this thread only
        const std::lock_guard lock(mutex_);
        const bool marked = marked_.exchange(false);
        const bool fits =
            std::abs(row.record.t - open_->frame.t) <= kSpan && open_->bytes() + sizeof(TickRow) <= most_;
        if (fits) {
            if (marked) {
                open_->marks.push_back(open_->ticks.size());
            }
            open_->ticks.push_back(row);
            forgetOld();
        }
    }
    ForwardingSink::step(row, obeyed);
}

void feed(Recorder& recorder, const KeptPast& past) {
    for (const KeptScene& scene : past.later) {
        recorder.edit(scene.number, scene.recorded);
    }
    for (const auto& kept : past.frames) {
        while (recorder.recording() && recorder.busy()) {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        }
        PublishedFrame frame = kept->frame;
        frame.colour = unpackColour(kept->colour, kept->colourPixels);
        HostFixtures set;
        set.depth = unpackDepth(kept->depth, kept->pixels);
        set.baseTcamera = kept->baseTcamera;
        recorder.frame(frame, set);
        for (size_t i = 0; i < kept->ticks.size(); ++i) {
            if (std::find(kept->marks.begin(), kept->marks.end(), i) != kept->marks.end()) {
                recorder.mark();
            }
            recorder.step(kept->ticks[i], {});
        }
    }
}

} // namespace fathom::operate
