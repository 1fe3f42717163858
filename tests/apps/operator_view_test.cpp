// SPDX-License-Identifier: Apache-2.0
// The window's view of ticks, tested without a window: rates, blocks, modes, alarms, columns of a trace.
#include "apps/operate/alarms.h"
#include "apps/operate/hud.h"
#include "apps/operate/view_lines.h"
#include "tests/apps/viewed_run.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <glm/geometric.hpp>

using namespace fathom;
using namespace fathom::operate;

namespace {

using Words = std::vector<std::string>;

} // namespace

TEST_CASE("Rates cover the last second, including its longest period") {
    ViewedRun run;
    for (int i = 0; i < 500; ++i) {
        run.step(0.010); // long before
    }
    for (int i = 0; i < 1100; ++i) {
        run.step(i == 800 ? 0.005 : 0.001);
    }
    CHECK(run.view.rates().worstPeriodMs == doctest::Approx(5.0));
    CHECK(run.view.rates().hapticHz == doctest::Approx(996.0).epsilon(0.002));
    CHECK(run.view.ticks() == 1600);
    for (int i = 0; i < 20; ++i) {
        run.step(1.0);
    }
    CHECK(run.view.trace().size() == 11); // covers ten seconds
    run.view.rewind();
    CHECK(run.view.rates().hapticHz == 0.0);
}

TEST_CASE(
    "A block lasts while its touches continue, keeps its depth, and starts again after 0.25 s without any") {
    ViewedRun run;
    run.touch(3, 0.002);
    run.touch(3, 0.007);
    run.touch(3, 0.004);
    REQUIRE(run.view.blocks().size() == 1);
    CHECK(run.view.blocks()[0].deepest == doctest::Approx(0.007));
    CHECK(run.view.blocks()[0].beyond == doctest::Approx(0.004));
    run.touch(4, 0.001); // another sphere of the tool
    CHECK(run.view.blocks().size() == 2);
    CHECK(run.view.blocks()[0].touch.leaf == 4);
    run.row.record.touchCount = 0;
    run.step(0.3);
    run.touch(3, 0.001);
    REQUIRE(run.view.blocks().size() == 3);
    CHECK(run.view.blocks()[0].deepest == doctest::Approx(0.001));
    for (uint32_t leaf = 10; leaf < 40; ++leaf) {
        run.touch(leaf, 0.001);
    }
    CHECK(run.view.blocks().size() == 12); // keeps the newest
    CHECK(run.view.blocks()[0].touch.leaf == 39);
}

TEST_CASE("An alarm stays until it is over and acknowledged, and is latched again when it returns") {
    ViewedRun run;
    run.console.switches.forces = true;
    CHECK(run.step().empty());
    run.row.record.state = StepState::Trapped;
    CHECK(run.step() == Words{"WARNING active trapped"});
    run.row.record.state = StepState::Free;
    CHECK(run.step() == Words{"WARNING latched trapped"});
    CHECK(run.step() == Words{"WARNING latched trapped"});
    run.console.requests.acknowledge = true;
    CHECK(run.step().empty());
    CHECK_FALSE(run.console.requests.acknowledge);

    run.row.record.state = StepState::Trapped;
    run.step();
    run.console.requests.acknowledge = true;
    CHECK(run.step() == Words{"WARNING active acknowledged trapped"}); // the cause remains
    CHECK(run.alarms.worst() == nullptr);
    run.row.record.state = StepState::Free;
    CHECK(run.step().empty());
    run.row.record.state = StepState::Trapped;
    CHECK(run.step() == Words{"WARNING active trapped"});
}

TEST_CASE("Alarms are sorted by level, highest first, and an acknowledged one is not the worst") {
    ViewedRun run;
    run.console.switches.forces = true;
    run.console.switches.frozen = true;
    run.row.record.wrench.force = {run.haptics.forceLimit, 0.0, 0.0};
    CHECK(run.step({.handGone = true}) ==
          Words{"WARNING active hand", "CAUTION active force", "ADVISORY active frozen"});
    CHECK(run.alarms.worst()->key == "hand");
    run.console.requests.acknowledge = true;
    run.step({.handGone = true});
    run.row.record.finite = false;
    CHECK(run.step({.handGone = true})[0] == "WARNING active finite");
    CHECK(run.alarms.worst()->key == "finite");
    run.alarms.raise(Level::Advisory, "note", "an event", 1.0);
    CHECK(run.step().end()[-2] == "ADVISORY latched note"); // before acknowledged alarms
}

TEST_CASE("A class without a region, or a run without an active set, raises an alarm after 1 s") {
    ViewedRun run;
    run.console.switches.forces = true;
    FixtureClass valve;
    valve.name = "valve";
    run.scene.fixtures = {valve};
    HostFixtures set;
    set.frame = 0;
    run.sink.frame({}, set);
    run.view.refresh();
    const auto pass = [&](int ticks) {
        for (int i = 0; i < ticks; ++i) {
            run.step(0.001);
        }
    };
    CHECK(run.step().empty());
    pass(900);
    CHECK(run.step().empty());
    pass(200);
    CHECK(run.step() == Words{"CAUTION active region valve"});
    run.row.record.state = StepState::Off;
    run.row.record.frame = -1;
    pass(1100);
    CHECK(run.step() == Words{"CAUTION active region valve", "CAUTION active off"});
}

TEST_CASE("A scene from the future raises an alarm that names the clock") {
    ViewedRun run;
    run.console.switches.forces = true;
    run.row.record.sceneAge = -5.0;
    for (int i = 0; i < 300; ++i) {
        run.step();
    }
    CHECK(run.step() == Words{"CAUTION active stale"});
    CHECK(run.alarms.shown()[0]->what == "Newest frame is 5.0 s ahead of the clock, forces fade");
}

TEST_CASE("The alarm names the cause of an old scene: the camera or a lost GPU") {
    ViewedRun run;
    run.console.switches.forces = true;
    run.row.record.sceneAge = 2.0 * kStaleAfter;
    CHECK(run.step().empty());
    for (int i = 0; i < 300; ++i) {
        run.step();
    }
    CHECK(run.step() == Words{"CAUTION active stale"});
    run.row.record.sceneAge = 6.0 * kStaleAfter;
    CHECK(run.step() == Words{"WARNING active camera", "CAUTION active stale"});
    CHECK(run.step({.gpuGone = true}) ==
          Words{"WARNING active gpu", "WARNING latched camera", "CAUTION active stale"});
    run.console.requests.acknowledge = true;
    CHECK(run.step()[0] == "WARNING active acknowledged gpu"); // before its first frame
    run.row.record.sceneAge = 0.0;
    CHECK(run.step() == Words{"CAUTION active acknowledged stale"}); // it may come and go
    for (int i = 0; i < 1100; ++i) {
        run.step();
    }
    CHECK(run.step().empty());
}

TEST_CASE("A cause that comes and goes is one alarm, and one that lasts a moment is none") {
    ViewedRun run;
    run.console.switches.forces = true;
    const auto forTicks = [&](int ticks) {
        for (int i = 0; i < ticks; ++i) {
            run.step();
        }
    };
    for (int i = 0; i < 50; ++i) { // 100 ms old for 20 ms, then fresh
        run.row.record.sceneAge = i % 2 == 0 ? 2.0 * kStaleAfter : 0.0;
        forTicks(20);
    }
    CHECK(run.alarms.inWords().empty());
    const dvec3 limit(run.haptics.forceLimit, 0.0, 0.0);
    run.row.record.sceneAge = 0.0;
    run.row.record.wrench.force = limit;
    CHECK(run.step() == Words{"CAUTION active force"});
    CHECK(run.alarms.shown()[0]->words().find("Force at its limit of 20 N: ") == 0);
    run.console.requests.acknowledge = true;
    for (int i = 0; i < 10; ++i) { // the hand trembles at the limit
        run.row.record.wrench.force = i % 2 == 0 ? limit : 0.9 * limit;
        forTicks(100);
        CHECK(run.alarms.inWords() == Words{"CAUTION active acknowledged force"});
    }
    CHECK(run.alarms.history().empty());
    run.row.record.wrench.force = {};
    forTicks(1100);
    CHECK(run.alarms.inWords().empty());
    REQUIRE(run.alarms.history().size() == 1);
    CHECK(run.alarms.history()[0].what == "Force at its limit of 20 N");
    CHECK(run.alarms.history()[0].end - run.alarms.history()[0].since == doctest::Approx(0.9).epsilon(0.05));
}

TEST_CASE("An alarm that is over and not acknowledged says first that it ended, and nothing to do") {
    ViewedRun run;
    run.console.switches.forces = run.console.switches.frozen = true;
    run.step();
    run.console.switches.frozen = false;
    CHECK(run.step() == Words{"ADVISORY latched frozen"});
    CHECK(run.alarms.shown()[0]->words() == "ended: Fixtures frozen, new images do not change them");
}

TEST_CASE("Forces that are off raise no alarm about what only forces can do, but lost devices do") {
    ViewedRun run;
    run.row.record.state = StepState::Trapped;
    run.row.record.sceneAge = 2.0 * kStaleAfter;
    run.row.record.wrench.force = {run.haptics.forceLimit, 0.0, 0.0};
    run.row.record.marginPassive = -1.0;
    run.row.record.device.position = {0.0, 0.0, 0.3};
    run.step();
    run.step(0.5);
    CHECK(run.step().empty());
    CHECK(run.step({.handGone = true}) == Words{"WARNING active hand"});
    run.row.record.sceneAge = 6.0 * kStaleAfter;
    CHECK(run.step({.gpuGone = true})[0] == "WARNING active gpu");
}

TEST_CASE("An alarm says what happens and then what to do") {
    ViewedRun run;
    run.console.switches.forces = run.console.switches.frozen = true;
    run.row.record.state = StepState::Trapped;
    run.row.record.wrench.force = {run.haptics.forceLimit, 0.0, 0.0};
    run.row.record.sceneAge = 6.0 * kStaleAfter;
    run.row.record.device.position = {0.0, 0.0, 0.3};
    run.row.record.finite = false;
    run.step();
    run.step(0.5);
    run.step({.gpuGone = false, .handGone = true, .recorderFailed = "the disk is full"});
    REQUIRE(run.alarms.shown().size() >= 8);
    for (const Alarm* alarm : run.alarms.shown()) {
        CAPTURE(alarm->key);
        CHECK(!alarm->what.empty());
        CHECK(!alarm->todo.empty());
        CHECK(alarm->words().size() < 90);
        CHECK(alarm->what.find(':') == std::string::npos);
    }
}

TEST_CASE("Times of passes have microseconds, or milliseconds if one is long, and stay beside their names") {
    CHECK(passTimes({"classify", "moments"}, {0.0562, 0.0016}) ==
          "us per pass: classify\xc2\xa0\x35\x36, moments\xc2\xa0\x32");
    CHECK(passTimes({"classify", "list"}, {20.654, 0.1101}) ==
          "ms per pass: classify\xc2\xa0\x32\x30.65, list\xc2\xa0\x30.11");
    CHECK(passTimes({"classify"}, {}) == "none yet");
}

TEST_CASE("A thinned outline has few points and stays within 0.25 pixels of all of them") {
    for (const double radius : {0.0, 3.0, 30.0, 300.0, 3000.0}) {
        CAPTURE(radius);
        std::vector<ImVec2> all; // a closed circle with points about a pixel apart
        const int count = std::max(3, static_cast<int>(6.28 * radius));
        for (int i = 0; i <= count; ++i) {
            const double angle = 6.283185307179586 * (i % count) / count;
            all.emplace_back(static_cast<float>(400.0 + radius * std::cos(angle)),
                             static_cast<float>(300.0 + radius * std::sin(angle)));
        }
        std::vector<ImVec2> few = all;
        thin(few);
        CHECK(few.front().x == all.front().x);
        CHECK(few.back().y == all.back().y);
        CHECK(few.size() <= (radius < 10.0 ? all.size() : all.size() / 3));
        for (const ImVec2& p : all) {
            double nearest = 1e9;
            for (size_t i = 0; i + 1 < few.size(); ++i) {
                const glm::dvec2 a(few[i].x, few[i].y), b(few[i + 1].x, few[i + 1].y), q(p.x, p.y);
                const double along = glm::dot(q - a, b - a) / std::max(1e-12, glm::dot(b - a, b - a));
                nearest = std::min(nearest, glm::distance(q, glm::mix(a, b, std::clamp(along, 0.0, 1.0))));
            }
            CHECK(nearest < 0.27);
        }
    }
    std::vector<ImVec2> none, one{{1.0f, 2.0f}};
    thin(none);
    thin(one);
    CHECK(none.empty());
    CHECK(one.size() == 1);
}
