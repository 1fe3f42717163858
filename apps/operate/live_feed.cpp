// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/live_feed.h"

#include "engine/types/error.h"

#include <utility>

namespace fathom::operate {

LiveFeed::LiveFeed(OperateSession& session)
    : session_(session) {
    if (session_.arm) {
        armAtCapture({Pose{}, session_.arm->startPosture()});
    }
}

void LiveFeed::armAtCapture(const ToolState& place) {
    if (session_.cycles.plan().selfFilter && !lost()) {
        session_.cycles.frames().setArm(session_.arm->inImage(place.arm));
    }
}

std::optional<uint32_t> LiveFeed::fetch() {
    next_ = session_.camera->next();
    taken_ = next_ ? (*next_)->captureTime : taken_;
    return next_ ? std::optional((*next_)->index) : std::nullopt;
}

std::optional<RunClock::Time> LiveFeed::captured() const {
    return session_.camera->live() ? std::optional(RunClock::sinceBoot(taken_)) : std::nullopt;
}

uint64_t LiveFeed::setScene(const Scene& scene) {
    const std::lock_guard lock(sceneMutex_);
    pending_ = scene;
    edited_.store(true);
    return ++told_;
}

void LiveFeed::takeScene() {
    if (edited_.exchange(false)) {
        const std::lock_guard lock(sceneMutex_);
        session_.cycles.frames().setScene(pending_);
        inForce_ = told_;
    }
}

FrameReport LiveFeed::process() {
    FrameCycle& frames = session_.cycles.frames();
    try {
        frames.upload(std::move(*next_));
        busy_.store(true, std::memory_order_release);
        frames.submit();
        FrameReport report = frames.finish();
        busy_.store(false, std::memory_order_release);
        return report;
    } catch (const DeviceFailed& e) {
        busy_.store(false, std::memory_order_release);
        session_.handover.lose(e.what());
        throw;
    }
}

// What is on the old device goes before it, what is to be on the new one comes before forces do.
void LiveFeed::renew(const std::atomic<bool>& stop) {
    if (!session_.handover.awaitRelease(stop)) {
        throw DeviceLost("the run ends");
    }
    session_.cycles.renew();
    if (!session_.handover.offer(stop)) {
        throw DeviceLost(session_.handover.why());
    }
}

void LiveFeed::publish(double t, PublishedFrame& out) {
    const bool begins = std::exchange(begins_, false);
    next_->retime(t);
    colours_.take(**next_);
    out.report = {};
    out.report.index = (*next_)->index;
    out.edit = inForce_;
    out.still = false;
    try {
        publishNew(out);
    } catch (const DeviceFailed&) {
        out.changed = begins && session_.cycles.newestSet(out.fixtures, out.grid);
        next_.reset();
        if (!out.changed) {
            throw;
        }
    }
    next_.reset();
    colours_.giveTo(out.colour);
}

void LiveFeed::publishNew(PublishedFrame& out) {
    if (lost()) { // by the window
        throw DeviceLost(session_.handover.why());
    }
    out.still = out.report.unchanged = frozen_.load() && published_;
    if (!out.still) {
        takeScene();
        out.report = process();
    }
    out.edit = inForce_;
    out.changed = !out.report.unchanged;
    if (out.changed) {
        session_.cycles.newestSet(out.fixtures, out.grid);
        published_ = true;
    }
}

bool LiveAnswers::answer(const ToolState& place, ContactSet& out) {
    return session_.cycles.answer(place, out);
}

} // namespace fathom::operate
