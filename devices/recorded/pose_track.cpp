// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/pose_track.h"

#include "devices/recorded/text_file.h"
#include "engine/types/error.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom {

PoseTrack::PoseTrack(const std::filesystem::path& file) {
    for (const TextLine& line : readDataLines(file)) {
        const auto refuse = [&](const std::string& allowed) {
            throw BadInput(file.string(), "line " + std::to_string(line.number), line.text.substr(0, 160),
                           allowed);
        };
        const std::vector<std::string_view> words = splitWords(line.text);
        std::array<double, 8> v{};
        bool good = words.size() == v.size();
        for (size_t i = 0; good && i < v.size(); ++i) {
            good = parseNumber(words[i], v[i]) && std::isfinite(v[i]);
        }
        if (!good) {
            refuse("eight finite numbers t tx ty tz qx qy qz qw");
        }
        const dquat q(v[7], v[4], v[5], v[6]);
        const double length = glm::length(q);
        if (!(length > 1e-6) || !std::isfinite(length)) {
            refuse("a quaternion qx qy qz qw of non-zero length");
        }
        if (!poses_.empty() && !(v[0] > poses_.back().t)) {
            refuse("a time later than in the previous line");
        }
        poses_.push_back({v[0], {{v[1], v[2], v[3]}, q / length}});
    }
    if (poses_.empty()) {
        throw BadInput(file.string(), "poses", "none", "at least one line t tx ty tz qx qy qz qw");
    }
}

Pose PoseTrack::at(double t) const noexcept {
    const auto after = std::upper_bound(poses_.begin(), poses_.end(), t,
                                        [](double time, const Stamped& p) { return time < p.t; });
    if (after == poses_.begin()) {
        return poses_.front().baseTcamera;
    }
    const Stamped& before = *(after - 1);
    if (after == poses_.end()) {
        return before.baseTcamera;
    }
    return interpolate(before.baseTcamera, after->baseTcamera, (t - before.t) / (after->t - before.t));
}

} // namespace fathom
