// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/recorded_ticks.h"

#include "apps/operate/event_marks.h"
#include "apps/operate/tick_log.h"

#include <algorithm>

namespace fathom::operate {

namespace {

constexpr size_t kKeptNumbers = 60; // a tick may use an older frame

} // namespace

void RecordedTicks::open(const std::filesystem::path& folder) {
    waiting_.clear();
    numbers_.clear();
    last_ = -1.0;
    folder_ = folder;
    marks_ = 0;
    marksFile_.close();
    hand_.open(folder / "hand.csv", "t_s,x,y,z,qw,qx,qy,qz,button");
    wrench_.open(folder / kWrenchFile, wrenchHeader());
    touches_.open(folder / kTouchesFile, touchesHeader());
}

void RecordedTicks::number(int64_t frame, uint64_t image) {
    numbers_.emplace_back(frame, image);
    if (numbers_.size() > kKeptNumbers) {
        numbers_.pop_front();
    }
}

void RecordedTicks::flush(double from, double to, double start, double scale) {
    for (; !waiting_.empty() && waiting_.front().row.record.t < to; waiting_.pop_front()) {
        const Waiting& tick = waiting_.front();
        if (tick.row.record.t >= from) {
            put(tick, start + scale * (tick.row.record.t - from));
        }
    }
    hand_.flush();
    wrench_.flush(); // a tick is flushed before its touches
    touches_.flush();
    marksFile_.flush();
}

void RecordedTicks::put(const Waiting& tick, double t) {
    const TickRow& row = tick.row;
    if (!(t > last_)) {
        return; // times in hand.csv must be ascending
    }
    last_ = t;
    const dvec3& p = row.hand.deviceThandle.position;
    const dquat& q = row.hand.deviceThandle.rotation;
    hand_.lines() << t << "," << p.x << "," << p.y << "," << p.z << "," << q.w << "," << q.x << "," << q.y
                  << "," << q.z << "," << row.hand.buttons << "\n";
    writeTick(wrench_.lines(), touches_.lines(), t, imageOf(row.record.frame), row.record);
    if (tick.marked) {
        if (!marksFile_.isOpen()) {
            marksFile_.open(folder_ / kMarksFile, kMarksHeader);
        }
        marksFile_.lines() << t << ",mark " << ++marks_ << "\n";
    }
}

int64_t RecordedTicks::imageOf(int64_t frame) const {
    const auto at = std::find_if(numbers_.rbegin(), numbers_.rend(),
                                 [&](const auto& number) { return number.first <= frame; });
    return at == numbers_.rend() ? -1 : static_cast<int64_t>(at->second);
}

} // namespace fathom::operate
