// SPDX-License-Identifier: Apache-2.0
// Histograms of times and their report.
#include "apps/latency/latency_report.h"

#include "engine/types/error.h"
#include "tests/support/scratch_folder.h"

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

using namespace fathom;

TEST_CASE("An empty histogram has no time, one value is every percentile of itself") {
    Histogram h;
    CHECK(h.percentile(0.5) == 0.0);
    CHECK(h.mean() == 0.0);
    h.add(NAN);
    h.add(INFINITY);
    CHECK(h.count() == 0);
    h.add(12.25);
    CHECK(h.percentile(0.0) == 12.25); // the bin ends at 13, but the largest value is 12.25
    CHECK(h.percentile(1.0) == 12.25);
    CHECK(h.mean() == 12.25);
    h.add(-3.0);
    CHECK(h.between(0, 1) == 1);
}

TEST_CASE("Percentiles of a histogram are those of the sorted values, rounded up to whole microseconds") {
    std::mt19937_64 random(7);
    std::lognormal_distribution<double> times(2.5, 1.5);
    for (const size_t count : {1u, 2u, 99u, 1000u, 12345u}) {
        Histogram h;
        std::vector<double> values(count);
        for (double& v : values) {
            v = std::min(times(random), 19'000.0);
            h.add(v);
        }
        std::sort(values.begin(), values.end());
        for (const double share : {0.01, 0.5, 0.99, 0.999, 1.0}) {
            const auto rank = static_cast<size_t>(std::ceil(share * static_cast<double>(count)));
            const double exact = values[std::max<size_t>(rank, 1) - 1];
            CAPTURE(count);
            CAPTURE(share);
            CHECK(h.percentile(share) >= exact);
            CHECK(h.percentile(share) <= exact + 1.0);
        }
        CHECK(h.max() == values.back());
        CHECK(h.between(0, Histogram::kBins) == count);
    }
}

TEST_CASE("Values beyond the last bin are counted, and the largest is exact") {
    Histogram h;
    h.add(1e6);
    h.add(19'999.5);
    h.add(5.0);
    CHECK(h.count() == 3);
    CHECK(h.max() == 1e6);
    CHECK(h.percentile(1.0) == 1e6);
    CHECK(h.between(10'000, Histogram::kBins) == 2);
}

TEST_CASE("A soak test passes when it ran in full, lost no frame, and memory did not grow from the first "
          "tenth to the last") {
    LatencyPart part;
    const auto soakHolds = [](const LatencyPart& p) { return fathom::soakHolds(p, 60.0); };
    CHECK_FALSE(soakHolds(part)); // nothing ran
    part.frames = 1800;
    part.seconds = 60.2;
    part.tick.add(10.0);
    CHECK_FALSE(soakHolds(part)); // memory was not measured
    for (int i = 0; i < 100; ++i) {
        part.memory.push_back(200.0 + (i == 50 ? 100.0 : 0.0) + (i > 95 ? kMaxGrowth : 0.0));
    }
    CHECK(part.memoryGrowth() == kMaxGrowth); // a peak between the ends is not a leak
    CHECK(soakHolds(part));
    part.seconds = 31.0;
    CHECK_FALSE(soakHolds(part)); // interrupted
    part.seconds = 60.0;
    part.frames = 0;
    CHECK_FALSE(soakHolds(part));
    part.frames = 1800;
    CHECK(soakHolds(part));
    part.memory.back() += 0.5;
    CHECK_FALSE(soakHolds(part));
    part.memory.assign(100, 1.0);
    part.framesLost = 1;
    CHECK_FALSE(soakHolds(part));
    part.framesLost = 0;
    part.recordsLost = 1;
    CHECK_FALSE(soakHolds(part));
    CHECK(residentMemory() > 1.0);
}

TEST_CASE("The report counts every tick in its table and in its file") {
    std::vector<LatencyPart> parts(2);
    parts[0].load = "idle";
    parts[1].load = "frames";
    std::mt19937_64 random(3);
    for (int i = 0; i < 777; ++i) {
        parts[0].late.add(static_cast<double>(random() % 30'000));
        parts[1].tick.add(static_cast<double>(random() % 300));
    }
    std::ostringstream text;
    printHistograms(text, parts);
    uint64_t late = 0, tick = 0;
    std::istringstream lines(text.str());
    std::string line;
    std::getline(lines, line);
    for (uint64_t from, a, b, c, d; lines >> from >> a >> b >> c >> d;) {
        late += a;
        tick += d;
    }
    CHECK(late == 777);
    CHECK(tick == 777);
    const testing::ScratchFolder scratch;
    const auto file = scratch.path() / "latency.json";
    writeLatency(file, parts, 1000.0, "none", true);
    const auto read = nlohmann::json::parse(std::ifstream(file));
    CHECK(read.at("ended_by_signal") == true);
    uint64_t counted = 0;
    for (const auto& bin : read.at("parts").at(0).at("woken_late").at("bins")) {
        counted += bin.at(1).get<uint64_t>();
    }
    CHECK(counted == 777);
    CHECK_THROWS_AS(writeLatency("/nowhere/x.json", parts, 1000.0, "none", false), Error);
}
