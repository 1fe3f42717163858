// SPDX-License-Identifier: Apache-2.0
// The measurement of ceilings: checks buffers and passes, but no times.
#include "apps/profile/ceilings.h"
#include "apps/profile/device_stream.h"
#include "tests/support/vulkan.h"

#include <doctest/doctest.h>

using namespace fathom;
using namespace fathom::profile;

namespace {

constexpr Repeats kFew{2, 2, 0.0};

} // namespace

TEST_CASE("Every memory kind is read completely, and the best method is reported with its size") {
    const gpu::Instance instance{testing::Vulkan::validation()};
    gpu::Device device{instance, "llvmpipe"};
    TimedSubmissions submissions(device);
    REQUIRE(device.facts().hostPointerAlignment != 0);
    for (const StreamMemory memory : {StreamMemory::Upload, StreamMemory::Import}) {
        const StreamRate rate =
            bestRead(device, submissions, memory, streamSizeOf(device), kFew); // verifies sums
        CHECK(rate.bytesPerSecond > 0.0);
        CHECK(rate.way.find(" of 1 x 32 MiB") != std::string::npos);
    }
    const StreamRate own = bestDeviceStream(device, submissions, kFew);
    CHECK(own.bytesPerSecond > 0.0);
    CHECK(own.way.find(" of 1 x 32 MiB") != std::string::npos);
}

TEST_CASE("A stream without enough memory uses half of it, and unavailable memory gives a rate of 0") {
    const gpu::Instance instance{testing::Vulkan::validation()};
    gpu::Device device{instance, "llvmpipe"};
    TimedSubmissions submissions(device);
    const uint64_t most = device.facts().maxStorageBufferBytes;
    const StreamRate half =
        bestRead(device, submissions, StreamMemory::Upload, {2 * most, 1}, kFew); // larger than any buffer
    CHECK(half.bytesPerSecond > 0.0);
    CHECK(half.way.find(" of 1 x " + std::to_string(most >> 20) + " MiB") != std::string::npos);
    const StreamRate none = bestRead(device, submissions, StreamMemory::Upload, {1 << 19, 1}, kFew);
    CHECK(none.bytesPerSecond == 0.0);
}

TEST_CASE("Ceilings cover device memory, both kinds of host memory, arithmetic and host copies") {
    const gpu::Instance instance{testing::Vulkan::validation()};
    gpu::Device device{instance, "llvmpipe"};
    const Ceilings c = measureCeilings(device, 2, kFew);
    for (const double value : {c.deviceBytes, c.uploadBytes, c.importBytes, c.deviceFlops, c.hostBytes,
                               c.workerBytes, c.submitMs, c.dispatchMs}) {
        CHECK(value > 0.0);
        CHECK(std::isfinite(value));
    }
    CHECK(c.hostThreads == 2);
    CHECK(c.how.find("the host's own pages by ") != std::string::npos);
}

TEST_CASE("Host memory is read at its own bandwidth, in parallel with device memory, or after it if both are "
          "one memory") {
    Ceilings c;
    c.deviceBytes = 4e12, c.uploadBytes = 2e12, c.importBytes = 5e10;
    CHECK(readingMs(c, 4e9, 1e8, true) == doctest::Approx(2.0));  // 100 MB over the bus
    CHECK(readingMs(c, 4e9, 1e8, false) == doctest::Approx(1.0)); // 4 GB of device memory
    c.oneMemory = true;
    CHECK(readingMs(c, 3.9e9, 1e8, true) == doctest::Approx(1.0));
}
