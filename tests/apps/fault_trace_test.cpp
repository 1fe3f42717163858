// SPDX-License-Identifier: Apache-2.0
#include "apps/output/fault_trace.h"

#include "apps/output/haptics_csv.h"
#include "tests/support/scratch_folder.h"

#include <algorithm>
#include <doctest/doctest.h>
#include <sstream>

using namespace fathom;
using namespace fathom::testing;

namespace {

struct Nothing final : RunSink {
    uint64_t ticks = 0;
    void frame(const PublishedFrame&, const HostFixtures&) override {}
    void query(const QueryNote&) override {}
    void step(const TickRow&, const ObeyedSet&) override { ++ticks; }
};

TickRow tickAt(double t, bool finite = true) {
    TickRow row;
    row.record.t = t;
    row.record.finite = finite;
    row.record.device.position.x = finite ? t : kNotKnown;
    return row;
}

struct Traced {
    explicit Traced(const std::filesystem::path& folder)
        : trace(folder, 0.001, next) {}
    // One tick per millisecond over [from, to), including `broken`.
    void ticks(double from, double to, double broken = -1.0) {
        for (auto i = static_cast<int>(std::lround(from * 1000.0)); i < std::lround(to * 1000.0); ++i) {
            const double t = 0.001 * i;
            trace.step(tickAt(t, std::abs(t - broken) > 1e-6), {});
        }
    }
    Nothing next;
    FaultTrace trace;
};

std::vector<std::string> linesOf(const std::filesystem::path& file) {
    std::vector<std::string> lines;
    std::istringstream text(textOf(file));
    for (std::string line; std::getline(text, line);) {
        lines.push_back(line);
    }
    return lines;
}

} // namespace

TEST_CASE("A non-finite tick writes the ticks of the two seconds before it and itself as the last") {
    const ScratchFolder folder;
    Traced run(folder.path());
    run.ticks(0.0, 5.0, 4.5);
    CHECK(run.next.ticks == 5000);
    REQUIRE(folder.files() == 1);
    const auto lines = linesOf(folder.path() / "fault-4.500.csv");
    REQUIRE(lines.size() == 2001); // the buffer's ticks, and the header
    CHECK(lines[0] == HapticsCsv::kHeader);
    CHECK(std::stod(lines[1]) == doctest::Approx(2.501));
    CHECK(std::stod(lines[2000]) == doctest::Approx(4.5));
    CHECK(lines[2000].find(",nan,") != std::string::npos);
    CHECK(lines[1999].find("4.49") == 0);
    const auto columns = std::count(lines[0].begin(), lines[0].end(), ',');
    CHECK(std::count(lines[2000].begin(), lines[2000].end(), ',') == columns);
}

TEST_CASE("A shorter run writes all its ticks, and one with pauses at most two seconds") {
    const ScratchFolder folder;
    Traced run(folder.path());
    run.ticks(0.0, 0.1, 0.05);
    CHECK(linesOf(folder.path() / "fault-0.050.csv").size() == 52);
    Traced paused(folder.path());
    paused.ticks(0.0, 0.5);
    paused.ticks(2.1, 3.0, 2.2);
    const auto lines = linesOf(folder.path() / "fault-2.200.csv");
    REQUIRE(lines.size() > 390);
    CHECK(lines.size() <= 1 + 300 + 101);
    CHECK(std::stod(lines[1]) >= 0.2);
}

TEST_CASE("Non-finite ticks write at most one file per minute, and a run with its own clock starts again") {
    const ScratchFolder folder;
    Traced run(folder.path());
    run.ticks(1.0, 1.1, 1.05);
    run.ticks(60.0, 61.1, 61.0);
    CHECK(folder.files() == 1);
    run.ticks(61.1, 61.2, 61.1);
    CHECK(folder.files() == 2);
    run.ticks(0.0, 0.2, 0.1);
    CHECK(folder.files() == 3);
    CHECK(linesOf(folder.path() / "fault-0.100.csv").size() == 102); // no tick of the run before
}

TEST_CASE("A run with finite ticks writes no file, and a file that cannot be written stops nothing") {
    const ScratchFolder folder;
    Traced run(folder.path());
    run.ticks(0.0, 3.0);
    CHECK(folder.files() == 0);
    Traced nowhere(folder.path() / "none");
    CHECK_NOTHROW(nowhere.ticks(0.0, 0.1, 0.05));
    CHECK(nowhere.next.ticks == 100);
}
