// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/frame_work.h"

#include "engine/cloud/frame_params.h"
#include "engine/cycle/frame_cycle.h"

#include "shaders/shared/frame_params.h"

#include <algorithm>

namespace fathom::profile {

namespace {

// Class bits of all guidance classes.
uint32_t guidanceBits(const Scene& scene) {
    const std::vector<uint32_t> fixtures = cloud::classFixtures(scene);
    uint32_t bits = 0;
    for (size_t c = 0; c < fixtures.size(); ++c) {
        bits |= scene.fixtures[fixtures[c]].role == Role::Guidance ? 1u << c : 0u;
    }
    return bits;
}

} // namespace

FrameLoad loadOf(const FrameBench& bench, const FrameReport& report) {
    const auto masks = bench.masks();
    FrameLoad load{};
    load.pixels = static_cast<double>(masks.size());
    load.selected = static_cast<double>(std::ranges::count_if(masks, [](uint32_t m) { return m != 0; }));
    std::vector<uint8_t> listed(bench.cycle().layout().patches(), 0), guided(listed);
    const uint32_t width = bench.cycle().camera().depth.width, guidance = guidanceBits(bench.scene());
    for (uint32_t i = 0; i < masks.size(); ++i) {
        const uint32_t patch = slotOfPixel(i % width, i / width, bench.cycle().layout().across) / 256;
        const uint32_t guides = masks[i] & guidance;
        listed[patch] = std::max<uint8_t>(listed[patch], masks[i] != 0);
        guided[patch] = std::max<uint8_t>(guided[patch], guides != 0);
        load.guided += guides != 0 ? 1.0 : 0.0;
    }
    load.slots = 256.0 * static_cast<double>(std::ranges::count(listed, 1));
    load.guidedSlots = 256.0 * static_cast<double>(std::ranges::count(guided, 1));
    load.spheres = report.counts.spheres;
    const double edge = 2.0 * bench.plan().filterRadius + 1.0;
    load.tapsPerPixel = bench.plan().filterRadius > 0 ? edge * edge : 0.0;
    load.occlusion = bench.plan().occlusion;
    const cloud::WorkBuffers& work = bench.cycle().work();
    load.cells = load.occlusion ? static_cast<double>(work.cellsAcross) * work.cellsDown : 0.0;
    load.hold = bench.plan().hold;
    load.colourBytes = bench.colourBytesPerPixel();
    load.inPlace = report.inPlace;
    load.keepDepth = bench.plan().keepDepth;
    load.pack = bench.plan().pack;
    load.packed = 4.0 * bench.set().device.counters.as<shared::FrameCounters>()[0].packedWords;
    load.thin = bench.plan().thin;
    load.thinsWithin = load.thin && !bench.plan().thins();
    load.tree = bench.plan().tree;
    return load;
}

namespace {

double thinOperations(const FrameLoad& l) {
    return l.slots / 16.0 * 25.0 * 45.0;
}

// Bytes of `spheres`: points, class bits, thinning and forbidden bits; with hold also the earlier points, the
// depth and the current points (nothing is held here, so the hold memory is not touched); then the output for
// a query or the host, which packed spheres are written to.
StepWork spheresNeed(const FrameLoad& l) {
    const double hold = l.hold ? 16.0 + 2.0 + 16.0 : 0.0;
    const double layers = l.hold ? 2.0 : 1.0;
    const double radii = l.pack ? 0.0 : 4.0 * layers + 1.0;
    const double whole = l.tree ? 16.0 * layers + 20.0 / 16.0 : 0.0;
    StepWork need{l.slots * (16.0 + 1.0 + (l.thin ? 1.0 : 0.0) + 0.25 + hold + radii + whole),
                  60.0 * l.slots + (l.thinsWithin ? thinOperations(l) : 0.0)};
    need.across = l.pack ? l.packed + 72.0 / 256.0 * l.slots : 0.0;
    return need;
}

// Reads the images in place or from upload memory. If an earlier pass has read the depth, its bytes count
// again, because that pass does not keep them.
StepWork classifyNeed(const FrameLoad& l) {
    StepWork need{l.pixels * ((l.keepDepth ? 2.0 : 0.0) + 1.0) + 4.0 * l.cells, 40.0 * l.pixels};
    need.across = l.pixels * (2.0 + l.colourBytes);
    return need;
}
StepWork occlusionNeed(const FrameLoad& l) {
    StepWork need{4.0 * l.cells, l.occlusion ? 40.0 * l.pixels : 0.0};
    need.across = l.occlusion ? 2.0 * l.pixels : 0.0;
    return need;
}

} // namespace

std::vector<std::pair<std::string, StepWork>> workOf(const FrameLoad& l) {
    return {
        {"upload",
         {l.inPlace ? 2.0 * sizeof(shared::FrameParams) : 2.0 * l.pixels * (2.0 + l.colourBytes), 0.0,
          StepWork::Where::Host}},
        {"occlusion", occlusionNeed(l)},
        {"classify", classifyNeed(l)},
        {"list", {l.pixels / 256.0 * (l.hold ? 8.0 : 4.0) + l.slots / 256.0 * (l.hold ? 8.0 : 4.0), 0.0}},
        {"surface", {l.slots * (1.0 + 2.0 + 16.0), l.selected * (70.0 + 20.0 * l.tapsPerPixel)}},
        {"thin", {l.slots * (1.0 + 16.0 + 1.0), thinOperations(l)}},
        {"spheres", spheresNeed(l)},
        {"tree", {l.slots / 16.0 * 20.0 * 17.0 / 16.0, l.slots / 16.0 * 30.0}},
        {"tree_query", {l.query.bytes, l.query.operations}},
        {"deliver", {3.0 * (sizeof(shared::FrameCounters) + 4.0 * l.pixels / 256.0), 0.0}},
        {"moments", {l.guidedSlots * (17.0 + 64.0 / 256.0), 40.0 * l.guided}},
        {"collect", // reads packed or plain device data, writes columns; reads of depths by points do not
                    // count
         {(l.pack ? l.packed : 20.0 * l.spheres) + 21.0 * l.spheres, 0.0, StepWork::Where::ThreadPool}},
        {"grid", {l.spheres * (16.0 + 20.0), 0.0, StepWork::Where::ThreadPool}},
    };
}

namespace {

double bytesPerSecond(const Ceilings& c, StepWork::Where where) {
    return where == StepWork::Where::Device ? c.deviceBytes
           : where == StepWork::Where::Host ? c.hostBytes
                                            : c.workerBytes;
}

} // namespace

StepFloor floorOf(const StepWork& need, const Ceilings& c, bool inPlace) {
    const bool onDevice = need.where == StepWork::Where::Device;
    return {need.across > 0.0 ? readingMs(c, need.bytes, need.across, inPlace)
                              : 1e3 * need.bytes / bytesPerSecond(c, need.where),
            onDevice ? need.operations / c.deviceFlops * 1e3 : 0.0, onDevice ? c.dispatchMs : 0.0};
}

} // namespace fathom::profile
