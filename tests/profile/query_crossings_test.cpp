// SPDX-License-Identifier: Apache-2.0
// Crossings between query methods, with synthetic times; and the text about `where: auto` against the plan.
#include "apps/profile/query_crossings.h"
#include "tests/profile/quick_run.h"

#include <algorithm>

using namespace fathom;
using namespace fathom::testing;
using namespace fathom::profile;

namespace {

// Adds CPU, GPU and brute-force rows of one tool in one set; times [ms].
void addWays(std::vector<StudyRow>& rows, double spheres, double leaves, double cpu, double gpu,
             double brute) {
    const std::string source = digits(spheres, 6) + " spheres", tool = " " + digits(leaves) + " leaves";
    for (const auto& [method, ms] : {std::pair{kCpuMethod, cpu}, {kGpuMethod, gpu}, {kBruteMethod, brute}}) {
        StudyRow row = queryRow(source, method + tool);
        row.more[kRegionSpheres] = spheres, row.more[kToolLeaves] = leaves;
        if (std::isfinite(ms)) {
            row.cost.submit = {ms, ms, ms, 5};
        }
        row.more[method == kCpuMethod ? kCpuCullWall : kGpuCullSubmit] = 0.5 * ms; // time of the culls
        rows.push_back(row);
    }
}

bool says(const std::vector<std::string>& findings, const std::string& finding) {
    return std::find(findings.begin(), findings.end(), finding) != findings.end();
}

} // namespace

TEST_CASE("The crossing is the size from which the second method is faster at every larger one, in any input "
          "order") {
    const Crossing crossing =
        crossingOf({{300, 2, 1}, {10, 2, 1}, {100, 1, 1}, {900, 9, 3}, {50, 1, 2}, {20, 2, 1}, {20, 2, 3}});
    CHECK(crossing.from == 300);                       // at 100 they are equal
    CHECK(crossing.before == std::vector<double>{10}); // in one of two pairs at 20 it is slower
    CHECK(std::isinf(crossingOf({{10, 2, 1}, {20, 1, 2}}).from));
    CHECK(crossingOf({{10, 2, 1}, {20, 2, 1}}).from == 10);
    CHECK(std::isinf(crossingOf({}).from));
}

TEST_CASE("The device is used from the leaf count at which it is faster in every set") {
    std::vector<StudyRow> rows;
    addWays(rows, 1000, 1, 1, 5, 0.2), addWays(rows, 1000, 64, 6, 5, 8), addWays(rows, 1000, 256, 9, 5, NAN);
    addWays(rows, 60000, 1, 1, 7, 3), addWays(rows, 60000, 64, 6, 7, NAN),
        addWays(rows, 60000, 256, 9, 7, NAN);
    CHECK(leavesForTheDevice(rows) == 256);
    addWays(rows, 300000, 1, 1, 7, NAN), addWays(rows, 300000, 256, 1, 7, NAN);
    CHECK(leavesForTheDevice(rows) == kNeverOnGpu);
    CHECK(leavesForTheDevice({}) == kNeverOnGpu);
}

TEST_CASE("The crossings of each set, each tool and brute force are reported, even if there is none") {
    std::vector<StudyRow> rows;
    addWays(rows, 1000, 1, 1, 5, 0.2), addWays(rows, 1000, 64, 6, 5, 8);
    addWays(rows, 60000, 1, 1, 7, 3), addWays(rows, 60000, 64, 6, 7, NAN);
    addWays(rows, 300000, 1, 9, 7, NAN), addWays(rows, 300000, 64, 9, 7, NAN);
    const std::vector<std::string> said = crossingFindings(rows);
    CHECK(said.size() == 3 + 2 + 2);
    CHECK(says(said, "contact set in 1000 spheres, device faster than CPU: from 64 tool leaves on"));
    CHECK(says(said,
               "contact set in 60000 spheres, device faster than CPU: never here (up to 64 tool leaves)"));
    CHECK(says(said, "contact set in 300000 spheres, device faster than CPU: from 1 tool leaves on"));
    CHECK(says(said, "contact set with 1 leaves, device faster than CPU: from 300 k region spheres on"));
    CHECK(says(
        said,
        "contact set with 64 leaves, device faster than CPU: from 300 k region spheres on, and at 1000"));
    // The culls take half of the times above. Sizes that brute force skips do not count.
    CHECK(says(said, "cull alone, the CPU's grid faster than brute force: from 60 k spheres x leaves on"));
    CHECK(says(said, "cull alone, the device's tree faster than brute force: from 64 k spheres x leaves on"));
}

TEST_CASE("The text about 'where: auto' matches its plan: by leaf count, and never on a CPU device") {
    DeviceFacts device;
    device.kind = DeviceKind::Discrete;
    device.gpuQueryLeaves = 64;
    const std::string some = autoDecision(device, {1, 64, 256});
    CHECK(
        some.find(
            "it asks the device with tools of 64, 256 leaves, the CPU with the others: the device is faster "
            "in every set measured from 64 leaves on") != std::string::npos);
    CHECK(autoDecision(device, {64, 256}).find("it asks the device with every tool measured") !=
          std::string::npos);
    device.gpuQueryLeaves = kNeverOnGpu;
    CHECK(autoDecision(device, {1, 256}).find("it asks the CPU with every tool measured: no tool is known") !=
          std::string::npos);
    device.gpuQueryLeaves = 1, device.kind = DeviceKind::Cpu;
    CHECK(autoDecision(device, {1, 256})
              .find("it asks the CPU with every tool measured: this device is a CPU, which it never asks") !=
          std::string::npos);
}

TEST_CASE("A run reports the crossing of each set and tool and the choice of 'where: auto', and a quick run "
          "stores nothing") {
    const auto& study = quickRun().study("query");
    const std::vector<std::string> findings = study["findings"];
    const auto count = [&](const std::string& head) {
        return std::count_if(findings.begin(), findings.end(),
                             [&](const std::string& f) { return startsWith(f, head); });
    };
    CHECK(count("contact set in ") == 2);
    CHECK(count("contact set with ") == 3);
    CHECK(count("cull alone, ") == 2);
    REQUIRE(count("'where: auto' ") == 1);
    const auto decision = std::find_if(findings.begin(), findings.end(),
                                       [](const std::string& f) { return startsWith(f, "'where: auto' "); });
    CHECK(decision->find("this device is a CPU") != std::string::npos);
    CHECK(decision->find("a quick run stores no crossover") != std::string::npos);
    for (const auto& row : study["rows"]) { // brute force is also measured where it is faster
        if (startsWith(row["source"], "0.016 k spheres")) {
            CHECK(row["submit_to_result_p50_ms"].is_null() == !startsWith(row["setting"], "brute force"));
            CHECK(row["found_spheres"].get<double>() > 0.0);
        }
    }
}
