// SPDX-License-Identifier: Apache-2.0
// Compares the delivered counters and marks with counts of the pixels' class bits, and checks that the device
// has cleared them.
#include "apps/verify/read_back.h"
#include "tests/support/cloud_rig.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

// The cleared state: indirect arguments of 0 x 1 x 1 groups, and zeros.
void checkCleared(const CloudRig& rig) {
    const cloud::WorkBuffers& work = rig.cycle().work();
    const auto words = verify::readBack<uint32_t>(vulkan().device, work.counters);
    for (size_t i = 0; i < words.size(); ++i) {
        CAPTURE(i);
        CHECK(words[i] == (i < 20 && (i % 4 == 1 || i % 4 == 2) ? 1 : 0));
    }
    const auto listed = verify::readBack<uint32_t>(vulkan().device, work.listed);
    CHECK(std::ranges::count(listed, 0u) == static_cast<std::ptrdiff_t>(listed.size()));
}

void checkDelivered(const CloudRig& rig) {
    uint32_t pixels = 0;
    std::vector<uint32_t> expected(rig.layout().patches(), 0);
    const std::vector<uint32_t> masks = rig.masks();
    for (size_t i = 0; i < masks.size(); ++i) {
        const size_t u = i % rig.camera().depth.width, v = i / rig.camera().depth.width;
        expected[v / 16 * rig.layout().across + u / 16] |= masks[i] != 0;
        pixels += masks[i] != 0;
    }
    const shared::FrameCounters& counters = rig.counters();
    const std::vector<uint32_t> listed = rig.listed();
    const auto patches = static_cast<uint32_t>(std::ranges::count(expected, 1u));
    CHECK(counters.classPixels[0] == pixels);
    CHECK(counters.classPixels[1] == pixels);
    CHECK(counters.guidedGroups.w == patches); // both classes accept every point
    CHECK(counters.patchGroups.x >= patches);  // also counts patches whose memory holds points
    CHECK(counters.patchGroups.x == listed.size() - static_cast<size_t>(std::ranges::count(listed, 0u)));
    for (size_t patch = 0; patch < expected.size(); ++patch) {
        CAPTURE(patch);
        CHECK(((listed[patch] & shared::kPatchGuided) != 0) == (expected[patch] != 0));
        CHECK(((listed[patch] & shared::kPatchListed) != 0 || expected[patch] == 0));
    }
}

} // namespace

TEST_CASE("The host gets the counters and marks of each frame, and the device clears them") {
    for (const bool byPixel : {false, true}) {
        for (const auto& size : {std::pair{100u, 60u}, {16u, 16u}, {1u, 1u}, {640u, 333u}}) {
            const uint32_t width = size.first,
                           height = size.second; // CAPTURE does not accept structured bindings
            CAPTURE(byPixel);
            CAPTURE(width);
            const CameraInfo camera = pinholeCamera(width, height);
            Scene scene = plainScene();
            scene.holdSeconds = 0.05; // one or two frames
            scene.fixtures.push_back(guidanceClass("g"));
            CloudRig rig(scene, camera, [&](Plan& plan) { plan.byPixel = plan.pack = byPixel; });
            checkCleared(rig);                                // before the first frame
            for (const double share : {1.0, 0.3, 0.0, 0.6}) { // full, some, empty
                const auto depth = [&](int u, int) { return u < share * width ? 1.0 : 0.0; };
                rig.run(drawnImage(camera, depth));
                checkDelivered(rig);
                checkCleared(rig);
            }
            rig.cycle().forget();
            checkCleared(rig);
        }
    }
}
