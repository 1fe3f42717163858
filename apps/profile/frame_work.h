// SPDX-License-Identifier: Apache-2.0
// The minimum work of a frame's steps, and the time below which they cannot be on a machine.
#pragma once

#include "apps/profile/ceilings.h"
#include "apps/profile/frame_bench.h"
#include "apps/profile/query_limit.h"

#include <string>
#include <utility>
#include <vector>

namespace fathom::profile {

// The minimum work of one step. Operations are float32, counted from the formulas of the pass.
struct StepWork {
    double bytes = 0.0, operations = 0.0;
    enum class Where { Device, Host, ThreadPool } where = Where::Device; // ThreadPool: the publishing threads
    // Bytes read from the images' memory or written to the host's, not included in `bytes`.
    double across = 0.0;
};

// The sizes of a frame that determine its minimum work.
struct FrameLoad {
    double pixels, slots, guidedSlots, selected, guided, spheres, packed, tapsPerPixel, cells,
        colourBytes; // counts; packed: bytes; colourBytes: bytes per pixel
    bool occlusion, hold, inPlace, pack, keepDepth, thin, thinsWithin, tree;
    QueryWork query; // of a query on the device; empty without one
};

FrameLoad loadOf(const FrameBench& bench, const FrameReport& report);

// Step and its work. Each buffer counts once, however often a pass reads it, as with a perfect cache.
std::vector<std::pair<std::string, StepWork>> workOf(const FrameLoad& load);

// Time [ms] below which a step cannot be; 0 = it has no work. No pass is faster than an empty dispatch.
struct StepFloor {
    double moving = 0.0, computing = 0.0, dispatch = 0.0;

    double least() const {
        const double work = std::max(moving, computing);
        return work > 0.0 ? std::max(work, dispatch) : 0.0;
    }
    const char* by() const {
        return dispatch > std::max(moving, computing) ? "dispatch"
               : computing > moving                   ? "arithmetic"
                                                      : "bytes";
    }
};

// inPlace: as readingMs().
StepFloor floorOf(const StepWork& need, const Ceilings& c, bool inPlace);

} // namespace fathom::profile
