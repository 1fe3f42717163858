// SPDX-License-Identifier: Apache-2.0
#include "devices/recorded/index_times.h"

#include "devices/recorded/set_back.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/median.h"

#include <algorithm>
#include <cmath>

namespace fathom {

namespace {

// Depth stamps that are equal to an earlier one, or less.
size_t countStill(const std::vector<IndexLine>& index) {
    double latest = -HUGE_VAL;
    size_t still = 0;
    for (const IndexLine& line : index) {
        still += line.fault.empty() && line.depthStamp <= latest ? 1 : 0;
        latest = line.fault.empty() ? std::max(latest, line.depthStamp) : latest;
    }
    return still;
}

std::vector<std::string> followClock(std::vector<IndexLine>& index) {
    const double period = medianPeriod(index);
    const auto stampOf = [&](size_t i) { return index[i].fault.empty() ? index[i].depthStamp : HUGE_VAL; };
    std::vector<std::string> changes;
    double last = -HUGE_VAL, shift = 0.0; // of the stamps as they are in the index
    for (size_t i = 0; i < index.size(); ++i) {
        const double stamp = stampOf(i);
        if (stamp < last && isSetBack(last, i, index.size(), stampOf)) {
            changes.push_back("the clock of depth goes back by " + std::to_string(last - stamp) +
                              " s at frame " + std::to_string(i) + ": times continue from there");
            shift += last + period - stamp;
            last = stamp;
        }
        last = std::isfinite(stamp) ? std::max(last, stamp) : last;
        index[i].depthStamp += shift;
        index[i].colourStamp += shift;
    }
    return changes;
}

} // namespace

// Median of the times between usable frames [s]; 0 for a single frame. A mean would follow a single pause.
double medianPeriod(const std::vector<IndexLine>& index) {
    std::vector<double> gaps;
    const IndexLine* last = nullptr;
    for (const IndexLine& line : index) {
        if (!line.fault.empty()) {
            continue;
        }
        if (last != nullptr && line.depthStamp > last->depthStamp) {
            gaps.push_back(line.depthStamp - last->depthStamp);
        }
        last = &line;
    }
    return gaps.empty() ? 0.0 : medianOf(gaps);
}

bool countFrames(const std::vector<IndexLine>& index) {
    constexpr size_t kFewest = 10;
    constexpr double kMax = 1e6; // seconds since 1970 are more
    const bool whole = std::ranges::all_of(index, [&](const IndexLine& line) {
        return line.depthStamp >= 0.0 && line.depthStamp < kMax &&
               line.depthStamp == std::floor(line.depthStamp);
    });
    return whole && index.size() >= kFewest && medianPeriod(index) == 1.0;
}

std::vector<std::string> settleTimes(RecordingLayout& layout, const std::filesystem::path& folder) {
    const size_t still = countStill(layout.index), all = layout.index.size();
    if (2 * still < all) {
        const auto changes = layout.poses ? std::vector<std::string>{} : followClock(layout.index);
        for (const std::string& line : changes) {
            log::warn("{}: {}", folder.string(), line);
        }
        return changes;
    }
    const std::string fault =
        std::to_string(still) + " of " + std::to_string(all) + " depth stamps do not rise";
    if (layout.poses) {
        throw BadInput(folder.string(), "index", fault,
                       "rising stamps, because poses.txt is matched by stamp");
    }
    log::warn("{}: {}: stamps are ignored, frames are played in the order of the index at 30 per second",
              folder.string(), fault);
    for (size_t i = 0; i < all; ++i) {
        layout.index[i].depthStamp = layout.index[i].colourStamp = static_cast<double>(i) / 30.0;
    }
    return {};
}

} // namespace fathom
