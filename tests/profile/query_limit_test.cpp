// SPDX-License-Identifier: Apache-2.0
// The minimum bytes and operations of a device query, counted by hand.
#include "apps/profile/query_limit.h"
#include "tests/profile/quick_run.h"

using namespace fathom;
using namespace fathom::testing;
using namespace fathom::profile;

TEST_CASE("A query's floor counts every patch, and the leaves, slots and spheres of patches with an answer") {
    const PatchLayout layout = patchLayout(32, 32);
    REQUIRE(layout.patches() == 4);
    const std::vector<uint32_t> patches{0, 0, 1, 3, 3}, found{0, 3};
    const QueryWork work = leastQueryWork(layout, 2, 5, patches, found, 7);
    CHECK(work.bytes == 120 + 16 * (4 + 5 + 2 * 2 * 256) + 32 * 2 + 4 * 7);
    const double bounds = 4, leaves = 2 * 5, pairs = 7, others = 2;
    CHECK(work.operations == 12 * (bounds + leaves + pairs + others));
}

TEST_CASE("A query that finds nothing still tests the bound of every patch") {
    const std::vector<uint32_t> patches{0, 1};
    const QueryWork work = leastQueryWork(patchLayout(32, 32), 1, 5, patches, {}, 0);
    CHECK(work.bytes == 120 + 16 * 4);
    CHECK(work.operations == 12 * 4);
}

TEST_CASE("The limit study has a row for the device's query exactly when the scene uses the device") {
    size_t rows = 0;
    for (const auto& row : quickRun().study("limit")["rows"]) {
        if (row["setting"] == "tree_query") {
            ++rows;
            CHECK(row["source"] == "two cameras, query on the device");
            CHECK(row["MB_that_must_move"].get<double>() > 16e-6 * 256);       // at least one patch
            CHECK(row["million_operations"].get<double>() >= 12e-6 * 20 * 15); // the bounds
            CHECK(row["ratio"].get<double>() > 0.0);
        }
    }
    CHECK(rows == 1);
}
