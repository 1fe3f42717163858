// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/physical_device.h"
#include "engine/gpu/pipeline.h"
#include "engine/gpu/software_threads.h"
#include "engine/gpu/stopwatch.h"
#include "engine/types/error.h"
#include "shaders/ceiling.h"
#include "tests/support/vulkan.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdlib>
#include <doctest/doctest.h>
#include <iterator>
#include <string>

using namespace fathom;
using fathom::test::vulkan;

TEST_CASE("a device tells its facts and takes part in the list") {
    const DeviceFacts& facts = vulkan().device.facts();
    CHECK(facts.name != "");
    CHECK(facts.subgroupSize >= 1);
    CHECK(facts.maxInvocations >= 128);
    CHECK(gpu::Device::list(vulkan().instance).size() >= 1);
}

TEST_CASE("a device that does not exist is refused with the list of those that do") {
    const std::string here = vulkan().device.facts().name;
    try {
        gpu::Device none(vulkan().instance, "no such device");
        FAIL("accepted");
    } catch (const BadInput& e) {
        CHECK(e.exitCode() == 2);
        CHECK(std::string(e.what()).find("--device") == 0);
        CHECK(std::string(e.what()).find(here) != std::string::npos);
    }
    CHECK_THROWS_AS(gpu::Device(vulkan().instance, "99"), BadInput);
}

TEST_CASE("a device is chosen by a part of its name, whatever the case of its letters") {
    std::string name = vulkan().device.facts().name;
    for (const bool upper : {false, true}) {
        std::string part = name.substr(1, 5);
        std::transform(part.begin(), part.end(), part.begin(), [&](unsigned char c) {
            return static_cast<char>(upper ? std::toupper(c) : std::tolower(c));
        });
        CHECK(gpu::Device(vulkan().instance, part).facts().name == name);
    }
}

TEST_CASE("fill, update and copy land in the order they were recorded") {
    gpu::Device& device = vulkan().device;
    for (uint64_t words : {1u, 5u, 1000u}) { // not multiples of anything
        const gpu::Buffer a(device, words * 4, gpu::MemoryKind::Device, "a"),
            b(device, words * 4, gpu::MemoryKind::Readback, "b");
        gpu::Commands commands(device);
        const gpu::Timeline timeline(device);
        const uint32_t value = 42;
        commands.begin();
        commands.fill(a, 7);
        commands.barrier();
        commands.update(a, 0, 4, &value);
        commands.barrier();
        commands.copy(a, b, a.bytes());
        commands.end();
        CHECK(commands.dispatches() == 0);
        device.submit(commands.handle(), timeline.handle(), 0, 1);
        timeline.wait(1);
        CHECK(timeline.value() == 1);
        CHECK(b.as<uint32_t>()[0] == 42);
        CHECK(b.as<uint32_t>()[words - 1] == (words == 1 ? 42 : 7));
    }
}

TEST_CASE("a buffer beyond the device's limit is refused by name") {
    const uint64_t limit = vulkan().device.facts().maxStorageBufferBytes;
    if (limit > (uint64_t{1} << 32)) {
        MESSAGE("the device has no limit worth testing");
        return;
    }
    CHECK_THROWS_WITH_AS(gpu::Buffer(vulkan().device, limit + 16, gpu::MemoryKind::Device, "huge"),
                         doctest::Contains("huge"), Error);
}

TEST_CASE("the stopwatch gives one interval less than it has marks and none is negative") {
    gpu::Device& device = vulkan().device;
    gpu::Stopwatch watch(device, 3);
    gpu::Commands commands(device);
    const gpu::Timeline timeline(device);
    commands.begin();
    watch.reset();
    for (int i = 0; i < 5; ++i) { // two more than there is room for
        watch.mark(commands.handle());
    }
    commands.end();
    device.submit(commands.handle(), timeline.handle(), 0, 1);
    timeline.wait(1);
    const auto intervals = watch.intervalsMs();
    CHECK(intervals.size() == 2);
    for (double ms : intervals) {
        CHECK(ms >= 0.0);
    }
}

namespace {

gpu::Pipeline ceiling(const gpu::Device& device, uint32_t group, uint32_t steps) {
    return {device, {"ceiling", ceiling_spv, 1, false, 0, std::array{group, steps}}};
}

} // namespace

TEST_CASE("A pipeline that is asked for again is compiled once, and none that is in use is let go") {
    const gpu::Device device(vulkan().instance, vulkan().device.facts().name);
    const gpu::Pipeline kept = ceiling(device, 64, 1);
    CHECK(ceiling(device, 64, 1).handle() == kept.handle());
    CHECK(ceiling(device, 64, 2).handle() != kept.handle());
    CHECK(ceiling(device, 32, 1).handle() != kept.handle());
    CHECK(device.pipelines().size() == 3);
    for (uint32_t steps = 3; steps < 3 + gpu::PipelineStore::kMost; ++steps) {
        ceiling(device, 64, steps);
    }
    gpu::PipelineStore& store = device.pipelines();
    CHECK(store.size() == gpu::PipelineStore::kMost);
    const auto there = [&](uint32_t steps) {
        return store.find({ceiling_spv, std::size(ceiling_spv), 1, 0, false, {64, steps}, {}}) != nullptr;
    };
    CHECK(there(1));
    CHECK_FALSE(there(2)); // the longest unused went
    CHECK(there(2 + gpu::PipelineStore::kMost));
    CHECK(ceiling(device, 64, 1).handle() == kept.handle());
}

TEST_CASE("the software device is asked for two threads a processor on two processors, and for its own "
          "choice on others") {
    CHECK(gpu::softwareThreads(1) == std::nullopt);
    CHECK(gpu::softwareThreads(2) == 4u);
    CHECK(gpu::softwareThreads(3) == std::nullopt);
    CHECK(gpu::softwareThreads(16) == std::nullopt);
}

TEST_CASE("who has said how many threads the software device has is obeyed") {
    const char* was = std::getenv("LP_NUM_THREADS");
    const std::string before = was == nullptr ? "" : was;
    REQUIRE(::setenv("LP_NUM_THREADS", "3", 1) == 0);
    gpu::askForSoftwareThreads();
    CHECK(std::string(std::getenv("LP_NUM_THREADS")) == "3");
    CHECK((was == nullptr ? ::unsetenv("LP_NUM_THREADS") : ::setenv("LP_NUM_THREADS", before.c_str(), 1)) ==
          0);
}
