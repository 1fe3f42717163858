// SPDX-License-Identifier: Apache-2.0
// Tones of the window: when one is played, and how they differ.
#include "apps/operate/tones.h"
#include "tests/apps/viewed_run.h"

#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::operate;

TEST_CASE("Tones are heard at a first contact, at a limit, for an old image and for a lost device, the worst "
          "first") {
    ViewedRun run;
    ToneRules rules;
    const auto heard = [&](const Health& health = {}) -> std::string {
        run.step(health);
        const auto tone = rules.step(run.console, run.view, run.alarms);
        return tone ? toneName(*tone) : "";
    };
    run.row.record.contactCount = 1;
    CHECK(heard() == ""); // forces are off
    run.console.switches.forces = true;
    CHECK(heard() == "contact");
    CHECK(heard() == "");
    run.row.record.contactCount = 0;
    run.row.record.t += 0.5;
    CHECK(heard() == "");
    run.row.record.contactCount = 1;
    CHECK(heard() == ""); // half a second without contact
    run.row.record.contactCount = 0;
    run.row.record.t += 1.1;
    CHECK(heard() == "");
    run.row.record.contactCount = 1;
    run.row.record.wrench.force = {run.haptics.forceLimit, 0.0, 0.0};
    CHECK(heard() == "limit"); // and a contact
    CHECK(heard() == "");
    run.row.record.wrench.force = {};
    run.row.record.sceneAge = 2.0 * kStaleAfter;
    std::string all;
    for (int i = 0; i < 400; ++i) {
        all += heard();
    }
    CHECK(all == "stale");
    CHECK(heard({.handGone = true}) == "lost");
    CHECK(heard({.handGone = true}) == "");
    heard();
    CHECK(heard({.handGone = true}) == "lost"); // again
}

TEST_CASE("In a new run, whose time begins at 0, old alarms end and a first contact is heard") {
    ViewedRun run;
    ToneRules rules;
    run.console.switches.forces = run.console.switches.frozen = true;
    run.row.record.contactCount = 1;
    run.row.record.t = 100.0;
    run.row.record.wrench.force = {run.haptics.forceLimit, 0.0, 0.0};
    run.step();
    CHECK(run.step() == std::vector<std::string>{"CAUTION active force", "ADVISORY active frozen"});
    CHECK(rules.step(run.console, run.view, run.alarms) == Tone::Limit); // and a contact
    run.console.switches.frozen = false;
    run.row.record.wrench.force = {};
    run.row.record.t = 0.0;
    run.view.rewind();
    run.step();
    CHECK(rules.step(run.console, run.view, run.alarms) == Tone::Contact);
    run.row.record.t = 2.0;
    CHECK(run.step() == std::vector<std::string>{"CAUTION latched force", "ADVISORY latched frozen"});
    run.console.requests.acknowledge = true;
    run.step();
    REQUIRE(run.alarms.history().size() == 2);
    CHECK(run.alarms.history()[0].since <= run.alarms.history()[0].end);
}

TEST_CASE("Each tone is shorter than a second, does not click, and differs from the others") {
    std::vector<size_t> crossings;
    for (const Tone tone : {Tone::Contact, Tone::Limit, Tone::Stale, Tone::Lost}) {
        const std::vector<int16_t> samples = samplesOf(tone);
        CHECK(samples.size() > kToneRate / 20);
        CHECK(samples.size() < kToneRate);
        size_t count = 0;
        int steepest = std::abs(samples.back());
        for (size_t i = 1; i < samples.size(); ++i) {
            count += (samples[i] < 0) != (samples[i - 1] < 0) ? 1 : 0;
            steepest = std::max(steepest, std::abs(samples[i] - samples[i - 1]));
        }
        CHECK(samples.front() == 0);
        CHECK(steepest < 2000); // of a sine of 880 Hz: 1300
        crossings.push_back(count);
    }
    for (size_t a = 0; a < crossings.size(); ++a) {
        for (size_t b = 0; b < a; ++b) {
            CHECK(std::abs(static_cast<int>(crossings[a]) - static_cast<int>(crossings[b])) > 15);
        }
    }
}
