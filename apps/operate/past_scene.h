// SPDX-License-Identifier: Apache-2.0
// Processes the frames of a recording again, in any order.
#pragma once

#include "apps/operate/snapshots.h"
#include "apps/session/session.h"
#include "engine/types/frame.h"

#include <utility>

namespace fathom::operate {

// Window thread, the only user of the session's frame cycle.
class PastScene {
public:
    // Throws BadInput when the source cannot seek.
    explicit PastScene(Session& session);

    static constexpr double kPeriod = kLockstepFramePeriod; // [s] between frames, as in `replay`

    uint32_t frames() const { return frameCount_; }
    // Sends frame `index` (or the next good one) and its fixtures to `sink`. whole: includes points held from
    // earlier frames, which are processed first; otherwise this frame alone. Does nothing when it is shown
    // already.
    void show(uint32_t index, bool whole, SnapshotSink& sink);
    bool whole() const { return whole_; }
    uint32_t shown() const { return shown_; } // index of the frame
    void retake() { any_ = false; }           // the next show() processes the frame again, on another device
    // Changes fixtures with the same classes of points; the next show() processes the frame again.
    void setScene(const Scene& scene);
    // The recorded fixtures of the shown frame when they changed since the last call; otherwise null. Frames
    // recorded while fixtures were frozen get a set of their own here.
    const Scene* newScene() { return std::exchange(newScene_, nullptr); }

private:
    bool process(uint32_t index, PublishedFrame& out);
    void takeEdit(uint32_t index);

    Session& session_;
    uint32_t frameCount_, lead_;
    uint32_t requested_ = 0, shown_ = 0;
    bool any_ = false, whole_ = false;
    const SceneEdit* edit_ = nullptr; // the active edit
    const Scene* newScene_ = nullptr;
};

} // namespace fathom::operate
