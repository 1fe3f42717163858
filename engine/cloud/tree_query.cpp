// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/tree_query.h"

#include "shaders/shared/constants.h"
#include "shaders/tree_query.h"
#include "shaders/tree_query_plain.h"

#include <algorithm>

namespace fathom::cloud {

namespace {

using shared::QueryParams;
using Counts = QueryAnswer::Counts;

constexpr uint32_t kLeavesPerSphere = 8;    // in the first answer's capacity
constexpr uint32_t kGroups = 1024;          // of one query on a GPU
constexpr uint32_t kFewestLeaves = 64;      // of a slice: fewer do not pay for another group
constexpr double kMostBandsPerMetre = 1e30; // a reach of 0 would need infinity
static_assert(shared::kBands == ContactSet::kGapBands && shared::kUndecided == NearPairs::kUndecided);

gpu::PipelineInfo pipelineOf(const Plan& plan, bool subgroups) {
    const std::span<const uint32_t> bySubgroup(tree_query_spv), plain(tree_query_plain_spv);
    return {"tree_query",
            subgroups ? bySubgroup : plain,
            std::vector<gpu::BindingKind>(7),
            {{shared::kSpecGroupSize, plan.pixelGroup}, {shared::kSpecClasses, plan.classes}},
            sizeof(QueryParams)};
}

} // namespace

TreeQuery::TreeQuery(const QueryContext& context, uint32_t capacity, bool subgroups)
    : DeviceQuery(context, pipelineOf(context.plan, subgroups && context.device->facts().subgroupArithmetic))
    , answer_(device_, {capacity, kLeavesPerSphere * capacity})
    , unused_(device_, 16, gpu::MemoryKind::Device, "unused") {}

void TreeQuery::makeBindings() {
    const gpu::Buffer* const answer = &answer_.buffer();
    bindings_.clear();
    for (size_t i = 0; i < pool_.size(); ++i) {
        std::vector<const gpu::Buffer*> buffers = inputsOf(pool_.at(i).device);
        buffers.insert(buffers.end(), {answer, answer});
        bindings_.emplace_back(device_, pipeline_, buffers, unused_);
    }
    frozenBindings_ = gpu::Bindings(
        device_, pipeline_,
        {&leaves_.buffer(), &frozen_.buffer(), &frozen_.buffer(), nullptr, nullptr, answer, answer}, unused_);
}

TreeQuery::Blocks TreeQuery::frozenBlocks() const {
    return {&frozenBindings_, frozen_.count(), frozen_.firstBound(), shared::kLayerFrozen, 1};
}

QueryParams TreeQuery::paramsAt(const Pose& baseTtool, const dvec3& origin, double reach,
                                double largest) const {
    QueryParams p{};
    writeRows(baseTtool, origin, p.rows);
    p.tool = leaves_.bound();
    const double away = glm::length(baseTtool.position - origin);
    p.reach = outwardReach(leaves_.radius(), away, reach, largest);
    p.bandsPerMetre = static_cast<float>(std::min(ContactSet::kGapBands / reach, kMostBandsPerMetre));
    p.margin = searchError(leaves_.radius(), away, reach, largest);
    return p;
}

// If there are few blocks, slices share the leaves among groups. A CPU device would gain nothing.
void TreeQuery::dispatch(gpu::Commands& commands, const Blocks& blocks, QueryParams p) {
    const bool cpu = device_.facts().kind == DeviceKind::Cpu;
    const uint32_t groups = cpu ? 4 * device_.facts().hostProcessors : kGroups;
    const uint32_t count = std::max(1u, blocks.count),
                   fewest = (leaves_.count() + shared::kSliceLeaves - 1) / shared::kSliceLeaves,
                   most = cpu ? fewest : std::max(fewest, leaves_.count() / kFewestLeaves);
    const uint32_t slices = std::clamp(groups / count, fewest, most);
    p.blocks = {blocks.count, blocks.firstBound, leaves_.count(), (leaves_.count() + slices - 1) / slices};
    p.layer = blocks.layer;
    p.layers = blocks.layers;
    answer_.setOutputRange(p);
    commands.dispatch(pipeline_, *blocks.bindings, {std::clamp(2 * groups / slices, 1u, count), slices, 1},
                      &p);
}

void TreeQuery::record(std::span<const Blocks> all, const QueryParams& params) {
    gpu::Commands& commands = run_.begin();
    bool copied = answer_.isNew();
    if (answer_.isNew()) {
        answer_.clear(commands);
    }
    copied = leaves_.upload(commands) || copied;
    copied = frozen_.upload(commands) || copied;
    if (copied) {
        commands.barrier();
    }
    run_.startTime();
    for (const Blocks& blocks : all) {
        if (&blocks != all.data()) {
            commands.barrier();
        }
        dispatch(commands, blocks, params);
    }
    run_.stopTime();
    commands.barrier();
    answer_.copy(commands);
}

// Returns the number of spheres and leaves found. The answer is whole unless they exceed its capacity.
Counts TreeQuery::run(std::span<const Blocks> all, const gpu::Device::TimelinePoint& after,
                      const QueryParams& params) {
    record(all, params);
    run_.submit(after);
    const Counts found = answer_.read();
    if (found.fits(answer_.capacity()) && !answer_.isComplete()) {
        answer_.copyAll(run_.begin());
        run_.submit({});
    }
    return found;
}

bool TreeQuery::list(const FixtureSet& set, const Pose& baseTtool, double reach, NearPairs& near) {
    const size_t index = pool_.indexOf(set);
    if (frozen_.fillFrozen(set)) {
        bindings_.clear();
    }
    const QueryParams params = paramsAt(baseTtool, set.host.origin, reach, set.largestRadius);
    for (;;) {
        if (bindings_.empty()) {
            makeBindings();
        }
        const Blocks live{&bindings_[index], layout_.patches(), layout_.levels[1].first, shared::kLayerSeen,
                          hold_ ? 2u : 1u};
        const Blocks both[] = {live, frozenBlocks()};
        const Counts found = run({both, frozen_.count() > 0 ? 2u : 1u}, set.completed, params);
        if (found.fits(answer_.capacity())) {
            if (!agree(answer_.spheres(), found.leaves)) {
                return false;
            }
            take(set, near);
            return true;
        }
        if (!answer_.growTo(found)) {
            return false;
        }
        bindings_.clear();
    }
}

void TreeQuery::take(const FixtureSet& set, NearPairs& near) const {
    near.buckets = answer_.buckets();
    near.spheres.clear();
    for (const shared::FoundSphere& f : answer_.spheres()) {
        const FixtureSet::Place place = set.placeOf(layout_, f.slot, f.pointClass);
        if (place.fixture != FixtureSet::kFrozen) {
            near.spheres.push_back({place.source, static_cast<uint32_t>(place.fixture), f.first, f.count,
                                    f.sphere.x, f.sphere.y, f.sphere.z, f.sphere.w});
        }
    }
}

} // namespace fathom::cloud
