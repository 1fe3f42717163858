// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/spread.h"

#include "engine/types/clock.h"

#include <algorithm>
#include <ctime>
#include <limits>

namespace fathom::profile {

namespace {

constexpr size_t kMinForP99 = 100;

double threadSeconds() {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

} // namespace

Spread spreadOf(std::vector<double> values) {
    if (values.empty()) {
        return {};
    }
    std::sort(values.begin(), values.end());
    const auto rank = [&](size_t percent) {
        return values[std::max<size_t>(1, (percent * values.size() + 99) / 100) - 1];
    };
    const double none = std::numeric_limits<double>::quiet_NaN();
    return {rank(50), rank(90), values.size() >= kMinForP99 ? rank(99) : none, values.size()};
}

Clocks::Clocks()
    : cpu_(threadSeconds())
    , wall_(Clock::now()) {}

double Clocks::wallMs() const {
    return millis(wall_, Clock::now());
}

double Clocks::cpuMs() const {
    return (threadSeconds() - cpu_) * 1e3;
}

} // namespace fathom::profile
