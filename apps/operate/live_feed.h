// SPDX-License-Identifier: Apache-2.0
// Camera and passes as the threads of a run see them, with what the window may change meanwhile.
#pragma once

#include "apps/operate/operate_session.h"
#include "engine/run/contact_loop.h"
#include "engine/run/frame_loop.h"
#include "engine/types/colour_copy.h"

#include <atomic>
#include <mutex>
#include <optional>

namespace fathom::operate {

// fetch() and publish() on the frame cadence; the rest from the window.
class LiveFeed final : public FrameFeed {
public:
    explicit LiveFeed(OperateSession& session);

    std::optional<uint32_t> fetch() override;
    std::optional<RunClock::Time> captured() const override;
    void armAtCapture(const ToolState& place) override;
    void publish(double t, PublishedFrame& out) override;
    bool renewable() const override { return true; }
    bool lost() const override { return session_.handover.lost(); }
    void renew(const std::atomic<bool>& stop) override;

    // A run begins: should its first picture find the device lost, the set that was is what it begins with.
    void begin() { begins_ = true; }
    // Takes effect with the next picture, whose PublishedFrame::edit has this number or a later one's. Same
    // classes of points as before.
    uint64_t setScene(const Scene& scene);
    // Frozen: pictures are taken and shown but the set in force stays, for all fixtures.
    void freeze(bool frozen) { frozen_.store(frozen); }
    // Passes are on the device: who shares its queue waits.
    bool busy() const { return busy_.load(std::memory_order_acquire); }

private:
    void takeScene();
    FrameReport process();
    void publishNew(PublishedFrame& out);

    OperateSession& session_;
    std::optional<Frame> next_;
    double taken_ = 0.0; // [s] on a live camera's clock
    ColourCopy colours_;
    std::atomic<bool> busy_{false}, frozen_{false}, edited_{false};
    std::mutex sceneMutex_; // of pending_; never taken by the haptic thread
    Scene pending_;
    uint64_t told_ = 0;    // changes; with sceneMutex_
    uint64_t inForce_ = 0; // the newest of them that pictures obey
    bool published_ = false, begins_ = false;
};

class LiveAnswers final : public ContactAnswers {
public:
    explicit LiveAnswers(OperateSession& session)
        : session_(session) {}
    bool answer(const ToolState& place, ContactSet& out) override;

private:
    OperateSession& session_;
};

} // namespace fathom::operate
