// SPDX-License-Identifier: Apache-2.0
// The lines under an exported image.
#include "apps/operate/caption.h"
#include "tests/apps/viewed_run.h"

#include <algorithm>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::operate;

TEST_CASE("A caption has time and pilot, then state, force and gap, then the lines of the job") {
    ViewedRun run;
    run.row.record.wrench.force = {3.0, 0.0, 4.0};
    run.step(0.001);
    DepthCues cues;
    cues.gap = 0.012;
    const std::vector<std::string> job{"Vessel A", "Valve 7"};
    const auto lines = [&](const std::string& pilot) {
        return captionOf({{run.console, run.view, run.haptics}, cues, pilot, job});
    };
    const auto live = lines("");
    REQUIRE(live.size() == 4);
    CHECK(live[0].size() == std::string("2026-11-27 13:00:00 +0000").size());
    CHECK(live[0].find("pilot") == std::string::npos);
    CHECK(live[1] == "FORCES OFF   force 5.00 N   torque 0.000 N m   gap 12 mm");
    CHECK(live[3] == "Valve 7");
    run.console.timeLine.on = true;
    run.console.timeLine.t = 1.5;
    run.console.timeLine.frame = 45;
    run.console.timeLine.frames = 90;
    CHECK(lines("Ann")[0] == "recording, 1.500 s, frame 46 of 90   pilot Ann");
    CHECK(lines("")[1].find("LOOK-BACK  ") == 0);
}

TEST_CASE("A caption fits its room: one row per line, and a long line is shortened") {
    const auto lightIn = [](const std::vector<std::string>& lines) {
        const int top = 20, height = captionHeight(400, lines.size());
        const Image image(400, top + height, {0.5, 0.5, 0.5});
        drawCaption(image, top, lines);
        image.beginPixels();
        std::vector<int> light(static_cast<size_t>(height), 0);
        int right = 0;
        for (int v = 0; v < height; ++v) {
            for (int u = 0; u < 400; ++u) {
                const bool on = (image.row(top + v)[u] & 0xffu) > 150;
                light[static_cast<size_t>(v)] += on ? 1 : 0;
                right = on ? std::max(right, u) : right;
            }
        }
        CHECK((image.row(top - 1)[5] & 0xffu) == 128); // the image above stays
        image.endPixels();
        CHECK(light.front() == 0);
        CHECK(light.back() == 0);
        return right;
    };
    CHECK(captionHeight(400, 0) == 0);
    CHECK(lightIn({"one"}) < 60);
    CHECK(lightIn({"one", "two", "three"}) < 60);
    const int right = lightIn({std::string(300, 'x'), "gap"});
    CHECK(right > 340);
    CHECK(right < 396);
}
