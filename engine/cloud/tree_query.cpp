// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/tree_query.h"

#include "shaders/shared/constants.h"
#include "shaders/shared/query_params.h"
#include "shaders/tree_query.h"

#include <algorithm>

namespace fathom::cloud {

namespace {

constexpr uint32_t kGroup = 64;
constexpr float kOutward = 1.00001f; // for inner nodes: covers the float32 rounding of pose and sum

std::vector<gpu::BindingKind> bindingsOfQuery() {
    std::vector<gpu::BindingKind> kinds(7);
    kinds[0] = gpu::kUniform;
    return kinds;
}

} // namespace

TreeQuery::TreeQuery(gpu::Device& device, const Plan& plan, const PatchLayout& layout, FixturePool& pool,
                     const Tool& tool, uint32_t capacity)
    : device_(device)
    , layout_(layout)
    , pool_(pool)
    , tool_(tool)
    , hold_(plan.hold)
    , capacity_(capacity)
    , pipeline_(device, {"tree_query", tree_query_spv, bindingsOfQuery(), {{shared::kSpecGroupSize, kGroup}}})
    , timeline_(device)
    , commands_(device)
    , watch_(device, 2)
    , params_(device, sizeof(shared::QueryParams), gpu::MemoryKind::Upload, "query params")
    , toolTree_(device, tool.tree().nodes.size() * 16, gpu::MemoryKind::Upload, "tool tree")
    , count_(device, 16, gpu::MemoryKind::Readback, "query count")
    , unused_(device, 16, gpu::MemoryKind::Device, "unused") {
    makeAnswer();
}

void TreeQuery::makeAnswer() {
    found_ = gpu::Buffer(device_, 4ull * capacity_, gpu::MemoryKind::Readback, "query answer");
    bindings_.clear();
    for (size_t i = 0; i < pool_.size(); ++i) {
        const SetBuffers& s = pool_.at(i).device;
        bindings_.emplace_back(device_, pipeline_,
                               std::vector<const gpu::Buffer*>{&params_, &toolTree_, &s.nodes, &s.spheres,
                                                               &s.held, &count_, &found_},
                               unused_);
    }
}

void TreeQuery::grow() {
    capacity_ *= 2;
    makeAnswer();
}

// Leaves are the same floats that the CPU query tests; inner nodes are bounds and may be larger.
void TreeQuery::poseTree(const PosedLeaves& leaves, const Pose& baseTtool, const dvec3& origin) {
    const SphereTree& tree = tool_.tree();
    const auto out = toolTree_.as<glm::vec4>();
    const uint32_t firstLeaf = tree.firstLeaf();
    for (uint32_t n = 0; n < firstLeaf; ++n) {
        const Sphere& s = tree.nodes[n];
        out[n] = s.radius < 0.0 ? glm::vec4(0, 0, 0, -1)
                                : glm::vec4(glm::vec3(baseTtool.apply(s.centre) - origin),
                                            static_cast<float>(s.radius) * kOutward + 1e-6f);
    }
    for (uint32_t n = firstLeaf, leaf = 0; n < tree.nodes.size(); ++n) {
        if (tree.nodes[n].radius < 0.0) {
            out[n] = glm::vec4(0, 0, 0, -1);
            continue;
        }
        out[n] = {leaves.x[leaf], leaves.y[leaf], leaves.z[leaf], leaves.radius[leaf]};
        ++leaf;
    }
}

void TreeQuery::record(size_t setIndex) {
    commands_.begin();
    if (timed_) {
        watch_.reset();
        watch_.mark(commands_.handle());
    }
    commands_.fill(count_, 0);
    commands_.barrier();
    commands_.dispatch(pipeline_, bindings_[setIndex], (layout_.patches() * 16 + kGroup - 1) / kGroup);
    if (timed_) {
        watch_.mark(commands_.handle());
    }
    commands_.end();
}

double TreeQuery::gpuMs() const {
    const std::vector<double> intervals = watch_.intervalsMs();
    return intervals.empty() ? 0.0 : intervals.front();
}

bool TreeQuery::cull(const FixtureSet& set, const PosedLeaves& leaves, const Pose& baseTtool, float reach,
                     std::vector<uint32_t>& found) {
    shared::QueryParams p{};
    p.size = {layout_.across, layout_.down, 0, capacity_};
    for (size_t l = 0; l < layout_.levels.size(); ++l) {
        p.levels[l] = {layout_.levels[l].across, layout_.levels[l].down, layout_.levels[l].first, 0};
    }
    p.region = {layout_.levels.size(), hold_ ? 1 : 0, tool_.tree().degree, tool_.tree().firstLeaf()};
    p.reach = {reach, 0, 0, 0};
    *params_.as<shared::QueryParams>().data() = p;
    poseTree(leaves, baseTtool, set.host.origin);

    size_t index = 0;
    while (&pool_.at(index) != &set) {
        ++index;
    }
    record(index);
    device_.submit(commands_.handle(), timeline_.handle(), 0, ++ticket_);
    timeline_.wait(ticket_);
    const uint32_t count = count_.as<uint32_t>()[0];
    found.clear();
    if (count > capacity_) {
        return false;
    }
    const auto slots = found_.as<uint32_t>().first(count);
    for (uint32_t answer : slots) {
        const uint32_t slot = answer / 2, layer = answer % 2;
        const uint32_t key = (slot / 256) * 512 + layer * 256 + slot % 256;
        found.push_back(static_cast<uint32_t>(std::lower_bound(set.keys.begin(), set.keys.end(), key) -
                                              set.keys.begin()));
    }
    return true;
}

} // namespace fathom::cloud
