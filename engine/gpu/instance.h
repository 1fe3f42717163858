// SPDX-License-Identifier: Apache-2.0
// The Vulkan instance, with the validation layer and synchronisation validation on demand.
#pragma once

#include <cstdint>
#include <span>
#include <vector>
#include <vulkan/vulkan.h>

namespace fathom::gpu {

// The requested checks of the validation layer.
struct Validation {
    bool enabled = false;     // core and synchronisation checks
    bool gpuAssisted = false; // also instruments shaders: slow
};

// Used by the thread that builds the engine.
class Instance {
public:
    // extensions: instance extensions that a window's toolkit needs, else none. Throws DeviceMissing without
    // a driver, Error without a Vulkan 1.2 loader or when the requested layer or an extension is missing.
    explicit Instance(Validation validation = {}, std::span<const char* const> extensions = {});
    ~Instance();
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    VkInstance handle() const { return handle_; }
    Validation validation() const { return validation_; }
    std::vector<VkPhysicalDevice> physicalDevices() const;

private:
    VkInstance handle_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    Validation validation_;
};

// Number of warnings and errors that the layer has reported in this process. Includes destroyed instances,
// because some reports come when a device is destroyed. Each is logged. Any thread.
uint32_t validationMessages();

} // namespace fathom::gpu
