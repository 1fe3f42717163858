// SPDX-License-Identifier: Apache-2.0
// The frames that a live camera could not use.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace fathom {

// Counts them, and logs each cause once, at most kMaxCauses. One thread.
class SkippedFrames {
public:
    // camera: its description, for the log line. frames: skipped because of it; 0 = they are used.
    void add(const std::string& camera, const std::string& cause, uint32_t frames = 1);
    uint32_t count() const { return count_; }
    std::vector<std::string> causes() const { return {causes_.begin(), causes_.end()}; }
    // Throws DeviceLost: frames arrive, but none is usable.
    [[noreturn]] void fail(const std::string& camera) const;
    // fail() if frames were skipped since there were `before` of them, and `waited` [s] exceeds `most` [s].
    void limit(const std::string& camera, uint32_t before, double waited, double most) const;

    static constexpr size_t kMaxCauses = 32;

private:
    uint32_t count_ = 0;
    std::set<std::string> causes_;
    std::string last_;
};

} // namespace fathom
