// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/physical_device.h"

#include "engine/gpu/result.h"
#include "engine/types/error.h"
#include "engine/types/processors.h"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>

namespace fathom::gpu {

namespace {

constexpr uint32_t kMaxBindings = 20; // storage buffers of the largest pass
// An H200 was faster than the CPU from here on in every set that `fathom profile query` measures (docs/h200).
constexpr uint32_t kDiscreteQueryLeaves = 256;

// Ignores case. True for an empty part.
bool contains(const std::string& name, const std::string& part) {
    const auto same = [](char a, char b) {
        return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
    };
    return std::search(name.begin(), name.end(), part.begin(), part.end(), same) != name.end() ||
           part.empty();
}

DeviceKind kindOf(VkPhysicalDeviceType type) {
    switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
        return DeviceKind::Discrete;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
        return DeviceKind::Integrated;
    case VK_PHYSICAL_DEVICE_TYPE_CPU:
        return DeviceKind::Cpu;
    default:
        return DeviceKind::Other;
    }
}

int rank(DeviceKind kind) {
    switch (kind) {
    case DeviceKind::Discrete:
        return 0;
    case DeviceKind::Integrated:
        return 1;
    case DeviceKind::Other:
        return 2;
    case DeviceKind::Cpu:
        return 3;
    }
    return 4;
}

std::string describeAll(const std::vector<VkPhysicalDevice>& devices) {
    std::string text;
    for (size_t i = 0; i < devices.size(); ++i) {
        const std::string why = refusal(devices[i]);
        text += (i ? "; " : "") + std::to_string(i) + " = " + readFacts(devices[i]).name;
        text += why.empty() ? "" : " (refused: " + why + ")";
    }
    return text.empty() ? "there is no Vulkan device" : text;
}

} // namespace

bool hasExtension(VkPhysicalDevice device, const char* name) {
    uint32_t count = 0;
    check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, nullptr),
          "vkEnumerateDeviceExtensionProperties");
    std::vector<VkExtensionProperties> list(count);
    check(vkEnumerateDeviceExtensionProperties(device, nullptr, &count, list.data()),
          "vkEnumerateDeviceExtensionProperties");
    for (const VkExtensionProperties& e : list) {
        if (std::strcmp(e.extensionName, name) == 0) {
            return true;
        }
    }
    return false;
}

DeviceFacts readFacts(VkPhysicalDevice device) {
    VkPhysicalDeviceExternalMemoryHostPropertiesEXT host{
        VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_MEMORY_HOST_PROPERTIES_EXT};
    VkPhysicalDeviceSubgroupProperties subgroup{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_SUBGROUP_PROPERTIES};
    VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
    VkPhysicalDeviceIDProperties id{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_ID_PROPERTIES};
    subgroup.pNext = &driver;
    id.pNext = &subgroup;
    const bool canImport = hasExtension(device, VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME);
    driver.pNext = canImport ? &host : nullptr;
    VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
    properties.pNext = &id;
    vkGetPhysicalDeviceProperties2(device, &properties);
    const VkPhysicalDeviceLimits& limits = properties.properties.limits;

    DeviceFacts facts;
    facts.name = properties.properties.deviceName;
    facts.driver = std::string(driver.driverName) + " " + driver.driverInfo;
    std::copy_n(id.deviceUUID, facts.uuid.size(), facts.uuid.begin());
    facts.kind = kindOf(properties.properties.deviceType);
    facts.subgroupSize = subgroup.subgroupSize;
    facts.subgroupArithmetic = (subgroup.supportedStages & VK_SHADER_STAGE_COMPUTE_BIT) != 0 &&
                               (subgroup.supportedOperations & VK_SUBGROUP_FEATURE_ARITHMETIC_BIT) != 0;
    facts.maxInvocations = limits.maxComputeWorkGroupInvocations;
    facts.maxSharedBytes = limits.maxComputeSharedMemorySize;
    facts.maxStorageBufferBytes = limits.maxStorageBufferRange;
    facts.maxTexels = limits.maxTexelBufferElements;
    facts.hostProcessors = usableProcessors();
    facts.gpuQueryLeaves = facts.kind == DeviceKind::Discrete ? kDiscreteQueryLeaves : facts.gpuQueryLeaves;
    facts.hostPointerAlignment = canImport ? host.minImportedHostPointerAlignment : 0;
    const std::optional<uint32_t> family = computeFamily(device);
    facts.timestampBits = family ? queueFamilies(device)[*family].timestampValidBits : 0;
    facts.timestampPeriodNs = facts.timestampBits > 0 ? static_cast<double>(limits.timestampPeriod) : 0.0;
    return facts;
}

std::vector<VkQueueFamilyProperties> queueFamilies(VkPhysicalDevice device) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(device, &count, families.data());
    return families;
}

std::optional<uint32_t> computeFamily(VkPhysicalDevice device) {
    const std::vector<VkQueueFamilyProperties> families = queueFamilies(device);
    const auto count = static_cast<uint32_t>(families.size());
    std::optional<uint32_t> any;
    for (uint32_t f = 0; f < count; ++f) {
        if ((families[f].queueFlags & VK_QUEUE_COMPUTE_BIT) == 0) {
            continue;
        }
        if ((families[f].queueFlags & VK_QUEUE_GRAPHICS_BIT) == 0) {
            return f;
        }
        any = any ? any : f;
    }
    return any;
}

std::string refusal(VkPhysicalDevice device) {
    VkPhysicalDeviceProperties properties;
    vkGetPhysicalDeviceProperties(device, &properties);
    if (properties.apiVersion < VK_API_VERSION_1_2) {
        return "it offers less than Vulkan 1.2";
    }
    VkPhysicalDeviceVulkan12Features v12{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_2_FEATURES};
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    features.pNext = &v12;
    vkGetPhysicalDeviceFeatures2(device, &features);
    if (!v12.timelineSemaphore) {
        return "it has no timeline semaphores";
    }
    if (properties.limits.maxPerStageDescriptorStorageBuffers < kMaxBindings) {
        return "a shader reaches fewer than " + std::to_string(kMaxBindings) + " storage buffers";
    }
    return computeFamily(device) ? "" : "it has no compute queue";
}

VkPhysicalDevice choosePhysicalDevice(const Instance& instance, const std::string& selector) {
    const auto devices = instance.physicalDevices();
    size_t wanted = devices.size();
    const auto parsed = std::from_chars(selector.data(), selector.data() + selector.size(), wanted);
    const bool byIndex = !selector.empty() && parsed.ptr == selector.data() + selector.size();
    VkPhysicalDevice best = VK_NULL_HANDLE;
    int bestRank = 99;
    for (size_t i = 0; i < devices.size(); ++i) {
        const DeviceFacts facts = readFacts(devices[i]);
        const bool named = byIndex ? i == wanted : contains(facts.name, selector);
        if (named && refusal(devices[i]).empty() && rank(facts.kind) < bestRank) {
            best = devices[i];
            bestRank = rank(facts.kind);
        }
    }
    if (best == VK_NULL_HANDLE) {
        const auto refused = [&] {
            return BadInput("device", "name or index", "'" + selector + "'", describeAll(devices));
        };
        if (selector.empty() || devices.empty()) {
            throw DeviceMissing(refused().what());
        }
        throw refused();
    }
    return best;
}

} // namespace fathom::gpu
