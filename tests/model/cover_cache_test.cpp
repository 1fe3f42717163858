// SPDX-License-Identifier: Apache-2.0
#include "engine/model/cover_cache.h"

#include "engine/model/cover_links.h"
#include "tests/model/meshes.h"
#include "tests/support/scratch_folder.h"

#include <cstdlib>
#include <doctest/doctest.h>
#include <fstream>

using namespace fathom;
using fathom::testing::ScratchFolder;

namespace {

std::filesystem::path onlyFileOf(const ScratchFolder& folder) {
    return std::filesystem::directory_iterator(folder.path())->path();
}

const ShapeSpheres kMade{{{{0.1, 1.0 / 3.0, -2.0}, 1.0 / 7.0}}, {"a note"}, {}};

} // namespace

TEST_CASE("A cached cover is given back bit by bit, and not for other content, options or a damaged file") {
    const ScratchFolder folder;
    const CoverCache cache(folder.path());
    const testing::ObjFile one(testing::boxMesh(dvec3(0.0), dvec3(0.1))),
        two(testing::boxMesh(dvec3(0.0), dvec3(0.2)));
    const std::string key = cache.keyOf(one.path(), "24");
    CHECK_FALSE(cache.find(key));
    cache.store(key, kMade);
    const auto found = cache.find(key);
    REQUIRE(found);
    CHECK(found->spheres[0].centre == kMade.spheres[0].centre);
    CHECK(found->spheres[0].radius == kMade.spheres[0].radius);
    CHECK(found->notes == kMade.notes);
    CHECK(cache.keyOf(two.path(), "24") != key);
    CHECK(cache.keyOf(one.path(), "25") != key);
    CHECK(cache.keyOf("no/such/file.obj", "24") == "");
    std::filesystem::resize_file(onlyFileOf(folder), std::filesystem::file_size(onlyFileOf(folder)) - 3);
    CHECK_FALSE(cache.find(key));
    for (const char* text : {"", "\n", "fathom cover 1\n", "fathom cover 1\n1 2 3\n0000\n"}) {
        std::ofstream(folder / key) << text;
        CHECK_FALSE(cache.find(key));
    }
}

TEST_CASE("A link's mesh is covered once, and the second time its cover comes from the cache") {
    const ScratchFolder folder;
    REQUIRE(::setenv("XDG_CACHE_HOME", folder.path().c_str(), 1) == 0);
    const testing::ObjFile file(testing::boxMesh(dvec3(0.0), dvec3(0.1)));
    const auto mesh = std::make_shared<urdf::Mesh>();
    mesh->filename = file.path().string();
    mesh->scale = urdf::Vector3(1.0, 1.0, 1.0);
    const std::vector<LinkGeometry> shapes{{"a", mesh}};
    const auto first = spheresOf(shapes, {"arm.urdf", {}}, 8);
    const CoverCache cache;
    REQUIRE(std::filesystem::exists(cache.folder()));
    const auto stored = std::filesystem::directory_iterator(cache.folder())->path();
    CHECK(spheresOf(shapes, {"arm.urdf", {}}, 8)[0].spheres.size() == first[0].spheres.size());
    cache.store(stored.filename().string(), kMade); // to see which one is used
    CHECK(spheresOf(shapes, {"arm.urdf", {}}, 8)[0].spheres.size() == 1);
    CHECK(spheresOf(shapes, {"arm.urdf", {}}, 9)[0].spheres.size() > 1);
    ::unsetenv("XDG_CACHE_HOME");
}

TEST_CASE("A long start names the cache only for covers that are in it, so not for boxes or a folder that "
          "cannot be written") {
    const ScratchFolder folder;
    std::ofstream(folder / "file") << "x";
    CHECK(CoverCache(folder.path()).store("key", kMade));
    CHECK_FALSE(CoverCache(folder / "file" / "covers").store("key", kMade));
    CHECK_FALSE(CoverCache(folder.path()).store("", kMade));
    CHECK(coverProgressText(3, 8, 0, folder.path()) == "3 of 8 shapes are covered with spheres");
    CHECK(coverProgressText(7, 8, 2, "covers") ==
          "7 of 8 shapes are covered with spheres; the next start finds 2 of them in covers");
}

TEST_CASE("The cache keeps a bounded number of files, the newest ones") {
    const ScratchFolder folder;
    const CoverCache cache(folder.path());
    std::filesystem::create_directories(folder.path());
    for (size_t i = 0; i < CoverCache::kMaxFiles + 20; ++i) {
        std::ofstream(folder / ("old" + std::to_string(i))) << "x";
    }
    cache.store("new", kMade);
    const auto all = std::filesystem::directory_iterator(folder.path());
    CHECK(static_cast<size_t>(std::distance(begin(all), end(all))) == CoverCache::kMaxFiles);
    CHECK(cache.find("new"));
}
