// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/live_feed.h"

namespace fathom::operate {

LiveFeed::LiveFeed(OperateSession& session)
    : session_(session) {
    if (session_.arm) {
        shown({Pose{}, session_.arm->startPosture()});
    }
}

void LiveFeed::shown(const ToolPlace& place) {
    if (session_.plan.selfFilter) {
        session_.frames.setArm(session_.arm->inPicture(place.arm));
    }
}

std::optional<uint32_t> LiveFeed::fetch() {
    next_ = session_.camera->next();
    return next_ ? std::optional((*next_)->index) : std::nullopt;
}

void LiveFeed::setScene(const Scene& scene) {
    const std::lock_guard lock(sceneMutex_);
    pending_ = scene;
    edited_.store(true);
}

void LiveFeed::takeScene() {
    if (edited_.exchange(false)) {
        const std::lock_guard lock(sceneMutex_);
        session_.frames.setScene(pending_);
    }
}

FrameReport LiveFeed::process() {
    session_.frames.upload(std::move(*next_));
    busy_.store(true, std::memory_order_release);
    session_.frames.submit();
    FrameReport report = session_.frames.finish();
    busy_.store(false, std::memory_order_release);
    return report;
}

void LiveFeed::publish(double t, PublishedFrame& out) {
    next_->retime(t);
    colour_.assign((*next_)->colour.begin(), (*next_)->colour.end());
    if (frozen_.load() && published_) {
        out.report.index = (*next_)->index;
        out.report.unchanged = true;
        out.changed = false;
        out.colour.swap(colour_);
        next_.reset();
        return;
    }
    takeScene();
    out.report = process();
    next_.reset();
    out.changed = !out.report.unchanged;
    if (out.changed) {
        const auto set = session_.frames.sets().newest();
        out.fixtures = set->host;
        out.grid = set->grid;
        published_ = true;
    }
    out.colour.swap(colour_);
}

bool LiveAnswers::answer(const ToolPlace& place, ContactSet& out) {
    const auto set = session_.frames.sets().newest();
    if (!set) {
        return false;
    }
    session_.contact.query(*set, place, out);
    return true;
}

} // namespace fathom::operate
