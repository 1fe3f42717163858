// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/query_answer.h"

#include "engine/cloud/answer_room.h"

#include <algorithm>
#include <utility>

namespace fathom::cloud {

namespace {

using shared::FoundSphere;
using Counts = QueryAnswer::Counts;

constexpr uint64_t kHeader = 16;            // [bytes]
constexpr Counts kMinCopied = {1024, 2048}; // in every copy: it costs less than a second one

uint64_t bytesOf(const Counts& capacity) {
    return kHeader + uint64_t{capacity.spheres} * sizeof(FoundSphere) + 4ull * capacity.leaves;
}

} // namespace

bool agree(std::span<const FoundSphere> spheres, uint64_t leaves) noexcept {
    uint64_t all = 0;
    bool inside = true;
    for (const FoundSphere& f : spheres) {
        all += f.count;
        inside = inside && uint64_t{f.first} + f.count <= leaves;
    }
    return inside && all == leaves;
}

QueryAnswer::QueryAnswer(const gpu::Device& device, const Counts& capacity)
    : device_(device)
    , answer_(device, bytesOf(capacity), gpu::MemoryKind::Device, "query answer")
    , back_(device, bytesOf(capacity), gpu::MemoryKind::Readback, "query answer on the host")
    , capacity_(capacity)
    , isNew_(true) {}

bool QueryAnswer::growTo(const Counts& count) {
    const Counts capacity{std::max(capacity_.spheres, roomFor(count.spheres)),
                          std::max(capacity_.leaves, roomFor(count.leaves))};
    if (bytesOf(capacity) > device_.facts().maxStorageBufferBytes) {
        return false;
    }
    gpu::Buffer answer(device_, bytesOf(capacity), gpu::MemoryKind::Device, "query answer");
    back_ = gpu::Buffer(device_, bytesOf(capacity), gpu::MemoryKind::Readback, "query answer on the host");
    answer_ = std::move(answer);
    capacity_ = capacity;
    used_ = {};
    isNew_ = true;
    return true;
}

void QueryAnswer::clear(gpu::Commands& commands) {
    commands.fill(answer_, 0);
    isNew_ = false;
}

uint64_t QueryAnswer::leafOffset() const {
    return bytesOf({capacity_.spheres, 0});
}

void QueryAnswer::setOutputRange(shared::QueryParams& params) const {
    params.used = {used_.spheres, used_.leaves, capacity_.spheres, capacity_.leaves};
    params.leafWord = static_cast<uint32_t>(leafOffset() / 4);
}

void QueryAnswer::copyPart(gpu::Commands& commands, const Counts& part) {
    const std::pair<uint64_t, uint64_t> parts[] = {{0, bytesOf({part.spheres, 0})},
                                                   {leafOffset(), 4ull * part.leaves}};
    commands.copyParts(answer_, back_, parts);
    copied_ = part;
}

void QueryAnswer::copy(gpu::Commands& commands) {
    copyPart(commands, {copiedAhead(last_.spheres, kMinCopied.spheres, capacity_.spheres),
                        copiedAhead(last_.leaves, kMinCopied.leaves, capacity_.leaves)});
}

void QueryAnswer::copyAll(gpu::Commands& commands) {
    copyPart(commands, last_);
}

Counts QueryAnswer::read() {
    const auto counts = back_.as<uint32_t>();
    last_ = {counts[0] - used_.spheres, counts[1] - used_.leaves};
    used_ = {counts[0], counts[1]};
    return last_;
}

std::span<const FoundSphere> QueryAnswer::spheres() const {
    return {reinterpret_cast<const FoundSphere*>(back_.as<uint8_t>().data() + kHeader), last_.spheres};
}

std::span<const uint32_t> QueryAnswer::buckets() const {
    return {back_.as<uint32_t>().data() + leafOffset() / 4, last_.leaves};
}

} // namespace fathom::cloud
