// SPDX-License-Identifier: Apache-2.0
// Copies buffers of the device to the host, for checks.
#pragma once

#include "engine/gpu/commands.h"
#include "engine/gpu/device.h"
#include "engine/gpu/timeline.h"

#include <vector>

namespace fathom::verify {

// Contents of any buffer, copied by the device. Nothing that writes it may be in flight.
template <class T>
std::vector<T> readBack(gpu::Device& device, const gpu::Buffer& buffer) {
    const gpu::Buffer landing(device, buffer.bytes(), gpu::MemoryKind::Readback, "landing");
    gpu::Commands commands(device);
    const gpu::Timeline timeline(device);
    commands.begin();
    commands.copy(buffer, landing, buffer.bytes());
    commands.end();
    device.submit(commands.handle(), {}, {timeline.handle(), 1});
    timeline.wait(1);
    const auto view = landing.as<T>();
    return {view.begin(), view.end()};
}

} // namespace fathom::verify
