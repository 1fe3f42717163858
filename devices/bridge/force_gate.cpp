// SPDX-License-Identifier: Apache-2.0
#include "devices/bridge/force_gate.h"

#include <algorithm>

namespace fathom {

void ForceGate::accept(const Wrench& wrench, uint64_t stamp) noexcept {
    if (!isFinite(wrench.force) || !isFinite(wrench.torque)) {
        ++notFinite_;
        close();
        return;
    }
    if (open_ && stamp < newest_) {
        return;
    }
    if (silent(stamp)) {
        silences_ += open_ ? 1 : 0;
        since_ = stamp;
    }
    wrench_ = wrench;
    newest_ = stamp;
    open_ = true;
}

void ForceGate::close() noexcept {
    open_ = false;
    wrench_ = {};
}

Wrench ForceGate::at(uint64_t now) const noexcept {
    if (silent(now)) {
        return {};
    }
    const double share = std::min(1.0, static_cast<double>(now - since_) / static_cast<double>(kRamp));
    return {clampLength(wrench_.force, forceLimit_ * share),
            clampLength(wrench_.torque, torqueLimit_ * share)};
}

} // namespace fathom
