// SPDX-License-Identifier: Apache-2.0
#include "apps/profile/device_stream.h"
#include "apps/profile/study.h"

#include "engine/types/error.h"
#include "shaders/shared/constants.h"
#include "shaders/stream.h"

#include <algorithm>
#include <cstdlib>
#include <numeric>

namespace fathom::profile {

namespace {

constexpr uint32_t kOne = 0x3f800000u; // 1.0f: sums of ones are exact
constexpr size_t kPage = 4096;

// Work group size and count; what fills a device depends on its type.
struct StreamShape {
    uint32_t group, groups;
};
std::vector<StreamShape> shapesOf(const gpu::Device& device) {
    if (device.facts().kind == DeviceKind::Cpu) {
        return {{64, 64}, {64, 1024}};
    }
    return {{256, 1024}, {256, 4096}, {256, 16384}};
}

gpu::Buffer importedPages(const gpu::Device& device, uint64_t bytes) {
    const size_t page = std::max<size_t>(kPage, device.facts().hostPointerAlignment);
    std::shared_ptr<void> memory(std::aligned_alloc(page, (bytes + page - 1) / page * page), std::free);
    if (!memory) {
        throw Error("the host has no " + std::to_string(bytes) + " bytes for a stream");
    }
    std::fill_n(static_cast<float*>(memory.get()), bytes / sizeof(float), 1.0f);
    return {device, gpu::HostPages{std::move(memory), bytes}, "stream of the host"};
}

gpu::Buffer streamBuffer(const gpu::Device& device, StreamMemory memory, uint64_t bytes) {
    if (memory == StreamMemory::Import) {
        return importedPages(device, bytes);
    }
    if (memory == StreamMemory::Device) {
        return {device, bytes, gpu::MemoryKind::Device, "stream of the device"};
    }
    gpu::Buffer buffer(device, bytes, gpu::MemoryKind::Upload, "stream of uploads");
    std::ranges::fill(buffer.as<float>(), 1.0f);
    return buffer;
}

// Allocates as many buffers as fit. If not even one fits, halves the size until one does. Empty when this
// memory is not available.
std::vector<gpu::Buffer> streamBuffers(const gpu::Device& device, StreamMemory memory, StreamSize size) {
    constexpr uint64_t kMin = 1u << 20; // below this, dispatch overhead dominates
    std::vector<gpu::Buffer> buffers;
    while (buffers.size() < size.buffers && size.bytes >= kMin) {
        try {
            buffers.push_back(streamBuffer(device, memory, size.bytes));
        } catch (const Error&) {
            if (!buffers.empty()) {
                break;
            }
            size.bytes /= 2;
        }
    }
    return buffers;
}

// A pass over several buffers without barriers between them.
class StreamPass {
public:
    StreamPass(gpu::Device& device, const StreamShape& shape, const std::vector<gpu::Buffer>& from,
               const std::vector<gpu::Buffer>& to)
        : device_(device)
        , groups_(shape.groups)
        , pipeline_(device, {"stream",
                             stream_spv,
                             {gpu::kStorage, gpu::kStorage, gpu::kStorage},
                             {{shared::kSpecGroupSize, shape.group}, {shared::kSpecCopy, !to.empty()}}}) {
        for (size_t i = 0; i < from.size(); ++i) {
            gpu::Buffer& sums = sums_.emplace_back(device, uint64_t{shape.group} * shape.groups * 4,
                                                   gpu::MemoryKind::Device, "stream sums");
            bindings_.emplace_back(
                device, pipeline_,
                std::initializer_list<const gpu::Buffer*>{&from[i], to.empty() ? &sums : &to[i], &sums},
                sums);
        }
    }
    void record(gpu::Commands& commands) const {
        for (const gpu::Bindings& bindings : bindings_) {
            commands.dispatch(pipeline_, bindings, groups_);
        }
    }
    // The sum that the last pass computed over the first buffer.
    double sum(TimedSubmissions& submissions) const {
        const gpu::Buffer read(device_, sums_.front().bytes(), gpu::MemoryKind::Readback, "sums read");
        submissions.once([&](gpu::Commands& c) { c.copy(sums_.front(), read, read.bytes()); });
        const auto values = read.as<float>();
        return std::accumulate(values.begin(), values.end(), 0.0);
    }

private:
    gpu::Device& device_;
    uint32_t groups_;
    gpu::Pipeline pipeline_;
    std::vector<gpu::Buffer> sums_;
    std::vector<gpu::Bindings> bindings_;
};

std::string wayOf(const char* what, const std::vector<gpu::Buffer>& buffers) {
    return std::string(what) + " of " + std::to_string(buffers.size()) + " x " +
           std::to_string(buffers.front().bytes() >> 20) + " MiB";
}

void keepBetter(StreamRate& best, double bytes, double ms, const std::string& way) {
    const double rate = bytes / (ms * 1e-3);
    if (rate > best.bytesPerSecond) {
        best = {rate, way};
    }
}

double totalBytes(const std::vector<gpu::Buffer>& buffers) {
    return static_cast<double>(buffers.size()) * static_cast<double>(buffers.front().bytes());
}

double onesIn(const gpu::Buffer& buffer) {
    return static_cast<double>(buffer.bytes()) / sizeof(float);
}

void readAll(gpu::Device& device, TimedSubmissions& submissions, const Repeats& repeats,
             const std::vector<gpu::Buffer>& from, StreamRate& best) {
    for (const StreamShape& shape : shapesOf(device)) {
        const StreamPass pass(device, shape, from, {});
        const double ms = submissions.best(repeats, [&](gpu::Commands& c) { pass.record(c); });
        verify(pass.sum(submissions) == onesIn(from.front()), "limit", "reading", "the sum of values read");
        keepBetter(best, totalBytes(from), ms, wayOf("reads", from));
    }
}

void copyAll(gpu::Device& device, TimedSubmissions& submissions, const Repeats& repeats,
             const std::vector<gpu::Buffer>& from, const std::vector<gpu::Buffer>& to, StreamRate& best) {
    const auto check = [&] {
        const StreamPass look(device, shapesOf(device).front(), to, {});
        submissions.once([&](gpu::Commands& c) { look.record(c); });
        verify(look.sum(submissions) == onesIn(to.front()), "limit", "copying", "the sum of the copy");
        submissions.once([&](gpu::Commands& c) { c.fill(to.front(), 0); });
    };
    const double command = submissions.best(repeats, [&](gpu::Commands& c) {
        for (size_t i = 0; i < from.size(); ++i) {
            c.copy(from[i], to[i], from[i].bytes());
        }
    });
    check();
    keepBetter(best, 2.0 * totalBytes(from), command, wayOf("the copy command's copies", from));
    for (const StreamShape& shape : shapesOf(device)) {
        const StreamPass pass(device, shape, from, to);
        const double ms = submissions.best(repeats, [&](gpu::Commands& c) { pass.record(c); });
        check();
        keepBetter(best, 2.0 * totalBytes(from), ms, wayOf("a pass's copies", from));
    }
}

} // namespace

TimedSubmissions::TimedSubmissions(gpu::Device& device)
    : device_(device)
    , timeline_(device)
    , commands_(device)
    , watch_(device, 2) {}

double TimedSubmissions::once(const std::function<void(gpu::Commands&)>& record) {
    commands_.begin();
    watch_.reset();
    watch_.mark(commands_.handle());
    record(commands_);
    commands_.barrier();
    watch_.mark(commands_.handle());
    commands_.end();
    const Clocks clocks;
    device_.submit(commands_.handle(), {}, {timeline_.handle(), ++ticket_});
    timeline_.wait(ticket_);
    lastWallMs_ = clocks.wallMs();
    return watch_.supported() ? watch_.intervalsMs().front() : lastWallMs_;
}

double TimedSubmissions::best(const Repeats& repeats, const std::function<void(gpu::Commands&)>& record) {
    double least = HUGE_VAL;
    repeat(
        repeats, [&] { least = std::min(least, once(record)); }, [](const Clocks&) {});
    return least;
}

StreamSize streamSizeOf(const gpu::Device& device) {
    const uint64_t most = std::min<uint64_t>(device.facts().maxStorageBufferBytes, 128u << 20);
    switch (device.facts().kind) {
    case DeviceKind::Cpu:
        return {std::min<uint64_t>(most, 32u << 20), 1};
    case DeviceKind::Discrete:
        return {most, 4};
    default:
        return {most, 2};
    }
}

bool oneMemory(const gpu::Device& device) {
    return device.facts().kind != DeviceKind::Discrete;
}

StreamRate bestDeviceStream(gpu::Device& device, TimedSubmissions& submissions, const Repeats& repeats) {
    const auto from = streamBuffers(device, StreamMemory::Device, streamSizeOf(device));
    StreamRate best;
    if (from.empty()) {
        return best;
    }
    for (const gpu::Buffer& buffer : from) {
        submissions.once([&](gpu::Commands& c) { c.fill(buffer, kOne); });
    }
    readAll(device, submissions, repeats, from, best);
    const auto to = streamBuffers(device, StreamMemory::Device,
                                  {from.front().bytes(), static_cast<uint32_t>(from.size())});
    if (to.size() == from.size() && to.front().bytes() == from.front().bytes()) {
        copyAll(device, submissions, repeats, from, to, best);
    }
    return best;
}

StreamRate bestRead(gpu::Device& device, TimedSubmissions& submissions, StreamMemory memory,
                    const StreamSize& size, const Repeats& repeats) {
    const auto from = streamBuffers(device, memory, {size.bytes, 1}); // one buffer: a bus has no cache
    StreamRate best;
    if (from.empty()) {
        return best;
    }
    readAll(device, submissions, repeats, from, best);
    const uint64_t bytes = from.front().bytes();
    const auto to = streamBuffers(device, StreamMemory::Device, {bytes, 1});
    if (to.empty() || to.front().bytes() != bytes) {
        return best;
    }
    const double ms =
        submissions.best(repeats, [&](gpu::Commands& c) { c.copy(from.front(), to.front(), bytes); });
    const StreamPass look(device, shapesOf(device).front(), to, {});
    submissions.once([&](gpu::Commands& c) { look.record(c); });
    verify(look.sum(submissions) == onesIn(to.front()), "limit", "copying", "the sum of the copy");
    keepBetter(best, (oneMemory(device) ? 2.0 : 1.0) * totalBytes(from), ms,
               wayOf("the copy command's copies", from));
    return best;
}

} // namespace fathom::profile
