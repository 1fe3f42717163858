// SPDX-License-Identifier: Apache-2.0
// The Vulkan instance, with the validation layer and synchronisation validation on demand.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>
#include <vulkan/vulkan.h>

namespace fathom::gpu {

// Which checks of the validation layer are asked for.
struct Validation {
    bool enabled = false;     // core and synchronisation checks
    bool gpuAssisted = false; // instruments shaders as well: slow
};

// Used from the thread that builds the engine.
class Instance {
public:
    // extensions: of the instance, for a window (what its toolkit names); the calls below need none.
    // Throws Error when there is no Vulkan 1.2 loader or the layer or extension that was asked for is
    // missing.
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

// Warnings and errors that the layer has reported in this process so far, of instances that are gone, too:
// some come as a device is destroyed. Each is logged. Any thread.
uint32_t validationMessages();

} // namespace fathom::gpu
