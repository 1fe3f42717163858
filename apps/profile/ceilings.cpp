// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/ceilings.h"
#include "apps/profile/device_stream.h"

#include "engine/types/thread_pool.h"
#include "shaders/ceiling.h"
#include "shaders/shared/constants.h"

#include <algorithm>
#include <cstring>

namespace fathom::profile {

namespace {

constexpr uint64_t kHostCopyBytes = 64u << 20;
constexpr size_t kMinPart = 1u << 20; // bytes
constexpr uint32_t kChains = 16, kStepsARound = 4;

// Size of one arithmetic dispatch. It fills a GPU several times and takes about a millisecond; on a CPU
// device it takes a few.
struct ArithmeticShape {
    uint32_t group, invocations, rounds;
    double operations() const { return 2.0 * kChains * kStepsARound * rounds * invocations; }
};
std::vector<ArithmeticShape> arithmeticShapesOf(const gpu::Device& device) {
    if (device.facts().kind == DeviceKind::Cpu) {
        return {{64, 1u << 13, 64}, {64, 1u << 13, 256}};
    }
    return {{64, 1u << 20, 256}, {256, 1u << 20, 256}, {256, 1u << 20, 1024}, {256, 1u << 18, 1024}};
}

// The result of invocation 0: the same multiply-add chains in float64.
double sumOfChains(uint32_t rounds) {
    double sum = 0.0;
    for (double start : {0.0, 0.1, 0.2, 0.3}) {
        for (int k = 0; k < 4; ++k) {
            double v = start + 0.01 * k;
            for (uint32_t i = 0; i < kStepsARound * rounds; ++i) {
                v = v * (0.999 - 0.001 * k) + 0.001 * (k + 1);
            }
            sum += v;
        }
    }
    return sum;
}

double deviceArithmetic(gpu::Device& device, TimedSubmissions& submissions, const Repeats& repeats) {
    double best = 0.0;
    for (const ArithmeticShape& shape : arithmeticShapesOf(device)) {
        const gpu::Pipeline pipeline(
            device, {"ceiling",
                     ceiling_spv,
                     {gpu::kStorage},
                     {{shared::kSpecGroupSize, shape.group}, {shared::kSpecRounds, shape.rounds}}});
        const gpu::Buffer sums(device, shape.invocations * 4ull, gpu::MemoryKind::Device, "sums");
        const gpu::Bindings bindings(device, pipeline, {&sums}, sums);
        const double ms = submissions.best(repeats, [&](gpu::Commands& c) {
            c.dispatch(pipeline, bindings, shape.invocations / shape.group);
        });
        const gpu::Buffer first(device, 16, gpu::MemoryKind::Readback, "first sum");
        submissions.once([&](gpu::Commands& c) { c.copy(sums, first, 16); });
        verify(std::abs(first.as<float>()[0] - sumOfChains(shape.rounds)) < 1e-3, "limit", "arithmetic",
               "the sum of the chains");
        best = std::max(best, shape.operations() / (ms * 1e-3));
    }
    return best;
}

// Time [ms] that one more dispatch with a barrier adds when its single work group computes nothing.
double emptyDispatch(gpu::Device& device, TimedSubmissions& submissions, const Repeats& repeats) {
    const gpu::Pipeline pipeline(
        device,
        {"empty", ceiling_spv, {gpu::kStorage}, {{shared::kSpecGroupSize, 64u}, {shared::kSpecRounds, 0u}}});
    const gpu::Buffer sums(device, 64 * 4, gpu::MemoryKind::Device, "sums");
    const gpu::Bindings bindings(device, pipeline, {&sums}, sums);
    const auto chain = [&](int count) {
        return submissions.best(repeats, [&](gpu::Commands& c) {
            for (int i = 0; i < count; ++i) {
                c.dispatch(pipeline, bindings, 1);
                c.barrier();
            }
        });
    };
    constexpr int kMore = 32;
    const double one = chain(1);
    return std::max(1e-6, (chain(1 + kMore) - one) / kMore);
}

double hostCopy(uint32_t threads, const Repeats& repeats) {
    ThreadPool workers(threads);
    std::vector<char> from(kHostCopyBytes, 3), to(kHostCopyBytes, 0);
    double least = HUGE_VAL;
    repeat(
        repeats,
        [&] {
            inParts(&workers, kHostCopyBytes, kMinPart,
                    [&](size_t begin, size_t end) { std::memcpy(&to[begin], &from[begin], end - begin); });
        },
        [&](const Clocks& c) { least = std::min(least, c.wallMs()); });
    verify(to == from, "limit", "memcpy", "the copy differs");
    return 2.0 * static_cast<double>(kHostCopyBytes) / (least * 1e-3);
}

} // namespace

Ceilings measureCeilings(gpu::Device& device, uint32_t hostThreads, const Repeats& repeats) {
    TimedSubmissions submissions(device);
    const Repeats each{repeats.least, repeats.most, 0.25 * repeats.seconds}; // about 12
    Ceilings c;
    c.deviceFlops = deviceArithmetic(device, submissions, each); // first, to raise the clock
    c.dispatchMs = emptyDispatch(device, submissions, each);
    const StreamRate own = bestDeviceStream(device, submissions, each);
    const auto reads = [&](StreamMemory memory) {
        return bestRead(device, submissions, memory, streamSizeOf(device), each);
    };
    const StreamRate uploads = reads(StreamMemory::Upload);
    c.oneMemory = oneMemory(device);
    c.deviceBytes = own.bytesPerSecond;
    c.uploadBytes = uploads.bytesPerSecond;
    c.how = "the device's memory by " + own.way + ", what the CPU writes by " + uploads.way;
    const StreamRate host =
        device.facts().hostPointerAlignment != 0 ? reads(StreamMemory::Import) : StreamRate{};
    c.importBytes = host.bytesPerSecond;
    c.how += host.way.empty() ? "" : ", the host's own pages by " + host.way;
    verify(c.deviceBytes > 0.0 && c.uploadBytes > 0.0, "limit", "ceilings", "no memory for them");
    c.hostThreads = hostThreads;
    c.hostBytes = hostCopy(1, repeats);
    c.workerBytes = hostCopy(hostThreads, repeats);
    std::vector<double> empty;
    repeat(
        repeats, [&] { submissions.once([](gpu::Commands&) {}); },
        [&](const Clocks&) { empty.push_back(submissions.lastWallMs()); });
    c.submitMs = spreadOf(empty).p50;
    return c;
}

double readingMs(const Ceilings& c, double own, double images, bool inPlace) {
    const double rate = inPlace ? c.importBytes : c.uploadBytes;
    return 1e3 * (c.oneMemory ? (own + images) / std::max(c.deviceBytes, rate)
                              : std::max(own / c.deviceBytes, images / rate));
}

} // namespace fathom::profile
