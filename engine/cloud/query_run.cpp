// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/query_run.h"

namespace fathom::cloud {

QueryRun::QueryRun(gpu::Device& device)
    : device_(device)
    , timeline_(device)
    , commands_(device)
    , watch_(device, 2) {}

gpu::Commands& QueryRun::begin() {
    commands_.begin();
    return commands_;
}

void QueryRun::startTime() {
    if (timed_) {
        watch_.reset();
        watch_.mark(commands_.handle());
    }
}

void QueryRun::stopTime() {
    if (timed_) {
        watch_.mark(commands_.handle());
    }
}

void QueryRun::submit(const gpu::Device::TimelinePoint& after) {
    commands_.end();
    device_.submitQuery(commands_.handle(), after, {timeline_.handle(), ++ticket_});
    timeline_.wait(ticket_);
}

double QueryRun::gpuMs() const {
    const std::vector<double> intervals = watch_.intervalsMs();
    return intervals.empty() ? 0.0 : intervals.front();
}

void writeRows(const Pose& baseTtool, const dvec3& origin, glm::vec4 (&rows)[3]) {
    const dvec3 t = baseTtool.position - origin;
    const glm::dmat3 rotation = glm::mat3_cast(baseTtool.rotation); // its columns are the rows of the inverse
    for (int k = 0; k < 3; ++k) {
        rows[k] = glm::vec4(glm::vec3(rotation[k]), static_cast<float>(t[k]));
    }
}

} // namespace fathom::cloud
