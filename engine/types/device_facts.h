// SPDX-License-Identifier: Apache-2.0
// Properties of the compute device in plain numbers, so that the plan needs no Vulkan.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace fathom {

// The device type that the driver reports.
enum class DeviceKind { Discrete, Integrated, Cpu, Other };

// More leaves than any tool has: the CPU always answers.
inline constexpr uint32_t kNeverOnGpu = 0xffffffffu;

struct DeviceFacts {
    std::string name;
    std::string driver;
    std::array<uint8_t, 16>
        uuid{}; // VkPhysicalDeviceIDProperties::deviceUUID, also reported by the driver's other interfaces
    DeviceKind kind = DeviceKind::Cpu;
    uint32_t subgroupSize = 1;
    bool subgroupArithmetic = false; // in compute shaders
    uint32_t maxInvocations = 128;   // of one work group
    uint32_t maxSharedBytes = 16384; // of one work group
    uint64_t maxStorageBufferBytes = 1u << 27;
    uint32_t maxTexels = 1u << 16;     // of one texel buffer
    uint32_t hostProcessors = 1;       // CPUs usable by the thread that created the device
    uint64_t hostPointerAlignment = 0; // [bytes] of imported host memory; 0 = cannot import
    double timestampPeriodNs = 1.0;    // 0 = no timestamps
    uint32_t timestampBits = 64;       // after which they begin again at 0
    // Number of tool leaves from which `contact.where: auto` uses this device, if it is not a CPU. Never by
    // default; discrete GPUs start with a measured number, and `fathom profile query` stores one per device.
    uint32_t gpuQueryLeaves = kNeverOnGpu;
};

// In place of a device, for a scene without passes.
inline DeviceFacts noDevice() {
    DeviceFacts facts;
    facts.name = "none";
    return facts;
}

} // namespace fathom
