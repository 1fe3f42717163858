// SPDX-License-Identifier: Apache-2.0
// One submission after the other on the queue for contact queries, each awaited and timed where wanted.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/gpu/stopwatch.h"
#include "engine/gpu/timeline.h"
#include "engine/types/pose.h"

#include <glm/vec4.hpp>

namespace fathom::cloud {

// One thread. Has a timeline and a command buffer of its own.
class QueryRun {
public:
    explicit QueryRun(gpu::Device& device);

    // Begins new commands.
    gpu::Commands& begin();
    // Marks in these commands, between which gpuMs() counts. Each once per submission, or not at all.
    void startTime();
    void stopTime();
    // Ends and submits the commands behind `after`, and blocks until the device has finished. Throws
    // DeviceLost, DeviceFailed.
    void submit(const gpu::Device::TimelinePoint& after);

    // Enables timestamps. gpuMs(): device time between the last marks; 0 when not enabled or not supported.
    void enableTimestamps() { timed_ = true; }
    double gpuMs() const;

private:
    gpu::Device& device_;
    gpu::Timeline timeline_;
    gpu::Commands commands_;
    gpu::Stopwatch watch_;
    bool timed_ = false;
    uint64_t ticket_ = 0;
};

// The tool's pose as a query's parameters hold it: rows of the rotation, and the position from `origin` [m].
void writeRows(const Pose& baseTtool, const dvec3& origin, glm::vec4 (&rows)[3]);

} // namespace fathom::cloud
