// SPDX-License-Identifier: Apache-2.0
#include "apps/stability/lockstep_rig.h"

#include "engine/reference/contact_oracle.h"
#include "engine/types/error.h"

#include <algorithm>
#include <utility>

namespace fathom::stability {

HapticOptions plainHapticOptions(const Tool& tool) {
    Scene scene;
    scene.fixtures.emplace_back();
    return makeHapticOptions(scene, tool);
}

LockstepRig::LockstepRig(const Tool& tool, const Pose& start, const RigSetup& setup)
    : LockstepRig(tool, plainHapticOptions(tool), start, setup) {}

LockstepRig::LockstepRig(const Tool& tool, const HapticOptions& options, const Pose& start,
                         const RigSetup& setup)
    : tool_(tool)
    , options_(options)
    , setup_(setup)
    , cycle_(std::make_unique<HapticCycle>(tool_, std::span<const Shape>{}, options_, start))
    , cull_(setup.capacity)
    , audit_(tool_) {}

void LockstepRig::show(HostFixtures set) {
    auto next = std::make_unique<Published>();
    next->set = std::move(set);
    next->set.generation = ++generation_;
    next->set.frame = static_cast<int64_t>(generation_) - 1;
    next->set.captureTime = captured_ = static_cast<double>(now_) * options_.period;
    next->grid.build(next->set.spheres);
    published_.push_back(std::move(next));
    forgetOldSets();
}

void LockstepRig::forgetOldSets() {
    const ContactSet* active = contacts_.active();
    const uint64_t used = active != nullptr ? active->generation : generation_;
    const uint64_t asked = pending_.empty() ? generation_ : pending_.front().set->generation;
    while (published_.size() > 1 && published_.front()->set.generation < std::min(used, asked)) {
        published_.pop_front();
    }
}

void LockstepRig::ask() {
    if (published_.empty() || rng_.chance(faults.lost)) {
        return;
    }
    const Published& newest = *published_.back();
    auto set = std::make_unique<ContactSet>();
    cull_.query(tool_, cycle_->pose(), setup_.reach, newest.set, newest.grid, *set);
    behind_.update(tool_, newest.set, newest.grid.maxRadius(), *set);
    set->query = ++queries_;
    const uint64_t late = faults.jitter ? rng_.below(faults.late + 1) : faults.late;
    pending_.push_back({now_ + late, std::move(set)});
}

// Returns the newest answer that is due and drops older ones.
std::unique_ptr<ContactSet> LockstepRig::arrived() {
    std::unique_ptr<ContactSet> offered;
    while (!pending_.empty() && pending_.front().due <= now_) {
        offered = std::move(pending_.front().set);
        pending_.pop_front();
    }
    return offered;
}

StepRecord LockstepRig::step(const Pose& hand) {
    ask();
    contacts_.offer([this] { return arrived(); });
    const bool offered = contacts_.offered() != nullptr;
    const Pose before = cycle_->pose();
    StepInput input = stepInput({hand}, static_cast<double>(now_) * options_.period);
    if (!published_.empty()) {
        input.frame = published_.back()->set.frame;
        input.generation = generation_;
        input.captureTime = fresh_ ? input.time : captured_;
    }
    const StepRecord record = contacts_.step(*cycle_, input);
    figures.refused += offered && !record.adopted ? 1 : 0;
    judge(before, record);
    ++now_;
    return record;
}

const LockstepRig::Published* LockstepRig::published(uint64_t generation) const {
    for (const auto& p : published_) {
        if (p->set.generation == generation) {
            return p.get();
        }
    }
    throw Error("stability: a contact set refers to a fixture set that was released");
}

void LockstepRig::judge(const Pose& before, const StepRecord& record) {
    if (const ContactSet* active = contacts_.active()) {
        std::vector<uint32_t> behind;
        active->leavesBehind(behind);
        const Published& obeyed = *published(active->generation);
        audit_.tick(obeyed.set, obeyed.grid, before, record.tool, behind);
    }
    ++figures.ticks;
    figures.contact += record.contactCount > 0 ? 1 : 0;
    figures.stalled += record.stalled ? 1 : 0;
    figures.trapped += record.state == StepState::Trapped ? 1 : 0;
    figures.escape += record.state == StepState::Escape ? 1 : 0;
    figures.notFinite += record.finite ? 0 : 1;
    figures.path += glm::distance(before.position, record.tool.position);
    figures.force = std::max(figures.force, glm::length(record.wrench.force));
    figures.torque = std::max(figures.torque, glm::length(record.wrench.torque));
    if (before_) {
        figures.forceStep = std::max(figures.forceStep, glm::distance(record.wrench.force, before_->force));
        figures.torqueStep =
            std::max(figures.torqueStep, glm::distance(record.wrench.torque, before_->torque));
        figures.forceRise.add(glm::length(record.wrench.force) - glm::length(before_->force));
        figures.torqueRise.add(glm::length(record.wrench.torque) - glm::length(before_->torque));
    }
    before_ = record.wrench;
}

double LockstepRig::depth() const {
    return -oracleSmallestGap(tool_, cycle_->pose(), shown());
}

} // namespace fathom::stability
