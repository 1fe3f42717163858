// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/frame_pace.h"

#include <algorithm>
#include <ctime>

namespace fathom::operate {

void FramePace::note(double cpu) {
    constexpr double kNew = 0.05; // weight of the newest frame
    if (before_ >= 0.0) {
        const double now = cpu - before_;
        cost_ = cost_ > 0.0 ? cost_ + kNew * (now - cost_) : now;
    }
    before_ = cpu;
}

double FramePace::period() const {
    return limited_ ? std::clamp(cost_ / kShare, kFastest, kSlowest) : kFastest;
}

double threadCpuTime() {
    timespec time{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
    return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

} // namespace fathom::operate
