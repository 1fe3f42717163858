// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/frame_device.h"

#include "engine/types/error.h"

namespace fathom {

namespace {

std::vector<cloud::SetBuffers*> buffersOf(cloud::FixturePool& pool) {
    std::vector<cloud::SetBuffers*> buffers;
    for (size_t i = 0; i < pool.size(); ++i) {
        buffers.push_back(&pool.at(i).device);
    }
    return buffers;
}

} // namespace

FrameDevice::FrameDevice(gpu::Device& device, const Plan& plan, const PatchLayout& layout,
                         const CameraInfo& camera, cloud::FixturePool& pool)
    : device_(device)
    , work_(device, plan, layout, camera)
    , uploads_(device, plan, camera)
    , sets_(buffersOf(pool))
    , passes_(cloud::CloudContext{device, plan, layout, camera, work_, sets_})
    , timeline_(device) {
    passes_.bind(cloud::UploadSlots::kCopied, uploads_[cloud::UploadSlots::kCopied]);
}

FrameDevice::~FrameDevice() {
    try {
        if (ticket_ != 0) {
            wait(); // the device may still use the buffers
        }
    } catch (const Error&) {
        // A lost device uses no buffer.
    }
}

uint32_t FrameDevice::slotFor(const Frame& frame) {
    const auto [slot, isNew] = uploads_.choose(frame);
    if (isNew) {
        passes_.bind(slot, uploads_[slot]);
    }
    return slot;
}

void FrameDevice::submit(const gpu::Commands& commands) {
    device_.submit(commands.handle(), {timeline_.handle(), ticket_}, {timeline_.handle(), ticket_ + 1});
    ++ticket_;
}

void FrameDevice::clearMemory() {
    gpu::Commands commands(device_);
    commands.begin();
    cloud::clearCounters(commands, work_);
    for (const gpu::Buffer* buffer :
         {&work_.seen, &work_.kept, &work_.keptTime, &work_.memoryCounts, &work_.estimates}) {
        if (*buffer) {
            commands.fill(*buffer, 0);
        }
    }
    commands.end();
    submit(commands);
    wait();
}

} // namespace fathom
