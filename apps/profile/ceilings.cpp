// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/ceilings.h"

#include "engine/gpu/commands.h"
#include "engine/gpu/stopwatch.h"
#include "engine/types/crew.h"
#include "shaders/ceiling.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <functional>

namespace fathom::profile {

namespace {

constexpr uint64_t kCopyBytes = 64u << 20;
constexpr size_t kLeastPart = 1u << 20; // bytes
constexpr uint32_t kInvocations = 1u << 17, kSteps = 256, kChains = 16, kGroup = 64;

// Device time of what record() records [ms]; wall time where the device has no timestamps.
class Submissions {
public:
    explicit Submissions(gpu::Device& device)
        : device_(device)
        , timeline_(device)
        , commands_(device)
        , watch_(device, 2) {}

    double once(const std::function<void(gpu::Commands&)>& record) {
        commands_.begin();
        watch_.resetIn(commands_.handle());
        watch_.mark(commands_.handle());
        record(commands_);
        commands_.barrier();
        watch_.mark(commands_.handle());
        commands_.end();
        const Clocks clocks;
        device_.submit(commands_.handle(), timeline_.handle(), 0, ++ticket_);
        timeline_.wait(ticket_);
        lastWallMs = clocks.wallMs();
        return watch_.works() ? watch_.intervalsMs().front() : lastWallMs;
    }
    // The shortest of several: a ceiling is what can be reached.
    double best(const Effort& effort, const std::function<void(gpu::Commands&)>& record) {
        double least = HUGE_VAL;
        repeat(
            effort, [&] { least = std::min(least, once(record)); }, [](const Clocks&) {});
        return least;
    }

    double lastWallMs = 0.0;

private:
    gpu::Device& device_;
    gpu::Timeline timeline_;
    gpu::Commands commands_;
    gpu::Stopwatch watch_;
    uint64_t ticket_ = 0;
};

double deviceCopy(gpu::Device& device, Submissions& submissions, const Effort& effort) {
    const gpu::Buffer from(device, kCopyBytes, gpu::MemoryKind::Device, "copy from");
    const gpu::Buffer to(device, kCopyBytes, gpu::MemoryKind::Device, "copy to");
    submissions.once([&](gpu::Commands& c) { c.fill(from, 0x01020304u); });
    const double ms = submissions.best(effort, [&](gpu::Commands& c) { c.copy(from, to, kCopyBytes); });
    return 2.0 * static_cast<double>(kCopyBytes) / (ms * 1e-3);
}

double deviceArithmetic(gpu::Device& device, Submissions& submissions, const Effort& effort) {
    const gpu::Pipeline pipeline(device, {"ceiling", ceiling_spv, 1, false, 0, std::array{kGroup, kSteps}});
    const gpu::Buffer sums(device, kInvocations * 4ull, gpu::MemoryKind::Readback, "sums");
    const gpu::Bindings bindings(device, pipeline, {&sums}, sums);
    const double ms = submissions.best(
        effort, [&](gpu::Commands& c) { c.dispatch(pipeline, bindings, kInvocations / kGroup); });
    double expected = 0.0; // the same chains in float64
    for (double start : {0.0, 0.1, 0.2, 0.3}) {
        for (int k = 0; k < 4; ++k) {
            double v = start + 0.01 * k;
            for (uint32_t i = 0; i < kSteps; ++i) {
                v = v * (0.999 - 0.001 * k) + 0.001 * (k + 1);
            }
            expected += v;
        }
    }
    verify(std::abs(sums.as<float>()[0] - expected) < 1e-3, "limit", "arithmetic", "the sum of the chains");
    return 2.0 * kSteps * kChains * static_cast<double>(kInvocations) / (ms * 1e-3);
}

double hostCopy(uint32_t threads, const Effort& effort) {
    Crew crew(threads);
    std::vector<char> from(kCopyBytes, 3), to(kCopyBytes, 0);
    double least = HUGE_VAL;
    repeat(
        effort,
        [&] {
            inParts(&crew, kCopyBytes, kLeastPart,
                    [&](size_t begin, size_t end) { std::memcpy(&to[begin], &from[begin], end - begin); });
        },
        [&](const Clocks& c) { least = std::min(least, c.wallMs()); });
    verify(to == from, "limit", "memcpy", "the copy differs");
    return 2.0 * static_cast<double>(kCopyBytes) / (least * 1e-3);
}

} // namespace

Ceilings measureCeilings(gpu::Device& device, uint32_t hostThreads, const Effort& effort) {
    Submissions submissions(device);
    Ceilings c;
    c.deviceBytes = deviceCopy(device, submissions, effort);
    c.deviceFlops = deviceArithmetic(device, submissions, effort);
    c.hostThreads = hostThreads;
    c.hostBytes = hostCopy(1, effort);
    c.crewBytes = hostCopy(hostThreads, effort);
    std::vector<double> empty;
    repeat(
        effort, [&] { submissions.once([](gpu::Commands&) {}); },
        [&](const Clocks&) { empty.push_back(submissions.lastWallMs); });
    c.submitMs = spreadOf(empty).p50;
    return c;
}

} // namespace fathom::profile
