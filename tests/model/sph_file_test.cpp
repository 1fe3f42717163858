// SPDX-License-Identifier: Apache-2.0
#include "engine/model/sph_file.h"
#include "engine/types/error.h"
#include "tests/support/refusal.h"
#include "tests/support/scratch_folder.h"

#include <cmath>
#include <doctest/doctest.h>

using namespace fathom;

namespace {

std::string refusal(const std::string& text) {
    const testing::ScratchFile file("tree.sph", text);
    return testing::refusalOf([&] { readSph(file.path()); });
}

size_t usedLeaves(const SphereTree& tree) {
    size_t used = 0;
    for (const Sphere& s : tree.lastLevel()) {
        used += s.radius >= 0.0 ? 1 : 0;
    }
    return used;
}

} // namespace

TEST_CASE("A written tree is read back with bit-identical leaves") {
    for (size_t count : {1u, 2u, 3u, 17u, 500u}) {
        std::vector<Sphere> leaves;
        for (size_t i = 0; i < count; ++i) {
            const double a = static_cast<double>(i);
            leaves.push_back({{std::sin(a) / 3, std::cos(2 * a) / 7, 0.1 * a}, 0.01 / (1 + a)});
        }
        const SphereTree tree = buildSphereTree(leaves);
        const testing::ScratchFile file("tree.sph");
        writeSph(tree, file.path());
        const SphereTree back = readSph(file.path());
        CHECK(validate(back) == "");
        CHECK(back.levels == tree.levels);
        CHECK(back.degree == tree.degree);
        REQUIRE(back.nodes.size() == tree.nodes.size());
        size_t different = 0;
        for (size_t i = tree.firstLeaf(); i < tree.nodes.size(); ++i) {
            different += back.nodes[i].radius != tree.nodes[i].radius ? 1 : 0;
            different += tree.nodes[i].radius >= 0 && back.nodes[i].centre != tree.nodes[i].centre ? 1 : 0;
        }
        CHECK(different == 0);
        CHECK(usedLeaves(back) == count);
    }
}

TEST_CASE("The toolkit's variants are read: four, five, nine and ten columns, blank lines, text at the end") {
    const testing::ScratchFile file("tree.sph",
                                    "2 4\n\n0 0 0 9 1\n1 0 0 0.5\r\n0 1 0 0.5 0.75\n  0 0 1 0.5 1 2 3 4 0.1\n"
                                    "\n0 0 -1 0.5 0.9 1 2 3 4 0.1\nMean: 0.5\nBest 1\nWorst 2\n");
    const SphereTree tree = readSph(file.path(), 0.001);
    CHECK(validate(tree) == "");
    REQUIRE(tree.nodes.size() == 5);
    CHECK(usedLeaves(tree) == 4);
    CHECK(tree.nodes[2].centre == dvec3(0, 0.001, 0));
    CHECK(tree.nodes[4].radius == 0.0005);
}

TEST_CASE("A byte order mark in front of a tree is skipped") {
    CHECK(refusal("\xEF\xBB\xBF"
                  "1 1\n0 0 0 1\n") == "");
    CHECK(refusal("1 1\n\xEF\xBB\xBF"
                  "0 0 0 1\n") != "");
}

TEST_CASE("Radii above the leaves are recomputed, whether the file's are too small or too large") {
    for (const char* radius : {"0.001", "1000"}) {
        const testing::ScratchFile file("tree.sph",
                                        "2 2\n0 0 0 " + std::string(radius) + "\n-1 0 0 0.25\n2 0 0 0.5\n");
        const SphereTree tree = readSph(file.path());
        CHECK(tree.nodes[0].radius == doctest::Approx(2.5).epsilon(1e-9));
        CHECK(tree.nodes[0].radius >= 2.5);
        CHECK(validate(tree) == "");
    }
}

TEST_CASE("Slots below an unused slot are unused, even when they contain garbage") {
    const testing::ScratchFile file(
        "tree.sph", "3 2\n0 0 0 5\n1 0 0 1\nnan nan 0 -1\n1 0 0 0.5\n1.5 0 0 0.5\n77 77 77 3\n88 0 0 9\n");
    CHECK(refusal("1 1\n0 0 0 -1\n").find("root node: unused") != std::string::npos);
    const SphereTree tree = readSph(file.path());
    CHECK(usedLeaves(tree) == 2);
    CHECK(tree.nodes[5].radius < 0.0);
    CHECK(validate(tree) == "");
}

TEST_CASE("A sphere that the toolkit did not refine reaches the last level") {
    const testing::ScratchFile file(
        "tree.sph", "3 2\n0 0 0 5\n1 0 0 1\n-3 0 0 0.5\n1 0 0 0.5\n1.5 0 0 0.5\n0 0 0 -1\n0 0 0 -1\n");
    const SphereTree tree = readSph(file.path());
    CHECK(usedLeaves(tree) == 3);
    CHECK(tree.nodes[5].centre == dvec3(-3, 0, 0));
    CHECK(tree.nodes[5].radius == 0.5);
    CHECK(validate(tree) == "");
}

TEST_CASE("A damaged file is rejected with its line and allocates no more than its content") {
    CHECK(refusal("").find("line 1: end of file") != std::string::npos);
    CHECK(refusal("0 2\n").find("line 1: '0 2'") != std::string::npos);
    CHECK(refusal("2 0\n0 0 0 1\n").find("line 1: '2 0'") != std::string::npos);
    CHECK(refusal("two 2\n").find("line 1: 'two 2'") != std::string::npos);
    CHECK(refusal("-1 2\n").find("line 1: ") != std::string::npos);
    CHECK(refusal("30 8\n0 0 0 1\n").find("at most 2 nodes") != std::string::npos);
    CHECK(refusal("4294967295 4294967295\n0 0 0 1\n").find("line 1: ") != std::string::npos);
    CHECK(refusal("4294967295 1\n0 0 0 1\n").find("line 1: ") != std::string::npos);
    CHECK(refusal("2 2\n0 0 0 1.00000\n1 0 0 1.00000\n").find("line 4: end of file") != std::string::npos);
    CHECK(refusal("1 1\n0 0 0\n").find("line 2: '0 0 0'") != std::string::npos);
    CHECK(refusal("1 1\n0 0 0 1 1 1\n").find("line 2: ") != std::string::npos);
    CHECK(refusal("1 1\n0 nan 0 1\n").find("line 2: '0 nan 0 1'") != std::string::npos);
    CHECK(refusal("1 1\n0 0 0 inf\n").find("line 2: ") != std::string::npos);
    CHECK(refusal("1 1\n0 0 0 nan\n").find("line 2: ") != std::string::npos);
    CHECK(refusal("1 1\n1e200 0 0 1\n").find("line 2: ") != std::string::npos);
    CHECK(refusal("1 1\n0 0 0 1x\n").find("line 2: ") != std::string::npos);
    CHECK_THROWS_AS(readSph("no/such/tree.sph"), BadInput);
    CHECK_THROWS_AS(readSph("tests"), BadInput);
}

TEST_CASE("An invalid tree is not written, and an unwritable path is reported") {
    SphereTree tree = buildSphereTree(std::vector<Sphere>{{{0, 0, 0}, 1}, {{3, 0, 0}, 1}});
    CHECK_THROWS_AS(writeSph(tree, "no/such/folder/tree.sph"), Error);
    tree.nodes[1].radius = 5.0;
    const testing::ScratchFile file("tree.sph");
    CHECK_THROWS_AS(writeSph(tree, file.path()), Error);
    CHECK(std::filesystem::file_size(file.path()) == 0);
}
