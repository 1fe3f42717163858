// SPDX-License-Identifier: Apache-2.0
// The study of time budgets: checks its test sets and its rows, but no times.
#include "apps/profile/budget_sets.h"
#include "tests/profile/quick_run.h"

#include <map>

using namespace fathom;
using namespace fathom::profile;
using namespace fathom::testing;

namespace {

std::map<std::string, std::vector<nlohmann::json>> budgetRows() {
    std::map<std::string, std::vector<nlohmann::json>> rows;
    for (const auto& row : quickRun().study("budgets")["rows"]) {
        rows[row["source"].get<std::string>()].push_back(row);
    }
    return rows;
}

std::vector<NearestSphere> nearestOf(const TouchRig& rig, const Pose& pose) {
    PosedLeaves leaves;
    poseLeaves(rig.tool, pose, rig.wall.origin, leaves);
    std::vector<NearestSphere> found;
    nearestSpheres(leaves, 0.0f, rig.grid, found);
    return found;
}

} // namespace

TEST_CASE(
    "Every CPU time budget has a row of its size and is met exactly when both percentiles are within it") {
    const auto rows = budgetRows();
    std::map<std::string, std::vector<double>> given; // budgets [us] per row, p50 then p99
    for (const auto& [what, of] : rows) {
        for (const auto& row : of) {
            const auto &p50 = row["budget_p50_ms"], &p99 = row["budget_p99_ms"];
            CHECK(row["kept"].is_null() == p50.is_null());
            if (p50.is_null()) {
                continue;
            }
            given[what].push_back(std::round(1e4 * p50.get<double>()) / 10.0);
            bool kept = row["submit_to_result_p50_ms"].get<double>() <= p50.get<double>();
            if (!p99.is_null()) {
                given[what].push_back(std::round(1e4 * p99.get<double>()) / 10.0);
                kept = kept && row["submit_to_result_p99_ms"].get<double>() <= p99.get<double>();
            }
            CHECK(row["kept"].get<double>() == (kept ? 1.0 : 0.0));
            CHECK(row["repeats"].get<int>() >= 100); // fewer give no p99
        }
    }
    CHECK(given.at("nearest touching sphere of each leaf") == std::vector{8.0, 20.0});
    CHECK(given.at("cull at 10 mm reach by the grid") == std::vector{100.0});
    CHECK(given.at("solver with real contacts, rows added and solved") == std::vector{1.5, 3.0});
    CHECK(given.at("haptic step pressed 2 mm, up to 4 solves with the full check") ==
          std::vector{30.0, 80.0});
    for (const double us : given.at("grid over the whole set")) {
        CHECK((us == 1000.0 || us == 5000.0));
    }
    CHECK(rows.at("nearest touching sphere of each leaf")[1]["setting"] == "301401 spheres, 1024 leaves");
    CHECK(rows.at("cull at 10 mm reach by the grid")[0]["setting"] == "60025 spheres, 256 leaves");
    CHECK(rows.at("grid over the whole set").back()["setting"] == "301401 spheres, one thread");
}

TEST_CASE("Budgets that apply in contact are measured in contact") {
    for (const auto& budget : budgetRows()) {
        CAPTURE(budget.first);
        for (const auto& row : budget.second) {
            if (budget.first != "grid over the whole set") {
                CHECK(row["share_in_contact"].get<double>() > 0.95);
            }
        }
    }
}

TEST_CASE("A tool placed in contact has the requested depth in the wall, measured against all spheres") {
    const TouchRig rig(90, 32, 6, 0.002);
    for (const Pose& pose : rig.poses) {
        double least = HUGE_VAL;
        const RegionSpheres& s = rig.wall.spheres;
        for (const Sphere& leaf : rig.tool.leaves()) {
            const dvec3 centre = pose.position + pose.rotation * leaf.centre;
            for (size_t i = 0; i < s.size(); ++i) {
                least = std::min(least, glm::length(centre - dvec3(s.x[i], s.y[i], s.z[i])) - leaf.radius -
                                            static_cast<double>(s.radius[i]));
            }
        }
        CHECK(least == doctest::Approx(-0.002).epsilon(1e-4));
        CHECK(rig.smallestGap(pose, 0.001) == doctest::Approx(least).epsilon(1e-9));
    }
}

TEST_CASE("A wrong, missing or invented nearest sphere is reported with its leaf") {
    const TouchRig rig(90, 32, 1, 0.002);
    const std::vector<NearestSphere> found = nearestOf(rig, rig.poses[0]);
    CHECK(nearestDiffers(rig, rig.poses[0], 0.0, found).empty());
    for (size_t i = 0; i < found.size(); ++i) {
        std::vector<NearestSphere> changed = found;
        changed[i].sphere = found[i].sphere == NearestSphere::kNone ? 7 : NearestSphere::kNone;
        CHECK(nearestDiffers(rig, rig.poses[0], 0.0, changed).find("leaf " + std::to_string(i) + " ") == 0);
        if (found[i].sphere != NearestSphere::kNone) {
            changed[i].sphere = found[i].sphere == 0 ? 1 : 0; // at the wall's corner
            CHECK(nearestDiffers(rig, rig.poses[0], 0.0, changed) ==
                  "leaf " + std::to_string(i) + " has a nearer sphere");
        }
    }
}

TEST_CASE(
    "A problem of real contacts has 64 unit rows; a zero step violates none, the target violates some") {
    const TouchRig rig(90, 2048, 12, 0.0);
    const std::vector<ContactProblem> problems = contactProblems(rig);
    REQUIRE(problems.size() >= 4);
    for (const ContactProblem& p : problems) {
        REQUIRE(p.offsets.size() == 64);
        REQUIRE(p.normals.size() == 64 * 6);
        double worst = -1.0;
        for (size_t row = 0; row < 64; ++row) {
            const double* n = p.normals.data() + 6 * row;
            CHECK(std::hypot(n[0], n[1], n[2]) == doctest::Approx(1.0));
            CHECK(p.offsets[row] <= 1e-6);
            double along = 0.0;
            for (size_t k = 0; k < 6; ++k) {
                along += n[k] * p.target[k];
            }
            worst = std::max(worst, p.offsets[row] - along);
        }
        CHECK(worst > 1e-4);
    }
}
