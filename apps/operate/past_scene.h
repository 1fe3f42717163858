// SPDX-License-Identifier: Apache-2.0
// The pictures of a recording through the passes again, any of them at any time.
#pragma once

#include "apps/operate/operate_session.h"
#include "apps/operate/snapshots.h"

#include <utility>

namespace fathom::operate {

// Thread: the window's; no other uses the session's frame cycle.
class PastScene {
public:
    // Throws BadInput when one cannot choose among the session's pictures.
    explicit PastScene(OperateSession& session);

    static constexpr double kPeriod = 1.0 / 30.0; // [s] from picture to picture, as in `replay`

    uint32_t images() const { return images_; }
    // Leaves picture `index` (or the next good one) and its fixtures in `sink`. whole: with the points that
    // are held from pictures before it, which takes a run through those; otherwise of this picture alone.
    // Nothing when that is what is shown already.
    void show(uint32_t index, bool whole, SnapshotSink& sink);
    bool whole() const { return whole_; }
    uint32_t shown() const { return shown_; } // the picture's own index
    void retake() { any_ = false; }           // the next show() makes the picture anew, on another device
    // Other fixtures, of the same classes of points; the next show() makes the picture anew.
    void setScene(const Scene& scene);
    // The pilot's own, of the picture that is shown, when they are others than at the call before; else null.
    // While pictures were without a set of their own, all fixtures held, they have one here.
    const Scene* newScene() { return std::exchange(newScene_, nullptr); }

private:
    bool process(uint32_t index, PublishedFrame& out);
    void takeEdit(uint32_t index);

    OperateSession& session_;
    uint32_t images_, lead_;
    uint32_t asked_ = 0, shown_ = 0;
    bool any_ = false, whole_ = false;
    const SceneEdit* edit_ = nullptr; // in force
    const Scene* newScene_ = nullptr;
};

} // namespace fathom::operate
