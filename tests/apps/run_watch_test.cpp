// SPDX-License-Identifier: Apache-2.0
// Warnings about protection that is silently off.
#include "apps/replay/run_watch.h"

#include "engine/cycle/haptic_notes.h"
#include "tests/support/mentions.h"

#include <doctest/doctest.h>

using namespace fathom;
using fathom::testing::mentions;

namespace {

constexpr uint32_t kGrey = 0xff808080, kDark = 0xff080808, kColoured = 0xff2020c0;

Scene sceneOf(Role role) {
    Scene scene;
    FixtureClass f;
    f.name = "valve";
    f.role = role;
    f.hue = Band{345, 20};
    scene.fixtures.push_back(f);
    return scene;
}

CameraInfo camera() {
    CameraInfo info;
    info.depth = {.width = 64, .height = 48, .fx = 60, .fy = 60, .cx = 32, .cy = 24};
    info.colour = info.depth;
    return info;
}

struct WatchedRun {
    explicit WatchedRun(Role role = Role::Forbidden)
        : watch(sceneOf(role), {camera(), "colour /rgb (yuv422)"}) {
        set.camera = camera();
        set.depth = {600, 610, 0, 620};
    }

    // Frames at 30 Hz up to `end` [s], each with so many marked pixels and spheres.
    void frames(double end, uint32_t marked, uint32_t spheres, uint32_t colour, uint32_t valid = 4) {
        cloud::FrameCounts counts;
        counts.valid = valid;
        counts.classPixels = {marked};
        counts.spheres = spheres;
        const std::vector<uint32_t> image(64, colour);
        for (; t < end; t += 1.0 / 30.0) {
            watch.frame(t, counts, set, image);
        }
    }
    void ticks(double from, double to, const char* state, int64_t frame, uint32_t vanished = 0) {
        for (int i = 0; i < static_cast<int>((to - from) * 1e3); ++i) {
            watch.tick(from + i * 1e-3, state, frame, vanished);
        }
    }
    std::string only() {
        const std::vector<std::string> all = watch.warnings().list();
        CHECK(all.size() == 1);
        return all.empty() ? "" : all.front();
    }
    bool quiet() { return watch.warnings().list().empty(); }

    RunWatch watch;
    HostFixtures set;
    double t = 0.0;
};

} // namespace

TEST_CASE(
    "A class without a point is named once with its cause, after a second or at the end of a short run") {
    WatchedRun run;
    run.frames(0.9, 0, 0, kColoured);
    CHECK(run.quiet());
    run.frames(3.0, 0, 0, kColoured);
    mentions(run.only(), "fixture 'valve' has no region from 0.00 s on for 1 s: no pixel passes its gates; "
                         "colour /rgb (yuv422)");

    WatchedRun brief;
    brief.frames(0.1, 0, 0, kColoured);
    brief.watch.end();
    mentions(brief.only(), "fixture 'valve' has no region in any frame");

    WatchedRun sometimes;
    sometimes.frames(0.5, 20, 5, kColoured);
    sometimes.frames(1.3, 0, 0, kColoured);
    sometimes.frames(3.0, 20, 5, kColoured);
    sometimes.watch.end();
    CHECK(sometimes.quiet());
    sometimes.frames(4.5, 0, 0, kColoured);
    mentions(sometimes.only(), "from 3.");
}

TEST_CASE(
    "The cause of a missing class is grey colour, depth outside near and far, the filter or min_count") {
    WatchedRun grey;
    grey.frames(0.1, 0, 0, kGrey);
    grey.watch.end();
    mentions(grey.only(), "the colour image is grey");

    WatchedRun far;
    far.set.camera.metresPerUnit = 1.0;
    far.frames(0.1, 0, 0, kColoured, 0);
    far.watch.end();
    mentions(far.only(), "readings are 600 to 620 m, with a depth unit of 1 m");

    WatchedRun flying;
    flying.frames(0.1, 3, 0, kColoured);
    flying.watch.end();
    mentions(flying.only(), "flying or isolated");

    WatchedRun few(Role::Guidance);
    few.frames(0.1, 49, 0, kColoured);
    few.watch.end();
    mentions(few.only(), "no target in any frame: 49 points, min_count is 50");
    WatchedRun enough(Role::Guidance);
    enough.frames(2.0, 50, 0, kColoured);
    enough.watch.end();
    CHECK(enough.quiet());
}

TEST_CASE(
    "A state without force that lasts over a second is named once with its cause, and a short one is not") {
    WatchedRun none;
    none.ticks(0.0, 3.0, "off", -1);
    mentions(none.only(), "state 'off' from 0.00 s on for 1 s: no frame has become a set of regions");

    WatchedRun unplaced;
    unplaced.frames(0.1, 20, 5, kColoured);
    unplaced.ticks(0.0, 1.5, "off", -1);
    mentions(unplaced.only(), "no contact answer was made near the tool");

    WatchedRun switched;
    switched.frames(0.1, 20, 5, kColoured);
    switched.ticks(0.0, 0.9, "off", 0);
    switched.ticks(0.9, 1.0, "free", 0);
    switched.ticks(1.0, 1.9, "off", 0);
    CHECK(switched.quiet());
    switched.ticks(1.9, 2.5, "off", 0);
    mentions(switched.only(), "state 'off' from 1.00 s on");

    WatchedRun lags;
    lags.ticks(0.0, 1.5, "waiting", 0);
    mentions(lags.only(), "the tool cannot follow the hand");

    for (const auto& [state, cause] : {std::pair("trapped", "no motion of the tool obeys all fixtures"),
                                       std::pair("escape", "covers the tool, and pushes it out"),
                                       std::pair("fading", "too old: frames or contact answers are late")}) {
        WatchedRun odd;
        odd.frames(0.1, 20, 5, kColoured);
        odd.ticks(0.0, 0.3, "contact", 0);
        odd.ticks(0.3, 1.2, state, 0);
        CHECK(odd.quiet());
        odd.ticks(1.2, 1.5, state, 0);
        mentions(odd.only(), std::string("state '") + state + "' from 0.30 s on for 1 s: ");
        mentions(odd.only(), cause);
    }

    WatchedRun brief;
    brief.ticks(0.0, 0.2, "off", -1);
    brief.watch.end();
    mentions(brief.only(), "state 'off'");
    WatchedRun starts;
    starts.ticks(0.0, 0.2, "off", -1);
    starts.ticks(0.2, 0.4, "free", 0);
    starts.watch.end();
    CHECK(starts.quiet());
}

TEST_CASE("A region that disappears while it presses is named at once, with its cause") {
    WatchedRun run;
    run.frames(0.5, 20, 5, kColoured);
    run.ticks(0.0, 0.5, "contact", 0);
    run.frames(0.54, 0, 0, kDark);
    run.ticks(0.5, 0.54, "free", 1, 1);
    mentions(run.only(),
             "a region disappeared at 0.50 s while it pressed: fixture 'valve' has no region: the "
             "colour image is black");
    WatchedRun other;
    other.frames(0.5, 20, 5, kColoured);
    other.ticks(0.0, 0.5, "contact", 0);
    other.ticks(0.5, 0.6, "free", 1, 1);
    mentions(other.only(), "the newest frame shows nothing in its place");
}

TEST_CASE("Frames that come too seldom for a steady force are named, a few late ones are not") {
    const auto warnings = [](double interval, double last) {
        WatchedRun run;
        cloud::FrameCounts counts;
        counts.valid = 4;
        counts.classPixels = {20};
        counts.spheres = 5;
        for (int i = 0; i < 12; ++i) {
            run.watch.frame(i * interval + (i < 11 ? 0.0 : last), counts, run.set, {});
        }
        return run.watch.warnings().list();
    };
    CHECK(warnings(0.09, 1.0).empty());
    CHECK(warnings(0.1, 0.0).empty());
    REQUIRE(warnings(0.2, 0.0).size() == 1);
    mentions(warnings(0.2, 0.0)[0], "frames come 0.2 s apart: forces fade 0.1 s after each");
}

TEST_CASE("Warnings are kept once per key, in order, on one line, and their number is bounded") {
    RunWarnings warnings;
    CHECK(warnings.add("a", "first\nline"));
    CHECK_FALSE(warnings.add("a", "again"));
    CHECK(warnings.add("b", "second"));
    CHECK(warnings.list() == std::vector<std::string>{"first line", "second"});
    for (int i = 0; i < 1000; ++i) {
        warnings.add(std::to_string(i), "more");
    }
    CHECK(warnings.list().size() == RunWarnings::kMax);
}

TEST_CASE("A stiffness of more than twice the passive bound is named before the first tick") {
    Scene scene = sceneOf(Role::Forbidden);
    scene.haptics.stiffness = 1000.0; // bound of `ideal` with its automatic damping: 800 N/m
    CHECK(RunWatch(scene, {camera(), ""}).warnings().list().empty());
    scene.haptics.delay = 10;
    const std::vector<std::string> list = RunWatch(scene, {camera(), ""}).warnings().list();
    REQUIRE(list.size() == 1);
    CHECK(list.front().find("haptics.stiffness: 1000 N/m at the hand, over the passive bound of 38.1 N/m") ==
          0);
    scene.haptics.stiffness.reset(); // auto stays below it
    CHECK(RunWatch(scene, {camera(), ""}).warnings().list().empty());
}

TEST_CASE("A force limit of 0 is named before the first tick") {
    Scene scene = sceneOf(Role::Forbidden);
    scene.haptics.forceLimit = 0.0;
    RunWatch watch(scene, {camera(), ""});
    CHECK(watch.warnings().list() == std::vector<std::string>{kNoForce});
}

TEST_CASE("An edited class is judged by its new name and role, and a class that was removed is not") {
    Scene edited = sceneOf(Role::Guidance);
    edited.fixtures[0].name = "handle";
    WatchedRun run;
    run.frames(0.5, 0, 0, kColoured);
    run.watch.setFixtures(edited.fixtures);
    run.frames(1.2, 20, 5, kColoured);
    CHECK(run.quiet()); // patience begins with the edit
    run.frames(2.0, 20, 5, kColoured);
    mentions(run.only(), "fixture 'handle' has no target from 0.5");

    edited.fixtures[0].name = "(spare 0)"; // as in a recording
    WatchedRun removed;
    removed.watch.setFixtures(edited.fixtures);
    removed.frames(3.0, 0, 0, kColoured);
    removed.watch.end();
    CHECK(removed.quiet());
}
