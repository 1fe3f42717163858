// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/pipeline.h"
#include "engine/gpu/software_threads.h"
#include "engine/gpu/stopwatch.h"
#include "engine/types/error.h"
#include "shaders/ceiling.h"
#include "shaders/shared/constants.h"
#include "tests/support/vulkan.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <chrono>
#include <cstdlib>
#include <doctest/doctest.h>
#include <string>
#include <thread>
#include <vector>

using namespace fathom;
using fathom::testing::vulkan;

TEST_CASE("A device reports its facts and is in the list") {
    const DeviceFacts& facts = vulkan().device.facts();
    CHECK(facts.name != "");
    CHECK(facts.subgroupSize >= 1);
    CHECK(facts.maxInvocations >= 128);
    CHECK(gpu::Device::list(vulkan().instance).size() >= 1);
}

TEST_CASE("Memory of each kind has a second choice, for when the heap of the first is full") {
    constexpr VkMemoryPropertyFlags kLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT,
                                    kShared = VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT |
                                              VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
    VkPhysicalDeviceMemoryProperties card{}; // without resizable BAR
    card.memoryTypeCount = 4;
    card.memoryTypes[0].propertyFlags = kLocal;
    card.memoryTypes[1].propertyFlags = kShared;
    card.memoryTypes[2].propertyFlags = kShared | VK_MEMORY_PROPERTY_HOST_CACHED_BIT;
    card.memoryTypes[3].propertyFlags = kShared | kLocal;
    using Types = std::vector<uint32_t>;
    CHECK(gpu::memoryTypes(gpu::MemoryKind::Device, card, 15) == Types{0, 3});
    CHECK(gpu::memoryTypes(gpu::MemoryKind::Upload, card, 15) == Types{3, 1, 2});
    CHECK(gpu::memoryTypes(gpu::MemoryKind::Readback, card, 15) == Types{2, 1, 3});
    CHECK(gpu::memoryTypes(gpu::MemoryKind::Upload, card, 6) == Types{1, 2});
    CHECK(gpu::memoryTypes(gpu::MemoryKind::Device, card, 4) == Types{2});
    CHECK(gpu::memoryTypes(gpu::MemoryKind::Readback, card, 1).empty());
}

TEST_CASE("A missing device is rejected with the list of existing ones") {
    const std::string here = vulkan().device.facts().name;
    try {
        gpu::Device none(vulkan().instance, "no such device");
        FAIL("accepted");
    } catch (const BadInput& e) {
        CHECK(e.exitCode() == 2);
        CHECK(std::string(e.what()).find("device: name or index: ") == 0);
        CHECK(std::string(e.what()).find(here) != std::string::npos);
    }
    CHECK_THROWS_AS(gpu::Device(vulkan().instance, "99"), BadInput);
}

TEST_CASE("A device is chosen by a part of its name, ignoring case") {
    std::string name = vulkan().device.facts().name;
    for (const bool upper : {false, true}) {
        std::string part = name.substr(1, 5);
        std::transform(part.begin(), part.end(), part.begin(), [&](unsigned char c) {
            return static_cast<char>(upper ? std::toupper(c) : std::tolower(c));
        });
        CHECK(gpu::Device(vulkan().instance, part).facts().name == name);
    }
}

TEST_CASE("Fill, update and copy take effect in the order in which they were recorded") {
    gpu::Device& device = vulkan().device;
    for (uint64_t words : {1u, 5u, 1000u}) { // odd sizes
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
        device.submit(commands.handle(), {}, {timeline.handle(), 1});
        timeline.wait(1);
        CHECK(timeline.value() == 1);
        CHECK(b.as<uint32_t>()[0] == 42);
        CHECK(b.as<uint32_t>()[words - 1] == (words == 1 ? 42 : 7));
    }
}

TEST_CASE("A buffer beyond the device's limit is rejected by name") {
    const uint64_t limit = vulkan().device.facts().maxStorageBufferBytes;
    if (limit > (uint64_t{1} << 32)) {
        MESSAGE("SKIPPED: the device has no limit that memory could reach");
        return;
    }
    CHECK_THROWS_WITH_AS(gpu::Buffer(vulkan().device, limit + 16, gpu::MemoryKind::Device, "huge"),
                         doctest::Contains("huge"), Error);
}

TEST_CASE("An interval of timestamps is right where the counter begins again at 0") {
    CHECK(gpu::stampsBetween(5, 12, 64) == 7);
    CHECK(gpu::stampsBetween(0xffffffffffffffff, 4, 64) == 5);
    CHECK(gpu::stampsBetween((uint64_t{1} << 36) - 10, 15, 36) == 25); // Intel: once per hour
    CHECK(vulkan().device.facts().timestampBits > 0);
}

TEST_CASE("Timestamps that a device takes in another order than recorded are 0 apart") {
    CHECK(gpu::stampsBetween(1000, 999, 64) == 0);
    CHECK(gpu::stampsBetween(5, uint64_t{0} - 4, 64) == 0); // the same where the counter begins again
    CHECK(gpu::stampsBetween(1000, 900, 36) == 0);
    const uint64_t longest = (uint64_t{1} << 35) - 1;
    CHECK(gpu::stampsBetween(0, longest, 36) == longest);
}

TEST_CASE("Images with more texels than a device reads from a buffer are refused with both numbers") {
    DeviceFacts facts; // the least that Vulkan guarantees
    facts.name = "small device";
    CHECK(gpu::texelRefusal(facts, 2 * 65536, VK_FORMAT_R16_UINT).empty());
    CHECK(gpu::texelRefusal(facts, 16 * 65536, VK_FORMAT_R32G32B32A32_SFLOAT).empty());
    CHECK(gpu::texelRefusal(facts, 2 * 640 * 480, VK_FORMAT_R16_UINT) ==
          "a buffer of 307200 texels exceeds the 65536 of small device; allowed: smaller images, or another "
          "device");
    CHECK(vulkan().device.facts().maxTexels >= 1u << 16);
}

namespace {

gpu::PipelineInfo ceilingInfo(uint32_t group, uint32_t rounds) {
    return {"ceiling",
            ceiling_spv,
            {gpu::kStorage},
            {{shared::kSpecGroupSize, group}, {shared::kSpecRounds, rounds}}};
}

gpu::Pipeline ceiling(const gpu::Device& device, uint32_t group, uint32_t rounds) {
    return {device, ceilingInfo(group, rounds)};
}

} // namespace

TEST_CASE("Bindings that cannot be made leave nothing behind on the device") {
    const uint32_t before = gpu::validationMessages(); // the layer reports what a destroyed device still has
    {
        gpu::Instance instance(testing::Vulkan::validation());
        gpu::Device device(instance, testing::Vulkan::selector());
        gpu::PipelineInfo info = ceilingInfo(64, 1);
        info.bindings.push_back({VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, VK_FORMAT_R8_UINT});
        const gpu::Pipeline pipeline(device, info);
        const gpu::Buffer buffer(device, 64, gpu::MemoryKind::Device, "buffer");
        CHECK_THROWS_WITH(gpu::Bindings(device, pipeline, {&buffer, &buffer}, buffer),
                          doctest::Contains("is not used by any pass"));
    }
    CHECK(gpu::validationMessages() == before);
}

TEST_CASE("The stopwatch measures the work between two marks, in milliseconds") {
    using Clock = std::chrono::steady_clock;
    gpu::Device& device = vulkan().device;
    gpu::Stopwatch watch(device, 3);
    REQUIRE(watch.supported());
    constexpr uint32_t kGroups = 2048;
    const gpu::Pipeline work = ceiling(device, 64, 4096);
    const gpu::Buffer sums(device, kGroups * 64 * 4, gpu::MemoryKind::Device, "sums");
    const gpu::Bindings bindings(device, work, {&sums}, sums);
    gpu::Commands commands(device);
    const gpu::Timeline timeline(device);
    const auto once = [&](uint64_t ticket) {
        commands.begin();
        watch.reset();
        watch.mark(commands.handle());
        watch.mark(commands.handle());
        commands.dispatch(work, bindings, kGroups);
        watch.mark(commands.handle());
        watch.mark(commands.handle()); // one more than fits
        commands.end();
        const Clock::time_point started = Clock::now();
        device.submit(commands.handle(), {}, {timeline.handle(), ticket});
        timeline.wait(ticket);
        return std::chrono::duration<double, std::milli>(Clock::now() - started).count();
    };
    once(1); // some drivers compile at first use
    const double wall = once(2);
    const std::vector<double> intervals = watch.intervalsMs();
    REQUIRE(intervals.size() == 2);
    CAPTURE(wall);
    CAPTURE(intervals[0]);
    CAPTURE(intervals[1]);
    CHECK(intervals[0] < 0.5 * intervals[1]); // no work between the first two marks
    CHECK(intervals[1] > 0.3 * wall);         // the work accounts for the host's wait
    CHECK(intervals[0] + intervals[1] <= wall);
}

TEST_CASE("A pipeline is compiled once, and pipelines in use are never dropped") {
    const gpu::Device device(vulkan().instance, vulkan().device.facts().name);
    const gpu::Pipeline kept = ceiling(device, 64, 1);
    CHECK(ceiling(device, 64, 1).handle() == kept.handle());
    CHECK(ceiling(device, 64, 2).handle() != kept.handle());
    CHECK(ceiling(device, 32, 1).handle() != kept.handle());
    CHECK(device.pipelines().size() == 3);
    for (uint32_t steps = 3; steps < 3 + gpu::PipelineStore::kMax; ++steps) {
        ceiling(device, 64, steps);
    }
    gpu::PipelineStore& store = device.pipelines();
    CHECK(store.size() == gpu::PipelineStore::kMax);
    const auto there = [&](uint32_t steps) { return store.find(ceilingInfo(64, steps)) != nullptr; };
    CHECK(there(1));
    CHECK_FALSE(there(2)); // the least recently used one was dropped
    CHECK(there(2 + gpu::PipelineStore::kMax));
    CHECK(ceiling(device, 64, 1).handle() == kept.handle());
}

TEST_CASE("No thread submits to the graphics queue while a library has it for itself") {
    gpu::Device device(vulkan().instance, vulkan().device.facts().name, gpu::Drawing::Offscreen);
    gpu::Commands commands(device);
    commands.begin();
    commands.end();
    const gpu::Timeline timeline(device);
    std::atomic<bool> drawn = false, passed = false;
    std::thread draws, passes;
    device.withDrawQueue([&] {
        draws = std::thread([&] {
            device.submitDrawing({.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO}, VK_NULL_HANDLE);
            drawn = true;
        });
        passes = std::thread([&] {
            device.submit(commands.handle(), {}, {timeline.handle(), 1});
            passed = true;
        });
        std::this_thread::sleep_for(std::chrono::milliseconds(100));
        CHECK_FALSE(drawn);
        CHECK_FALSE((passed && device.sharesQueue()));
    });
    draws.join();
    passes.join();
    timeline.wait(1);
    device.waitForDrawing();
    CHECK((drawn && passed));
}

TEST_CASE("The software device gets two threads per processor on two processors, and its default elsewhere") {
    CHECK(gpu::softwareThreads(1) == std::nullopt);
    CHECK(gpu::softwareThreads(2) == 4u);
    CHECK(gpu::softwareThreads(3) == std::nullopt);
    CHECK(gpu::softwareThreads(16) == std::nullopt);
}

TEST_CASE("A thread count set by the user for the software device is kept") {
    const char* was = std::getenv("LP_NUM_THREADS");
    const std::string before = was == nullptr ? "" : was;
    REQUIRE(::setenv("LP_NUM_THREADS", "3", 1) == 0);
    gpu::askForSoftwareThreads();
    CHECK(std::string(std::getenv("LP_NUM_THREADS")) == "3");
    CHECK((was == nullptr ? ::unsetenv("LP_NUM_THREADS") : ::setenv("LP_NUM_THREADS", before.c_str(), 1)) ==
          0);
}
