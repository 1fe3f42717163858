// SPDX-License-Identifier: Apache-2.0
#include "apps/output/haptics_csv.h"

namespace fathom {

namespace {

void addVector(CsvRow& row, const dvec3& v) {
    row.add(v.x);
    row.add(v.y);
    row.add(v.z);
}

void addPose(CsvRow& row, const Pose& pose) {
    addVector(row, pose.position);
    row.add(pose.rotation.w);
    row.add(pose.rotation.x);
    row.add(pose.rotation.y);
    row.add(pose.rotation.z);
}

} // namespace

HapticsCsv::HapticsCsv(const std::filesystem::path& file)
    : file_(file) {
    file_.write(kHeader);
    file_.write("\n");
}

void HapticsCsv::add(const StepRecord& tick) {
    row_.add(tick.t);
    addPose(row_, tick.device);
    addPose(row_, tick.tool);
    addVector(row_, tick.wrench.force);
    addVector(row_, tick.wrench.torque);
    row_.add(int64_t{tick.contactCount});
    row_.add(tick.minGap);
    row_.add(std::string_view(stateName(tick.state)));
    row_.add(tick.guidance);
    row_.add(tick.frame);
    row_.add(tick.sceneAge);
    row_.add(int64_t{tick.stalled});
    row_.add(tick.marginPassive);
    row_.add(tick.marginUncoupled);
    row_.add(int64_t{tick.cause});
    row_.add(tick.lag);
    for (const Wrench& wrench : {tick.deviceWrench, tick.residual}) {
        addVector(row_, wrench.force);
        addVector(row_, wrench.torque);
    }
    row_.add(tick.clearance);
    file_.write(row_.end());
    digest_.add(tick);
}

void HapticsCsv::commit() {
    file_.commit();
}

} // namespace fathom
