// SPDX-License-Identifier: Apache-2.0
// What was discovered of the compute device, in plain numbers, so that the plan needs no Vulkan.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace fathom {

// What the driver calls the device.
enum class DeviceKind { Discrete, Integrated, Cpu, Other };

struct DeviceFacts {
    std::string name;
    std::string driver;
    std::array<uint8_t, 16>
        uuid{}; // VkPhysicalDeviceIDProperties::deviceUUID: the same in other interfaces of a driver
    DeviceKind kind = DeviceKind::Cpu;
    uint32_t subgroupSize = 1;
    uint32_t maxInvocations = 128;   // of one work group
    uint32_t maxSharedBytes = 16384; // of one work group
    uint64_t maxStorageBufferBytes = 1u << 27;
    uint32_t hostProcessors = 1;       // that the thread that made the device may use
    uint64_t hostPointerAlignment = 0; // of imported host memory; 0 = cannot import
    double timestampPeriodNs = 1.0;    // 0 = no timestamps
    // From so many tool leaves on `contact.where: auto` asks this device, when it is not a CPU. Never, unless
    // `fathom profile query` measured it here: on an NVIDIA H200 the CPU was faster at every tool
    // (docs/h200).
    uint32_t gpuQueryLeaves = 0xffffffffu;
};

} // namespace fathom
