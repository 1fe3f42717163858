// SPDX-License-Identifier: Apache-2.0
#include "engine/run/frame_loop.h"

#include "engine/types/error.h"
#include "engine/types/log.h"

#include <algorithm>
#include <cmath>
#include <thread>
#include <utility>

namespace fathom {

FrameLoop::FrameLoop(FrameFeed& feed, Channels& channels, const RunClock& clock, double period,
                     CadenceTrace* trace)
    : feed_(feed)
    , channels_(channels)
    , clock_(clock)
    , period_(period)
    , trace_(trace) {}

bool FrameLoop::first() {
    const std::optional<uint32_t> index = feed_.fetch();
    if (!index) {
        return false;
    }
    firstIndex_ = *index;
    update_.live = feed_.captured().has_value();
    publish(0.0, kNeverStop);
    return true;
}

// Retries a lost camera with growing pauses, while the last set ages and the forces fade.
std::optional<uint32_t> FrameLoop::fetch(const std::atomic<bool>& stop) {
    RetryPause pause;
    while (!stop.load(std::memory_order_relaxed)) {
        try {
            const std::optional<uint32_t> index = feed_.fetch();
            if (std::exchange(cameraGone_, false)) {
                log::warn("camera is back");
                origin_ = clock_.now() - period_ * ((index ? *index : firstIndex_) - firstIndex_);
            }
            ended_ = !index;
            return index;
        } catch (const DeviceLost& e) {
            if (!std::exchange(cameraGone_, true)) {
                log::warn("camera is gone ({}): the scene ages, forces fade", e.what());
                publishUpdate();
            }
            if (feed_.lost()) {
                log::warn("GPU is gone, too: reopening it");
                renew(stop);
            }
            clock_.sleepUntil(clock_.now() + pause.next(), stop);
        }
    }
    return std::nullopt;
}

void FrameLoop::run(const std::atomic<bool>& stop) {
    while (const std::optional<uint32_t> index = fetch(stop)) {
        if (const std::optional<RunClock::Time> taken = feed_.captured()) {
            update_.live = true;
            publishOrRenew(std::max(clock_.at(*taken), update_.captureTime),
                           stop); // not before the start of the run
            continue;
        }
        const double due = origin_ + period_ * (*index - firstIndex_);
        clock_.sleepUntil(due, stop);
        if (stop.load(std::memory_order_relaxed)) {
            return;
        }
        publishOrRenew(clock_.now(), stop);
        countLost(due);
    }
    if (ended_ && !update_.live) { // the scene of a live source ages when its frames end
        update_.sourceEnded = true;
        publishUpdate();
    }
}

void FrameLoop::countLost(double due) {
    const double periods = std::floor((clock_.now() - due) / period_);
    if (periods >= 2.0) { // two more frames became due before this one was done
        lost_ += static_cast<uint64_t>(periods) - 1;
        origin_ += (periods - 1.0) * period_;
    }
}

void FrameLoop::publishOrRenew(double t, const std::atomic<bool>& stop) {
    try {
        publish(t, stop);
        retry_.reset();
        return;
    } catch (const DeviceFailed& e) {
        if (!feed_.renewable()) {
            throw;
        }
        log::warn("GPU is gone ({}): the scene ages, forces fade; reopening it", e.what());
    }
    renew(stop);
}

// Retries with growing pauses, until a frame is processed again.
void FrameLoop::renew(const std::atomic<bool>& stop) {
    deviceGone_ = true;
    publishUpdate();
    while (!stop.load(std::memory_order_relaxed)) {
        clock_.sleepUntil(clock_.now() + retry_.next(), stop);
        try {
            feed_.renew(stop);
            log::warn("GPU is back");
            deviceGone_ = false;
            publishUpdate();
            return;
        } catch (const DeviceFailed& e) {
            log::debug("GPU: {}", e.what());
        }
    }
}

PublishedFrame* FrameLoop::emptyFrame(const std::atomic<bool>& stop) {
    PublishedFrame* frame = std::exchange(spare_, nullptr);
    if (frame != nullptr) {
        return frame;
    }
    while (!channels_.emptied.pop(frame)) {
        if (owned_.size() < Channels::kFramesInFlight) {
            owned_.push_back(std::make_unique<PublishedFrame>());
            return owned_.back().get();
        }
        if (stop.load(std::memory_order_relaxed)) {
            return nullptr; // a writer that failed returns no frames
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(1)); // the writer is far behind
    }
    return frame;
}

void FrameLoop::publish(double t, const std::atomic<bool>& stop) {
    PublishedFrame* frame = emptyFrame(stop);
    if (frame == nullptr) {
        return;
    }
    const PostureTrack& track = channels_.arm != nullptr ? channels_.arm->measured : channels_.postures;
    if (const auto posture = track.nearest(clock_.timeAt(t))) {
        feed_.armAtCapture(*posture);
    }
    spare_ = frame; // if publish() throws
    feed_.publish(t, *frame);
    spare_ = nullptr;
    frame->t = t;
    if (frame->changed) {
        update_.show(frame->fixtures);
    }
    update_.captureTime = t;
    publishUpdate();
    if (trace_ != nullptr) {
        trace_->frame(frame->report);
    }
    channels_.frames.push(frame); // has room for all of them
}

void FrameLoop::publishUpdate() {
    update_.gone = cameraGone_ || deviceGone_;
    channels_.scene.back() = update_;
    channels_.scene.publish();
}

} // namespace fathom
