// SPDX-License-Identifier: Apache-2.0
// Some passes have variants for CPU devices and GPUs (Plan). Both must give the same results on any device.
#include "tests/support/cloud_rig.h"

#include <array>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

void forCpu(Plan& plan) {
    plan.byPixel = plan.tiled = plan.pack = plan.keepDepth = false;
    plan.filterBlock = true;
}

void forGpu(Plan& plan) {
    plan.byPixel = plan.tiled = plan.pack = true;
    plan.memoryTexels = false;
    plan.filterBlock = false;
}

bool samePoses(const HostFixtures& a, const HostFixtures& b) {
    bool same = a.guidance.size() == b.guidance.size();
    for (size_t i = 0; same && i < a.guidance.size(); ++i) {
        same = a.guidance[i].count == b.guidance[i].count &&
               a.guidance[i].position == b.guidance[i].position &&
               a.guidance[i].normal == b.guidance[i].normal;
    }
    return same;
}

// Frames that differ, so that points are held if hold is on.
void compareFrames(const CloudCase& c, uint32_t group, bool manyPatches) {
    CAPTURE(c.name);
    CAPTURE(group);
    CAPTURE(manyPatches);
    CloudRig cpu(c.scene, c.camera, forCpu), gpu(c.scene, c.camera, [&](Plan&plan) {
        forGpu(plan);
        plan.pixelGroup = group;
        plan.manyPatches = manyPatches;
        plan.keepDepth = plan.passes && c.camera.depth.width % 4 == 0;
    });
    for (uint64_t frame = 0; frame < 3; ++frame) {
        const Image image = frame == 0 ? c.image : stressImage(c.camera, 70 + frame);
        const FrameReport one = cpu.run(image), other = gpu.run(image);
        CHECK(one.counts.classPixels == other.counts.classPixels);
        CHECK(cpu.masks() == gpu.masks());
        const HostFixtures &a = cpu.host(), &b = gpu.host();
        CHECK(a.forbiddenBits == b.forbiddenBits);
        // A GPU's compiler may contract sums differently in one variant, so that a point more or less is
        // thinned.
        if (vulkan().device.facts().kind == DeviceKind::Cpu) {
            CHECK(one.counts.classSpheres == other.counts.classSpheres);
            CHECK(one.counts.classPatches == other.counts.classPatches);
            CHECK(one.counts.nodes == other.counts.nodes);
            CHECK(a.spheres.fixture == b.spheres.fixture);
            CHECK(a.spheres.source == b.spheres.source);
            CHECK((a.spheres.x == b.spheres.x && a.spheres.y == b.spheres.y && a.spheres.z == b.spheres.z));
            CHECK(a.spheres.radius == b.spheres.radius);
            CHECK(samePoses(a, b));
        }
    }
}

} // namespace

TEST_CASE("CPU plans with registers and GPU plans with shared memory give the same results") {
    bool holds = false;
    uint32_t cases = 0;
    for (CloudCase& c : cloudCases()) {
        holds = !holds;
        c.scene.holdSeconds = holds ? 1.0 : 0.0;
        const bool many = cases / 2 % 2 == 1; // with and without held points
        compareFrames(c, std::array{256u, 128u, 16u}[cases++ % 3],
                      many); // the largest group that every device supports
    }
}
