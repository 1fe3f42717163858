// SPDX-License-Identifier: Apache-2.0
// Floors and ratios of the limit study in a quick run: figures that hold on any machine, no times.
#include "tests/profile/quick_run.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

using namespace fathom;
using namespace fathom::testing;

namespace {

const std::string kWhole = "submission and all passes";

// The smallest floor of the device's steps: the time of an empty dispatch.
double emptyDispatchMs(const nlohmann::json& rows) {
    double least = std::numeric_limits<double>::infinity();
    for (const auto& row : rows) {
        const double floor = row["floor_ms"];
        least = row["gpu_p50_ms"].is_null() || floor == 0.0 ? least : std::min(least, floor);
    }
    return least;
}

} // namespace

TEST_CASE("Every frame pass has a row in the limit study, including those of another camera and the "
          "device query") {
    std::map<std::string, std::set<std::string>> steps;
    for (const auto& row : quickRun().study("limit")["rows"]) {
        steps[row["source"]].insert(row["setting"].get<std::string>());
    }
    REQUIRE(steps.size() == 4);
    for (const char* pass : {"upload", "occlusion", "classify", "list", "surface", "thin", "spheres", "tree",
                             "tree_query", "moments", "deliver", "collect", "grid"}) {
        CAPTURE(std::string(pass));
        CHECK(steps.at("two cameras, query on the device").count(pass) == 1);
    }
    CHECK(steps.at("10 % forbidden").count("occlusion") == 0);
}

TEST_CASE("A step's floor is the longest of moving, computing and an empty dispatch; its ratio is the "
          "measured time over the floor") {
    const auto& rows = quickRun().study("limit")["rows"];
    const double dispatch = emptyDispatchMs(rows);
    for (const auto& row : rows) {
        const double moving = row["moving_ms"], computing = row["computing_ms"], floor = row["floor_ms"];
        const std::string step = row["setting"];
        if (step == kWhole) {
            continue;
        }
        const bool host = step == "upload" || step == "collect" || step == "grid";
        const auto& time = row[host ? "wall_p50_ms" : "gpu_p50_ms"];
        CHECK(row[host ? "gpu_p50_ms" : "wall_p50_ms"].is_null());
        CHECK(row["cpu_p50_ms"].is_null()); // the threads' CPU time is not measured
        const double work = std::max(moving, computing);
        CHECK(floor == (work == 0.0 || host ? work : std::max(work, dispatch)));
        if (floor == 0.0) { // empty dispatch: all pixels are forbidden, none is guidance
            CHECK(row["setting"] == "moments");
            CHECK(startsWith(row["source"], "100 % forbidden"));
            CHECK(row["ratio"].is_null());
            continue;
        }
        CHECK(moving > 0.0);
        CHECK(row["ratio"].get<double>() * floor == doctest::Approx(time.get<double>()));
    }
}

TEST_CASE("All passes cannot be faster than an empty submission and the floors of all passes together") {
    std::map<std::string, double> passes, whole;
    for (const auto& row : quickRun().study("limit")["rows"]) {
        const double floor = row["floor_ms"];
        if (row["setting"] == kWhole) {
            whole[row["source"]] = floor;
            CHECK(row["ratio"].get<double>() * floor ==
                  doctest::Approx(row["submit_to_result_p50_ms"].get<double>()));
        } else if (!row["gpu_p50_ms"].is_null() && row["setting"] != "tree_query") {
            passes[row["source"]] += floor;
        }
    }
    REQUIRE(whole.size() == 4);
    const double submission = whole.begin()->second - passes.at(whole.begin()->first);
    CHECK(submission > 0.0);
    for (const auto& [source, floor] : whole) {
        CHECK(floor - passes.at(source) == doctest::Approx(submission));
    }
}
