// SPDX-License-Identifier: Apache-2.0
#include "apps/output/fixtures_ply.h"

#include "tests/support/scratch_folder.h"

#include <cstring>
#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::testing;

namespace {

HostFixtures setOf(size_t count) {
    HostFixtures set;
    set.frame = 12;
    set.origin = {1000.125, -2.0, 0.3};
    set.camera.depth.width = 4;
    set.camera.depth.height = 3;
    for (size_t i = 0; i < count; ++i) {
        set.spheres.x.push_back(0.1f * static_cast<float>(i));
        set.spheres.y.push_back(-0.3f);
        set.spheres.z.push_back(1.7f);
        set.spheres.radius.push_back(0.04f);
        set.spheres.source.push_back(static_cast<uint32_t>(11 + i)); // 12 pixels: held from the second on
        set.spheres.fixture.push_back(static_cast<uint8_t>(i % 2));
    }
    return set;
}

template <class T>
T valueAt(const std::string& bytes, size_t offset) {
    T value;
    std::memcpy(&value, bytes.data() + offset, sizeof value); // this test runs on little-endian machines
    return value;
}

} // namespace

TEST_CASE(
    "A fixture set is a PLY of doubles in the base frame, with class and held, for 0, 1 and 37 spheres") {
    const ScratchFolder folder;
    for (const size_t count : {size_t{0}, size_t{1}, size_t{37}}) {
        const HostFixtures set = setOf(count);
        const auto path = folder.path() / "set.ply";
        std::filesystem::remove(path); // read below, and inputs are never replaced
        writeFixturesPly(path, set);
        const std::string text = textOf(path);
        const std::string end = "end_header\n";
        const size_t body = text.find(end) + end.size();
        const std::string header = text.substr(0, body);
        CHECK(header.starts_with("ply\nformat binary_little_endian 1.0\n"));
        CHECK(header.find(
                  "element vertex " + std::to_string(count) +
                  "\nproperty double x\nproperty double y\n"
                  "property double z\nproperty double radius\nproperty int class\nproperty int held\n") !=
              std::string::npos);
        REQUIRE(text.size() == body + count * 40);
        for (size_t i = 0; i < count; ++i) {
            const size_t at = body + 40 * i;
            CHECK(valueAt<double>(text, at) == 1000.125 + double{set.spheres.x[i]});
            CHECK(valueAt<double>(text, at + 8) == -2.0 + double{-0.3f});
            CHECK(valueAt<double>(text, at + 16) == 0.3 + double{1.7f});
            CHECK(valueAt<double>(text, at + 24) == double{0.04f});
            CHECK(valueAt<int32_t>(text, at + 32) == static_cast<int32_t>(i % 2));
            CHECK(valueAt<int32_t>(text, at + 36) == (i >= 1 ? 1 : 0));
        }
    }
}

TEST_CASE("Fixture files have the frame index with at least six digits as their name") {
    CHECK(fixturesFileName(0) == "fixtures/000000.ply");
    CHECK(fixturesFileName(123) == "fixtures/000123.ply");
    CHECK(fixturesFileName(1234567) == "fixtures/1234567.ply");
}
