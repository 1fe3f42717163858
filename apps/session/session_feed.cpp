// SPDX-License-Identifier: Apache-2.0
#include "apps/session/session_feed.h"

#include "engine/types/error.h"

#include <utility>

namespace fathom {

SessionFeed::SessionFeed(Session& session, std::function<void(const std::vector<Shape>&)> onShapes)
    : session_(session)
    , onShapes_(std::move(onShapes)) {
    if (session_.arm) {
        SessionFeed::armAtCapture(session_.arm->startPosture());
    }
}

void SessionFeed::armAtCapture(const ArmPosture& posture) {
    if (session_.cycles.plan().selfFilter && !lost()) {
        session_.cycles.frames().setArm(session_.arm->inImage(posture));
    }
}

std::optional<uint32_t> SessionFeed::fetch() {
    next_ = session_.camera->next();
    taken_ = next_ ? (*next_)->captureTime : taken_;
    return next_ ? std::optional((*next_)->index) : std::nullopt;
}

std::optional<RunClock::Time> SessionFeed::captured() const {
    return session_.camera->live() ? std::optional(RunClock::sinceBoot(taken_)) : std::nullopt;
}

uint64_t SessionFeed::setScene(const Scene& scene) {
    const std::lock_guard lock(sceneMutex_);
    pending_ = scene;
    edited_.store(true);
    return ++requested_;
}

// Applies the edits of a recording and of the window. True when all fixtures are frozen, so that the frame
// makes no set.
bool SessionFeed::takeEdits(uint32_t index) {
    FrameCycle& frames = session_.cycles.frames();
    if (const SceneEdit* edit = session_.newEdit(index)) {
        frames.setScene(edit->scene);
        if (onShapes_) {
            onShapes_(shapesOf(edit->scene));
        }
    }
    if ((frozen_.load() || session_.allFrozen()) && published_) {
        return true;
    }
    if (edited_.exchange(false)) {
        const std::lock_guard lock(sceneMutex_);
        frames.setScene(pending_);
        applied_ = requested_;
    }
    return false;
}

FrameReport SessionFeed::process() {
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
        if (session_.handover) {
            session_.handover->lose(e.what());
        }
        throw;
    }
}

// Opens a lost device again. A window that draws on it must release the old device first, and must be on the
// new one before forces return.
void SessionFeed::renew(const std::atomic<bool>& stop) {
    DeviceHandover* handover = session_.handover.get();
    if (handover != nullptr && !handover->awaitRelease(stop)) {
        throw DeviceLost("the run ends");
    }
    session_.cycles.renew();
    if (handover != nullptr && !handover->offer(stop)) {
        throw DeviceLost(handover->why());
    }
}

void SessionFeed::publish(double t, PublishedFrame& out) {
    const bool begins = std::exchange(begins_, false);
    next_->retime(t);
    colours_.take(**next_);
    out.report = {};
    out.report.index = (*next_)->index;
    out.edit = applied_;
    out.allFrozen = false;
    try {
        publishNew(out);
    } catch (const DeviceFailed&) {
        out.changed = begins && session_.cycles.copyNewestSet(out.fixtures, out.grid);
        next_.reset();
        if (!out.changed) {
            throw;
        }
    }
    next_.reset();
    colours_.giveTo(out.colour);
}

void SessionFeed::publishNew(PublishedFrame& out) {
    if (lost()) { // the window detected the loss
        throw DeviceLost(session_.handover->why());
    }
    out.allFrozen = takeEdits(out.report.index);
    out.report = out.allFrozen ? session_.cycles.frames().unprocessedReport(out.report.index) : process();
    out.edit = applied_;
    out.changed = !out.report.unchanged;
    if (out.changed) {
        session_.cycles.copyNewestSet(out.fixtures, out.grid);
        published_ = true;
    }
}

} // namespace fathom
