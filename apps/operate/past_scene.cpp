// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/past_scene.h"

#include "engine/types/colour_copy.h"
#include "engine/types/error.h"

#include <algorithm>
#include <cmath>

namespace fathom::operate {

namespace {

constexpr double kMaxLead = 90.0; // [frames] processed before the shown one, however long points are held

} // namespace

PastScene::PastScene(Session& session)
    : session_(session)
    , frameCount_(session.camera->frameCount())
    , lead_(static_cast<uint32_t>(std::min(kMaxLead, std::ceil(session.scene.holdSeconds / kPeriod) + 1.0))) {
    if (frameCount_ == 0) {
        throw BadInput(session.camera->description(), "recording", "it has no random access to frames",
                       "a recording folder (TUM RGB-D)");
    }
}

void PastScene::takeEdit(uint32_t index) {
    const SceneEdit* edit = session_.edits.empty() ? nullptr : &session_.edits.at(index);
    if (edit != std::exchange(edit_, edit)) {
        session_.cycles.frames().setScene(edit->scene);
        newScene_ = &edit->scene;
    }
}

bool PastScene::process(uint32_t index, PublishedFrame& out) {
    session_.camera->seek(index);
    std::optional<Frame> frame = session_.camera->next();
    if (!frame) {
        return false;
    }
    out.t = (*frame)->index * kPeriod;
    takeEdit((*frame)->index);
    frame->retime(out.t);
    readColours(**frame, out.colour);
    out.report = session_.cycles.frames().process(std::move(*frame));
    out.changed = true;
    return true;
}

void PastScene::show(uint32_t index, bool whole, SnapshotSink& sink) {
    index = std::min(index, frameCount_ - 1);
    if (any_ && index == requested_ && (whole_ || !whole)) {
        return;
    }
    const bool follows = any_ && whole_ && index > shown_ && index - shown_ <= lead_;
    uint32_t first = index;
    if (follows) {
        first = shown_ + 1;
    } else {
        session_.cycles.frames().forget();
        first = whole ? index - std::min(index, lead_) : index;
    }
    PublishedFrame frame;
    bool good = false;
    for (uint32_t i = first; i <= index; ++i) {
        const bool more = process(i, frame);
        good = good || more;
        i = more ? std::max(i, frame.report.index) : index; // skips a bad frame
    }
    requested_ = index;
    any_ = true;
    whole_ = whole || follows || first == 0;
    if (good) {
        shown_ = frame.report.index;
        const auto set = session_.cycles.frames().sets().newest();
        sink.frame(frame, set->host);
    }
}

void PastScene::setScene(const Scene& scene) {
    session_.cycles.frames().setScene(scene);
    any_ = false;
}

} // namespace fathom::operate
