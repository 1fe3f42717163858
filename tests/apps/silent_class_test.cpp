// SPDX-License-Identifier: Apache-2.0
// Warnings of a run about one class among others, and about settings that leave no force.
#include "apps/replay/run_watch.h"
#include "engine/cycle/haptic_notes.h"

#include <doctest/doctest.h>

using namespace fathom;

namespace {

CameraInfo smallCamera() {
    CameraInfo info;
    info.depth = {.width = 64, .height = 48, .fx = 60, .fy = 60, .cx = 32, .cy = 24};
    info.colour = info.depth;
    return info;
}

Scene twoClasses() {
    Scene scene;
    for (const char* name : {"pipe", "cable"}) {
        FixtureClass f;
        f.name = name;
        scene.fixtures.push_back(f);
    }
    return scene;
}

// Warnings of a short run with these counts in every frame.
std::vector<std::string> warningsOf(const Scene& scene, const cloud::FrameCounts& counts,
                                    const HostFixtures& set) {
    RunWatch watch(scene, {smallCamera(), ""});
    for (int i = 0; i < 3; ++i) {
        watch.frame(i / 30.0, counts, set, {});
    }
    watch.end();
    return watch.warnings().list();
}

cloud::FrameCounts countsOf(uint32_t pipe, uint32_t cable, uint32_t both, uint32_t pipeSpheres) {
    cloud::FrameCounts counts;
    counts.valid = 3000;
    counts.classPixels = {pipe, cable};
    counts.classSpheres = {pipeSpheres, 0};
    counts.spheres = pipeSpheres;
    counts.forbidden = pipe + cable - both;
    return counts;
}

} // namespace

TEST_CASE("A forbidden class whose points are all rejected is named, also beside one with a region") {
    const Scene scene = twoClasses();
    CHECK(warningsOf(scene, countsOf(900, 240, 0, 900), {}) ==
          std::vector<std::string>{"fixture 'cable' has no region in any frame: the filter rejects all its "
                                   "points as flying or isolated"});
    CHECK(warningsOf(scene, countsOf(900, 240, 100, 900), {}).size() == 1);
    CHECK(warningsOf(scene, countsOf(900, 240, 240, 900), {}).empty()); // all of them are in the pipe
}

TEST_CASE("A guidance class whose points do not suffice after the filter is named") {
    Scene scene;
    FixtureClass f;
    f.name = "goal";
    f.role = Role::Guidance;
    f.largestPart = true;
    scene.fixtures.push_back(f);
    cloud::FrameCounts counts;
    counts.valid = 3000;
    counts.classPixels = {64};
    HostFixtures set;
    GuidancePose pose;
    pose.count = 64, pose.present = true;
    set.guidance = {pose};
    CHECK(warningsOf(scene, counts, set).empty());
    set.guidance[0].count = 12, set.guidance[0].present = false;
    CHECK(warningsOf(scene, counts, set) ==
          std::vector<std::string>{"fixture 'goal' has no target in any frame: 64 points; the filter "
                                   "and largest_part leave 12; min_count is 50"});
}

TEST_CASE("A force limit that no hand feels is a warning of the run") {
    Scene scene = twoClasses();
    scene.haptics.forceLimit = 1e-9;
    CHECK(RunWatch(scene, {smallCamera(), ""}).warnings().list() == forceWarnings(scene));
    CHECK(forceWarnings(scene).size() == 1);
}
