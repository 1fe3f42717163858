// SPDX-License-Identifier: Apache-2.0
#include "tests/support/cloud_rig.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

uint64_t bytesOf(const cloud::SetBuffers& set) {
    uint64_t bytes = 0;
    for (const gpu::Buffer* buffer :
         {&set.packed, &set.places, &set.runs, &set.bits, &set.nodes, &set.nodeCounts, &set.spheres,
          &set.held, &set.classes, &set.moments, &set.counters, &set.listed, &set.points, &set.masks}) {
        bytes += buffer->bytes();
    }
    return bytes;
}

} // namespace

TEST_CASE("The plan states the memory of a fixture set, whatever the set consists of") {
    const CameraInfo camera = pinholeCamera(100, 60);
    Scene still = plainScene(), held = plainScene();
    held.holdSeconds = 0.5;
    held.fixtures.push_back(guidanceClass("g"));
    for (const Scene& scene : {still, held}) {
        for (const bool tree : {false, true}) {
            for (const bool pack : {false, true}) {
                CAPTURE(tree);
                CAPTURE(pack);
                CloudRig rig(scene, camera, [&](Plan& plan) {
                    plan.tree = tree;
                    plan.byPixel = plan.pack = pack;
                });
                rig.run(drawnImage(camera, [](int, int) { return 0.7; }));
                const uint64_t planned = rig.plan().setBytes(rig.cycle().layout());
                CHECK(bytesOf(rig.set().device) >= planned);
                CHECK(bytesOf(rig.set().device) <= planned + 14 * 16); // each buffer may be rounded up
            }
        }
    }
}
