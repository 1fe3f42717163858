// SPDX-License-Identifier: Apache-2.0
// The frame cadence as a whole: only required passes are built, equal frames give equal bits, sets are
// stamped.
#include "tests/support/cloud_rig.h"

#include "engine/types/error.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

using Names = std::vector<std::string>;

struct Need {
    std::string name;
    Scene scene;
    CameraInfo camera;
    Names passes;
    uint32_t dispatches;
};

Scene guidanceOnly() {
    Scene scene = plainScene();
    scene.fixtures = {guidanceClass("goal")};
    return scene;
}

Scene shapesOnly() {
    Scene scene = plainScene();
    scene.fixtures[0].shape = ShapeKind::Box;
    scene.fixtures[0].size = dvec3(1.0);
    return scene;
}

// A scene that uses every feature.
Scene fullScene() {
    Scene scene = classesScene(5);
    scene.filter = {2, 0.01, 0.03};
    scene.errorBudget = 0.0003;
    scene.holdSeconds = 0.2;
    scene.fixtures[1].largestPart = true;
    return scene;
}

CameraInfo unregistered(CameraInfo camera) {
    camera.registered = false;
    camera.colourTdepth.position.x = 0.02;
    return camera;
}

std::vector<Need> needs() {
    const CameraInfo plain = pinholeCamera(100, 60);
    Scene coloured = plainScene(), thinned = plainScene(), full = fullScene();
    coloured.fixtures[0].hue = Band{330, 30};
    thinned.errorBudget = 0.001;
    CameraInfo blind = plain;
    blind.hasColour = false;
    const std::vector<std::string> usual{"classify", "surface", "spheres", "deliver"};
    const std::vector<std::string> parallax{"occlusion", "classify", "surface", "spheres", "deliver"};
    return {{"one class of every point", plainScene(), plain, usual, 3},
            {"guidance alone", guidanceOnly(), plain, {"classify", "surface", "moments", "deliver"}, 3},
            {"shapes alone", shapesOnly(), plain, {}, 0},
            {"colour, registered", coloured, plain, usual, 3},
            {"colour, unregistered", coloured, unregistered(plain), parallax, 4},
            {"no colour, unregistered", plainScene(), unregistered(plain), usual, 3},
            {"colour, but the camera has none", coloured, blind, usual, 3},
            {"error budget", thinned, plain, {"classify", "surface", "thin", "spheres", "deliver"}, 4},
            {"all of it",
             full,
             unregistered(freiburgCamera(100, 60)),
             {"occlusion", "classify", "surface", "thin", "moments", "spheres", "deliver"},
             6}};
}

// Compares all data of a set that a reader can see.
bool sameBits(const HostFixtures& a, const HostFixtures& b) {
    const auto pose = [](const Pose& p, const Pose& q) {
        return p.position == q.position && p.rotation == q.rotation;
    };
    const RegionSpheres &s = a.spheres, &t = b.spheres;
    bool same = s.x == t.x && s.y == t.y && s.z == t.z && s.radius == t.radius && s.source == t.source &&
                s.fixture == t.fixture;
    same = same && a.forbiddenBits == b.forbiddenBits && a.depth == b.depth && a.origin == b.origin &&
           pose(a.baseTcamera, b.baseTcamera);
    same = same && a.guidance.size() == b.guidance.size();
    for (size_t i = 0; same && i < a.guidance.size(); ++i) {
        const GuidancePose &g = a.guidance[i], &h = b.guidance[i];
        same = g.count == h.count && g.present == h.present && g.position == h.position &&
               g.normal == h.normal && g.planar == h.planar && g.rollFree == h.rollFree &&
               pose(g.target, h.target) && g.fixture == h.fixture;
    }
    return same;
}

Frame frameOf(const Image& image, uint32_t number, double time) {
    Frame::Content content;
    content.index = number, content.sourceNumber = number, content.captureTime = time;
    content.depth = image.depth, content.colour = image.colour;
    return Frame(content, nullptr);
}

} // namespace

TEST_CASE("A scene runs exactly the passes and dispatches that it needs") {
    for (Need need : needs()) {
        CAPTURE(need.name);
        CloudRig rig(need.scene, need.camera);
        if (!need.passes.empty() && vulkan().device.facts().kind == DeviceKind::Cpu) {
            need.passes.insert(std::ranges::find(need.passes, "surface"), "list");
            need.dispatches +=
                rig.plan().hold ? 2 : 1; // separate dispatches for patches with and without held points
        } else {
            need.dispatches +=
                need.passes.empty() ? 0 : 1; // `deliver` is a dispatch on GPUs and copies on CPU devices
            need.dispatches -= static_cast<uint32_t>(std::erase(need.passes, "thin"));
        }
        const FrameReport report = rig.run(stressImage(need.camera, 5));
        CHECK(rig.cycle().passNames() == need.passes);
        CHECK(report.passMs.size() == need.passes.size());
        CHECK(rig.cycle().dispatches() == need.dispatches);
        CHECK(rig.plan().dispatchesPerFrame() == rig.cycle().dispatches());
        CHECK(rig.host().guidance.size() ==
              (rig.plan().moments ? static_cast<size_t>(need.name == "all of it" ? 2 : 1) : 0));
        CHECK(rig.host().spheres.size() == report.counts.spheres);
        CHECK((report.counts.spheres > 0) == (rig.plan().spheres && need.camera.hasColour));
        CHECK(report.counts.valid == reference::validPixels(rig.view()));
    }
}

TEST_CASE("Two cycles give the same bits for the same frames, held points and guidance included") {
    SimulatedCameraOptions options;
    options.width = 214, options.height = 120, options.frames = 6, options.dropShare = 0.1;
    for (const bool tiled : {false, true}) {
        SimulatedCamera camera(*analyticScene("tank"), options);
        CloudRig a(fullScene(), camera.info(), [&](Plan& plan) { plan.tiled = tiled; });
        CloudRig b(fullScene(), camera.info(), [&](Plan& plan) { plan.tiled = tiled; });
        b.cycle().sets().back(); // starts with another set of the pool
        uint32_t spheres = 0, held = 0;
        while (const std::optional<Frame> frame = camera.next()) {
            const Image image{{(*frame)->depth.begin(), (*frame)->depth.end()},
                              {(*frame)->colour.begin(), (*frame)->colour.end()}};
            a.run(image, -1.0, (*frame)->baseTcamera);
            b.run(image, -1.0, (*frame)->baseTcamera);
            CHECK(sameBits(a.host(), b.host()));
            spheres += static_cast<uint32_t>(a.host().spheres.size());
            for (const uint32_t source : a.host().spheres.source) {
                held += source >= camera.info().depth.pixels();
            }
        }
        CHECK(spheres > 5000);
        CHECK(held > 100);
    }
}

TEST_CASE("Without pass times the set is the same and all times are zero") {
    const CameraInfo camera = freiburgCamera(123, 77);
    CloudRig timed(fullScene(), camera);
    CloudRig other(fullScene(), camera, [](Plan& plan) { plan.passTimes = false; });
    for (uint64_t seed = 1; seed <= 3; ++seed) {
        const FrameReport known = timed.run(stressImage(camera, seed));
        const FrameReport unknown = other.run(stressImage(camera, seed));
        CHECK(std::ranges::count(known.passMs, 0.0) < std::ssize(known.passMs));
        CHECK(unknown.passMs == std::vector<double>(other.cycle().passNames().size(), 0.0));
        CHECK(sameBits(timed.host(), other.host()));
    }
}

TEST_CASE("Without hold a frame's set does not depend on the frames before it") {
    const CameraInfo camera = freiburgCamera(123, 77);
    Scene scene = fullScene();
    scene.holdSeconds = 0.0;
    CloudRig fresh(scene, camera), used(scene, camera);
    for (uint64_t seed = 1; seed <= 5; ++seed) {
        used.run(stressImage(camera, seed));
    }
    const Image image = stressImage(camera, 9);
    fresh.run(image), used.run(image);
    HostFixtures one = fresh.host(), other = used.host();
    REQUIRE(one.guidance.size() == other.guidance.size());
    for (size_t i = 0; i < one.guidance.size(); ++i) { // targets of guidance settle over frames
        CHECK(one.guidance[i].count == other.guidance[i].count);
        CHECK(one.guidance[i].position == other.guidance[i].position);
    }
    one.guidance.clear(), other.guidance.clear();
    CHECK(sameBits(one, other));
    CHECK(used.host().generation == 6);
    CHECK(used.host().frame == 5);
}

TEST_CASE(
    "Generations count published sets, a leased set stays unchanged, and a repeated frame costs no work") {
    const CameraInfo camera = pinholeCamera(90, 60);
    CloudRig rig(fullScene(), camera);
    FrameCycle& cycle = rig.cycle();
    CHECK_FALSE(static_cast<bool>(cycle.sets().newest()));
    const Image first = stressImage(camera, 1), second = stressImage(camera, 2);
    cycle.process(frameOf(first, 0, 0.0));
    const auto lease = cycle.sets().newest();
    const HostFixtures copy = lease->host;
    CHECK(copy.generation == 1);
    for (uint32_t k = 1; k <= 5; ++k) {
        cycle.process(frameOf(k % 2 == 0 ? first : second, k, k / 30.0));
        CHECK(lease->host.generation == 1);
    }
    CHECK(sameBits(lease->host, copy));
    const FrameReport same = cycle.process(frameOf(second, 5, 0.9));
    CHECK(same.unchanged);
    CHECK(cycle.dispatches() == 0);
    CHECK(cycle.captureTime() == 0.9);
    CHECK(cycle.process(frameOf(second, 6, 1.0)).unchanged == false);
}

TEST_CASE("A frame smaller than the camera's size is rejected, and the next good one works") {
    const CameraInfo camera = pinholeCamera(64, 48);
    CloudRig rig(fullScene(), camera);
    Image small = stressImage(camera, 1);
    small.depth.pop_back();
    CHECK_THROWS_AS(rig.cycle().process(frameOf(small, 0, 0.0)), Error);
    CHECK(rig.cycle().process(frameOf(stressImage(camera, 2), 1, 0.1)).counts.spheres > 0);
}

TEST_CASE("The totals of the report are those of the set") {
    const CameraInfo camera = pinholeCamera(200, 130);
    CloudRig rig(fullScene(), camera);
    rig.run(stressImage(camera, 1));
    const FrameReport report = rig.run(stressImage(camera, 2));
    const auto rows = static_cast<uint32_t>(rig.scene().fixtures.size());
    std::vector<uint32_t> spheres(rows, 0);
    std::vector<std::vector<uint8_t>> patches(rows, std::vector<uint8_t>(rig.cycle().layout().patches(), 0));
    const RegionSpheres& s = rig.host().spheres;
    for (size_t i = 0; i < s.size(); ++i) {
        const uint32_t pixel = s.source[i] % camera.depth.pixels();
        ++spheres[s.fixture[i]];
        patches[s.fixture[i]][pixel / 200 / 16 * rig.cycle().layout().across + pixel % 200 / 16] = 1;
    }
    uint32_t any = 0;
    for (size_t p = 0; p < patches[0].size(); ++p) {
        any += std::any_of(patches.begin(), patches.end(), [&](const auto& row) { return row[p] != 0; });
    }
    CHECK(report.counts.classSpheres == spheres);
    for (size_t c = 0; c < rows; ++c) {
        CHECK(report.counts.classPatches[c] ==
              static_cast<uint32_t>(std::count(patches[c].begin(), patches[c].end(), 1)));
    }
    CHECK(report.counts.patches == any);
    CHECK(report.guidanceCount == report.counts.classPixels[1] + report.counts.classPixels[4]);
    CHECK(report.latencyMs > 0.0);
}
