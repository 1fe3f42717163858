// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/gap_query.h"

#include "engine/cloud/answer_room.h"
#include "shaders/shared/constants.h"
#include "shaders/smallest_gap.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace fathom::cloud {

namespace {

using shared::GapPair;
using shared::GapParams;
using shared::GapPose;

constexpr double kMaxAway = 20.0;          // [m] of a pose from the set's origin
constexpr size_t kMaxPosesAtOnce = 16384;  // of one submission
constexpr uint64_t kCountBytes = 16;       // in front of the pairs
constexpr uint32_t kMinCopiedPairs = 1024; // in every copy: it costs less than a second one

gpu::PipelineInfo gapPipeline(const Plan& plan) {
    return {"smallest_gap",
            smallest_gap_spv,
            std::vector<gpu::BindingKind>(8),
            {{shared::kSpecGroupSize, plan.pixelGroup}, {shared::kSpecClasses, plan.classes}},
            sizeof(GapParams)};
}

uint64_t bytesOfPairs(uint32_t pairs) {
    return kCountBytes + uint64_t{pairs} * sizeof(GapPair);
}

// The pose as the device reads it. docs/architecture/query.md derives the margin.
GapPose gapPoseOf(const Pose& baseTtool, const dvec3& origin, double toolRadius, double largest) {
    GapPose p{};
    writeRows(baseTtool, origin, p.rows);
    const double margin =
        0x1p-20 * (glm::length(baseTtool.position - origin) + 16.0 * (toolRadius + largest));
    p.margin.x = static_cast<float>(margin * (1.0 + 0x1p-23)); // not below the margin after rounding
    return p;
}

bool searchedOnDevice(const Pose& baseTtool, const dvec3& origin) {
    const dvec3 away = baseTtool.position - origin;
    const double turn = glm::dot(baseTtool.rotation, baseTtool.rotation);
    return glm::dot(away, away) <= kMaxAway * kMaxAway && turn > 0.0 && std::isfinite(turn);
}

// Bits of the classes whose spheres in the set's device side do not count.
uint32_t frozenClasses(const FixtureSet& set) {
    uint32_t bits = 0;
    for (size_t c = 0; c < set.fixtureOfClass.size(); ++c) {
        bits |= set.fixtureOfClass[c] == FixtureSet::kFrozen ? 1u << c : 0u;
    }
    return bits;
}

} // namespace

GapQuery::GapQuery(const QueryContext& context, uint32_t capacity)
    : DeviceQuery(context, gapPipeline(context.plan))
    , unused_(device_, 16, gpu::MemoryKind::Device, "unused") {
    growTo(capacity);
}

const gpu::Bindings& GapQuery::bindingsOf(const FixtureSet& set) {
    for (size_t i = bindings_.size(); i < pool_.size(); ++i) {
        std::vector<const gpu::Buffer*> buffers = inputsOf(pool_.at(i).device);
        buffers.insert(buffers.end(), {&frozen_.buffer(), &poses_, &answer_});
        bindings_.emplace_back(device_, pipeline_, buffers, unused_);
    }
    return bindings_[pool_.indexOf(set)];
}

void GapQuery::reserve(size_t poses) {
    if (poses * sizeof(GapPose) > poses_.bytes()) {
        poses_ = gpu::Buffer(device_, std::bit_ceil(poses) * sizeof(GapPose), gpu::MemoryKind::Upload,
                             "poses of a batch");
        bindings_.clear();
    }
}

// False when the device's buffers cannot hold that many.
bool GapQuery::growTo(uint32_t pairs) {
    const uint32_t most = roomFor(pairs);
    if (bytesOfPairs(most) > device_.facts().maxStorageBufferBytes) {
        return false;
    }
    answer_ = gpu::Buffer(device_, bytesOfPairs(most), gpu::MemoryKind::Device, "batch answer");
    back_ = gpu::Buffer(device_, bytesOfPairs(most), gpu::MemoryKind::Readback, "batch answer on the host");
    most_ = most;
    bindings_.clear();
    return true;
}

void GapQuery::writePoses(const Batch& batch, Part part) {
    const auto out = poses_.as<GapPose>();
    for (size_t i = 0; i < part.size(); ++i) {
        out[i] =
            gapPoseOf(batch.poses[part[i]], batch.set.host.origin, leaves_.radius(), batch.set.largestRadius);
    }
}

void GapQuery::copyPairs(gpu::Commands& commands, uint32_t pairs) {
    const std::pair<uint64_t, uint64_t> all[] = {{0, bytesOfPairs(pairs)}};
    commands.copyParts(answer_, back_, all);
    copied_ = pairs;
}

void GapQuery::record(const Batch& batch, Part part) {
    gpu::Commands& commands = run_.begin();
    constexpr std::array<uint32_t, 4> kZero{};
    commands.update(answer_, 0, kCountBytes, kZero.data());
    leaves_.upload(commands);
    frozen_.upload(commands);
    commands.barrier();
    run_.startTime();
    GapParams p{};
    p.tool = leaves_.bound();
    p.blocks = {layout_.patches(), layout_.levels[1].first, hold_ ? 2u : 1u, frozenClasses(batch.set)};
    p.frozenBlocks = {frozen_.count(), frozen_.firstBound(), leaves_.count(), most_};
    commands.dispatch(pipeline_, bindingsOf(batch.set), static_cast<uint32_t>(part.size()), &p);
    run_.stopTime();
    commands.barrier();
    copyPairs(commands, copiedAhead(found_, kMinCopiedPairs, most_));
}

// False when the answer does not fit: then found_ says how many pairs there are.
bool GapQuery::submit(const Batch& batch, Part part) {
    writePoses(batch, part);
    record(batch, part);
    run_.submit(batch.set.completed);
    found_ = back_.as<uint32_t>()[0];
    if (found_ > copied_ && found_ <= most_) {
        copyPairs(run_.begin(), found_);
        run_.submit({});
    }
    return found_ <= most_;
}

void GapQuery::decide(const Batch& batch, Part part) {
    const auto* const pairs = reinterpret_cast<const GapPair*>(back_.as<uint8_t>().data() + kCountBytes);
    const dvec3& origin = batch.set.host.origin;
    for (const GapPair& pair : std::span(pairs, found_)) {
        const FixtureSet::Place place = batch.set.placeOf(layout_, pair.slot, pair.pointClass);
        const uint32_t pose = part[pair.pose];
        const glm::dvec4 leaf = leafAt(batch.tool.leaves()[pair.leaf], batch.poses[pose], origin);
        const SmallestGap gap{gapBetween(leaf, pair.sphere), place.source, pair.leaf,
                              static_cast<uint32_t>(place.fixture), pair.sphere};
        if (comesBefore(gap, batch.out[pose])) {
            batch.out[pose] = gap;
        }
    }
}

void GapQuery::askHost(const Batch& batch, uint32_t pose) {
    if (!hostReady_) {
        host_.build(batch.set.host);
        hostReady_ = true;
    }
    batch.out[pose] = host_.find(batch.tool, batch.poses[pose]);
}

// If an answer is larger than any buffer, because very many pairs are equally near, halves are asked.
void GapQuery::ask(const Batch& batch, Part part) {
    while (!submit(batch, part)) {
        if (growTo(found_)) {
            continue;
        }
        if (part.size() == 1) {
            askHost(batch, part.front());
        } else {
            ask(batch, part.first(part.size() / 2));
            ask(batch, part.subspan(part.size() / 2));
        }
        return;
    }
    decide(batch, part);
}

void GapQuery::find(const FixtureSet& set, const Tool& tool, std::span<const Pose> baseTtool,
                    std::vector<SmallestGap>& out) {
    out.assign(baseTtool.size(), {});
    const Batch batch{set, tool, baseTtool, out};
    hostReady_ = false;
    near_.clear();
    for (uint32_t i = 0; i < baseTtool.size(); ++i) {
        if (searchedOnDevice(baseTtool[i], set.host.origin)) {
            near_.push_back(i);
        } else {
            askHost(batch, i);
        }
    }
    if (frozen_.fillFrozen(set)) {
        bindings_.clear();
    }
    reserve(std::min(near_.size(), kMaxPosesAtOnce));
    for (size_t begin = 0; begin < near_.size(); begin += kMaxPosesAtOnce) {
        ask(batch, Part(near_).subspan(begin, std::min(kMaxPosesAtOnce, near_.size() - begin)));
    }
}

} // namespace fathom::cloud
