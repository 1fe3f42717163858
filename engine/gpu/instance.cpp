// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/instance.h"

#include "engine/gpu/result.h"
#include "engine/types/error.h"
#include "engine/types/log.h"

#include <atomic>
#include <cstring>
#include <dlfcn.h>
#include <link.h>

namespace fathom::gpu {

namespace {

constexpr const char* kLayer = "VK_LAYER_KHRONOS_validation";
std::atomic<uint32_t> messages{0};

VKAPI_ATTR VkBool32 VKAPI_CALL onMessage(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                         VkDebugUtilsMessageTypeFlagsEXT,
                                         const VkDebugUtilsMessengerCallbackDataEXT* data, void* /*user*/) {
    // The GPU-assisted checks report their own settings as warnings, under names that differ by release.
    // These do not concern our use of Vulkan.
    if (std::strstr(data->pMessage, "Internal Warning") != nullptr) {
        return VK_FALSE;
    }
    messages.fetch_add(1);
    log::error("Vulkan validation: {}", data->pMessage);
    return VK_FALSE;
}

bool layerPresent() {
    uint32_t count = 0;
    check(vkEnumerateInstanceLayerProperties(&count, nullptr), "vkEnumerateInstanceLayerProperties");
    std::vector<VkLayerProperties> layers(count);
    check(vkEnumerateInstanceLayerProperties(&count, layers.data()), "vkEnumerateInstanceLayerProperties");
    for (const VkLayerProperties& layer : layers) {
        if (std::strcmp(layer.layerName, kLayer) == 0) {
            return true;
        }
    }
    return false;
}

// Throws when the loader found no driver or could not load any.
[[noreturn]] void refuseDrivers() {
    throw DeviceMissing(
        "device: Vulkan driver: none is installed (allowed: a Vulkan 1.2 driver: install your GPU's, or "
        "mesa-vulkan-drivers, which also runs on the CPU)");
}

// Sanitized builds keep drivers loaded until the program ends; otherwise leak reports lack their symbols.
void keepDriversLoaded() {
#ifdef FATHOM_SANITIZED
    dl_iterate_phdr(
        [](dl_phdr_info* info, size_t, void*) {
            const std::string name = info->dlpi_name;
            if (name.find("vulkan") != std::string::npos || name.find("VkLayer") != std::string::npos) {
                dlopen(name.c_str(), RTLD_NOW | RTLD_NODELETE);
            }
            return 0;
        },
        nullptr);
#endif
}

VkDebugUtilsMessengerCreateInfoEXT messengerInfo() {
    VkDebugUtilsMessengerCreateInfoEXT info{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    info.messageSeverity =
        VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    info.messageType =
        VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT;
    info.pfnUserCallback = onMessage;
    return info;
}

} // namespace

Instance::Instance(Validation validation, std::span<const char* const> extensions)
    : validation_(validation) {
    if (validation.enabled && !layerPresent()) {
        throw Error("the requested validation layer is not installed (package vulkan-validationlayers)");
    }
    VkApplicationInfo app{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    app.pApplicationName = "fathom";
    app.apiVersion = VK_API_VERSION_1_2;

    std::vector<VkValidationFeatureEnableEXT> enables{
        VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
    if (validation.gpuAssisted) {
        enables.push_back(VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT);
        enables.push_back(VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_RESERVE_BINDING_SLOT_EXT);
    }
    VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
    features.enabledValidationFeatureCount = static_cast<uint32_t>(enables.size());
    features.pEnabledValidationFeatures = enables.data();

    std::vector<const char*> names(extensions.begin(), extensions.end());
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &app;
    if (validation.enabled) {
        info.pNext = &features;
        info.enabledLayerCount = 1;
        info.ppEnabledLayerNames = &kLayer;
        names.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
    }
    info.enabledExtensionCount = static_cast<uint32_t>(names.size());
    info.ppEnabledExtensionNames = names.data();
    const VkResult created = vkCreateInstance(&info, nullptr, &handle_);
    if (created == VK_ERROR_INCOMPATIBLE_DRIVER) {
        refuseDrivers();
    }
    check(created, "vkCreateInstance");
    if (validation.enabled) {
        const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(handle_, "vkCreateDebugUtilsMessengerEXT"));
        const auto messenger = messengerInfo();
        check(create(handle_, &messenger, nullptr, &messenger_), "vkCreateDebugUtilsMessengerEXT");
    }
}

Instance::~Instance() {
    if (messenger_ != VK_NULL_HANDLE) {
        const auto destroy = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
            vkGetInstanceProcAddr(handle_, "vkDestroyDebugUtilsMessengerEXT"));
        destroy(handle_, messenger_, nullptr);
    }
    vkDestroyInstance(handle_, nullptr);
}

uint32_t validationMessages() {
    return messages.load();
}

std::vector<VkPhysicalDevice> Instance::physicalDevices() const {
    uint32_t count = 0;
    check(vkEnumeratePhysicalDevices(handle_, &count, nullptr), "vkEnumeratePhysicalDevices");
    std::vector<VkPhysicalDevice> devices(count);
    check(vkEnumeratePhysicalDevices(handle_, &count, devices.data()), "vkEnumeratePhysicalDevices");
    keepDriversLoaded();
    return devices;
}

} // namespace fathom::gpu
