// SPDX-License-Identifier: Apache-2.0
// The pipeline cache with files that are truncated, foreign, too large or of another kind.
#include "engine/gpu/pipeline.h"
#include "engine/gpu/query_crossover.h"
#include "engine/types/error.h"
#include "shaders/ceiling.h"
#include "shaders/shared/constants.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/vulkan.h"

#include <csignal>
#include <cstdlib>
#include <doctest/doctest.h>
#include <fstream>
#include <iterator>
#include <string>

#include <sys/resource.h>
#include <sys/stat.h>

using namespace fathom;
using fathom::testing::Vulkan;
using fathom::testing::vulkan;

namespace {

namespace fs = std::filesystem;

// Sets the user's cache folder while it exists.
class CacheFolder {
public:
    CacheFolder() {
        const char* was = std::getenv("XDG_CACHE_HOME");
        before_ = was == nullptr ? "" : was;
        vulkan(); // the shared device keeps its own folder
        ::setenv("XDG_CACHE_HOME", (folder_ / "new").c_str(), 1);
    }
    ~CacheFolder() {
        before_.empty() ? ::unsetenv("XDG_CACHE_HOME") : ::setenv("XDG_CACHE_HOME", before_.c_str(), 1);
    }
    CacheFolder(const CacheFolder&) = delete;
    CacheFolder& operator=(const CacheFolder&) = delete;

    // Opens a device, compiles a pipeline and closes the device. Returns the number of bytes stored.
    size_t openOnce() const {
        {
            gpu::Device device(vulkan().instance, Vulkan::selector());
            const gpu::Pipeline pipeline(device, {"ceiling",
                                                  ceiling_spv,
                                                  {gpu::kStorage},
                                                  {{shared::kSpecGroupSize, 64}, {shared::kSpecRounds, 1}}});
            REQUIRE(pipeline.handle() != VK_NULL_HANDLE);
        }
        return gpu::storedPipelines(file()).size();
    }
    fs::path file() const { return gpu::cacheFileOf(vulkan().device.physical(), ".pipelines"); }
    size_t files() const {
        return static_cast<size_t>(std::distance(fs::directory_iterator(file().parent_path()), {}));
    }
    void write(const std::string& bytes) const { std::ofstream(file(), std::ios::binary) << bytes; }

private:
    testing::ScratchFolder folder_;
    std::string before_;
};

} // namespace

TEST_CASE("A device opens with a pipeline file that is truncated, foreign, empty or changed, and stores a "
          "valid one") {
    const CacheFolder cache;
    const size_t stored = cache.openOnce();
    REQUIRE(stored > 0);
    const std::string whole = testing::textOf(cache.file());
    std::string changed = whole, longer = whole + "x";
    changed.back() = static_cast<char>(changed.back() ^ 1);
    for (const std::string& bytes :
         {std::string(), whole.substr(0, 1), whole.substr(0, 20), whole.substr(0, whole.size() / 2),
          whole.substr(0, whole.size() - 1), changed, longer, std::string(100'000, '\xa5'),
          whole.substr(24)}) { // the last one: without the header before the driver's data
        cache.write(bytes);
        CAPTURE(bytes.size());
        CHECK(gpu::storedPipelines(cache.file()).empty());
        CHECK(cache.openOnce() == stored);
    }
    CHECK(cache.files() == 1);
}

TEST_CASE("A pipeline file larger than any real one is not read and is replaced by a valid one") {
    const CacheFolder cache;
    const size_t stored = cache.openOnce();
    const std::string whole = testing::textOf(cache.file());
    fs::resize_file(cache.file(), uint64_t{64} << 30); // sparse: takes no disk space
    CHECK(gpu::storedPipelines(cache.file()).empty());
    CHECK(cache.openOnce() == stored);
    CHECK(testing::textOf(cache.file()).size() == whole.size());
}

TEST_CASE("A device opens and closes with a folder in place of its pipeline file and leaves no file behind") {
    const CacheFolder cache;
    fs::create_directories(cache.file() / "in the way");
    CHECK(cache.openOnce() == 0);
    CHECK(cache.files() == 1);
    fs::remove_all(cache.file());
    CHECK(cache.openOnce() > 0);
}

TEST_CASE("A pipe in place of the pipeline file does not block and is replaced by a valid file") {
    const CacheFolder cache;
    fs::create_directories(cache.file().parent_path());
    REQUIRE(::mkfifo(cache.file().c_str(), 0600) == 0);
    CHECK(cache.openOnce() > 0);
}

TEST_CASE("A failed write of pipelines leaves the old file unchanged and no temporary file") {
    const CacheFolder cache;
    const std::string old(100, 'o'), fresh(100'000, 'f');
    gpu::storePipelines(cache.file(), old);
    rlimit limit{};
    REQUIRE(::getrlimit(RLIMIT_FSIZE, &limit) == 0);
    const auto before = std::signal(SIGXFSZ, SIG_IGN);
    const rlimit small{5000, limit.rlim_max}; // like a disk that is full after this many bytes
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &small) == 0);
    CHECK_THROWS_AS(gpu::storePipelines(cache.file(), fresh), Error);
    REQUIRE(::setrlimit(RLIMIT_FSIZE, &limit) == 0);
    std::signal(SIGXFSZ, before);
    const std::vector<char> kept = gpu::storedPipelines(cache.file());
    CHECK(std::string(kept.begin(), kept.end()) == old);
    CHECK(cache.files() == 1);
    gpu::storePipelines(cache.file(), fresh);
    CHECK(gpu::storedPipelines(cache.file()).size() == fresh.size());
}
