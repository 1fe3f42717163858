// SPDX-License-Identifier: Apache-2.0
// The minimum bytes and operations of a device query, counted by hand.
#include "apps/profile/query_limit.h"
#include "tests/profile/quick_run.h"

using namespace fathom;
using namespace fathom::testing;
using namespace fathom::profile;

TEST_CASE(
    "A query's floor counts each node on the way to its answer once, and the tests of every invocation") {
    const PatchLayout layout = patchLayout(32, 32); // 64 sub-patches, 4 patches, a root
    REQUIRE(layout.levels.size() == 3);
    // Two keys in sub-patch 0, one in sub-patch 31 (the last of patch 1), and a held one in sub-patch 49 (in
    // patch 3).
    const std::vector<uint32_t> keys{0, 1, 512 + 255, 3 * 512 + 256 + 17}, found{3, 0};
    const QueryWork work = leastQueryWork(layout, 2, 5, keys, found);
    const double nodes = 3, subs = 2, slots = 2 * 16; // nodes: patches 0, 3, root; slots: two layers
    CHECK(work.bytes == 144 + 4 * (1 + 2) + 16 * (nodes + subs * (1 + slots) + 5));
    const double roots = 64, down = 2 * (2 + 4), leaves = 2 * 5, others = 1;
    CHECK(work.operations == 12 * (roots + down + leaves + others));
}

TEST_CASE("A query that finds nothing still tests the root per sub-patch and reads the roots of both trees") {
    const std::vector<uint32_t> keys{0, 1};
    const QueryWork work = leastQueryWork(patchLayout(32, 32), 1, 5, keys, {});
    CHECK(work.bytes == 144 + 4 + 2 * 16);
    CHECK(work.operations == 12 * 64);
}

TEST_CASE("The limit study has a row for the device's query exactly when the scene uses the device") {
    size_t rows = 0;
    for (const auto& row : quickRun().study("limit")["rows"]) {
        if (row["setting"] == "tree_query") {
            ++rows;
            CHECK(row["source"] == "two cameras, query on the device");
            CHECK(row["MB_that_must_move"].get<double>() > 16e-6 * 16);        // at least one sub-patch
            CHECK(row["million_operations"].get<double>() >= 12e-6 * 80 * 60); // the roots
            CHECK(row["ratio"].get<double>() > 0.0);
        }
    }
    CHECK(rows == 1);
}
