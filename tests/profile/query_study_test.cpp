// SPDX-License-Identifier: Apache-2.0
// Results of the query study in a quick run: figures that hold on any machine, no times.
#include "apps/profile/late_answers.h"
#include "apps/profile/query_rows.h"
#include "tests/profile/quick_run.h"

#include <map>

using namespace fathom;
using namespace fathom::testing;
using namespace fathom::profile;

namespace {

StudyRow lateAnswers(const char* source, double reach, double stalled, bool isDefault) {
    StudyRow row = queryRow(source, "reach " + digits(reach) + " mm");
    row.more[kReachMm] = reach, row.more[kStalledTicks] = stalled;
    row.isDefault = isDefault;
    return row;
}

} // namespace

TEST_CASE("With late answers, a short reach stalls and lags, and a long one does not") {
    std::map<std::string, nlohmann::json> rows;
    for (const auto& row : quickRun().study("query")["rows"]) {
        rows[row["source"].get<std::string>() + ", " + row["setting"].get<std::string>()] = row;
    }
    const auto& brief = rows.at("answers 10 ticks late, reach 2 mm");
    const auto& ample = rows.at("answers 10 ticks late, reach 10 mm");
    CHECK(brief["stalled_turns"].get<double>() > ample["stalled_turns"].get<double>());
    CHECK(brief["found_spheres"].is_null());
    CHECK(brief["error"].get<double>() > ample["error"].get<double>());
}

TEST_CASE("The plot shows stalls as a percentage of ticks over the reach, one line per delay, the longest at "
          "the bottom") {
    const PlotPanel panel = stallPanel({lateAnswers("answers 0 ticks late", 5.0, 0.0, false),
                                        lateAnswers("answers 0 ticks late", 10.0, 0.0, true),
                                        lateAnswers("answers 20 ticks late", 5.0, 300.0, false),
                                        lateAnswers("answers 20 ticks late", 10.0, 75.0, true)},
                                       300);
    REQUIRE(panel.series.size() == 2);
    const PlotSeries &late = panel.series[0],
                     &early = panel.series[1]; // in drawing order
    CHECK(late.name == "answers 20 ticks late");
    CHECK(early.name == "answers 0 ticks late");
    CHECK(late.name != early.name);
    REQUIRE(late.points.size() == 2);
    CHECK(late.connect);
    CHECK(late.points[0].x == 5.0);
    CHECK(late.points[0].y == 100.0);
    CHECK(late.points[1].x == 10.0);
    CHECK(late.points[1].y == 25.0);
    CHECK(late.points[1].isDefault);
    CHECK(late.points[1].label == "reach 10 mm");
    CHECK(early.points[1].y == 0.0);
    CHECK(panel.xLabel == "reach [mm]");
    CHECK(panel.yLabel == "stalled ticks [% of 300]");
    CHECK(!panel.logY); // so that 0 can be shown
}

TEST_CASE("A row of the query study counts either found spheres or stalled ticks, each in its own column") {
    std::map<std::string, double> found;
    for (const auto& row : quickRun().study("query")["rows"]) {
        const bool late = startsWith(row["source"], "answers ");
        CHECK(row["found_spheres"].is_null() == late);
        CHECK(row["stalled_turns"].is_null() != late);
        CHECK(row["error"].is_null() != late); // only the drag has a lag
        if (!late) {
            found[row["source"].get<std::string>() + " " + row["setting"].get<std::string>()] =
                row["found_spheres"];
        }
    }
    CHECK(found.at("12.29 k spheres CPU 1000 leaves") > 10.0);
    CHECK(found.at("12.29 k spheres CPU 1000 leaves") == found.at("12.29 k spheres GPU 1000 leaves"));
    CHECK(found.at("12.29 k spheres CPU 1000 leaves") >= found.at("12.29 k spheres CPU 1 leaves"));
}

TEST_CASE("CPU and GPU rows have the cull alone as well as the full contact set, each with its own clocks") {
    std::map<std::string, size_t> rows;
    for (const auto& row : quickRun().study("query")["rows"]) {
        const std::string setting = row["setting"];
        const bool cpu = startsWith(setting, "CPU "), gpu = startsWith(setting, "GPU ");
        CAPTURE(setting);
        CHECK(row["cpu_cull_wall_p50_ms"].is_null() == !cpu);
        CHECK(row["cpu_cull_cpu_p50_ms"].is_null() == !cpu);
        CHECK(row["gpu_cull_submit_to_result_p50_ms"].is_null() == !gpu);
        ++rows[cpu ? "CPU" : gpu ? "GPU" : "neither"];
        if (cpu) {
            CHECK(row["cpu_cull_wall_p50_ms"].get<double>() > 0.0);
            rows["wall is CPU"] += row["cpu_cull_wall_p50_ms"] == row["cpu_cull_cpu_p50_ms"] ? 1 : 0;
            rows["cull is whole"] += row["cpu_cull_wall_p50_ms"] == row["submit_to_result_p50_ms"] ? 1 : 0;
        }
    }
    CHECK(rows["CPU"] == 6 + 9); // in sets of an image, and among few spheres
    CHECK(rows["GPU"] == 6);
    CHECK(rows["neither"] == 6 + 9 + 4); // brute force, late answers
    CHECK(rows["wall is CPU"] < 15);     // two clocks may agree by chance
    CHECK(rows["cull is whole"] < 6);
}
