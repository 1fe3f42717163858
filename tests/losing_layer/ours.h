// SPDX-License-Identifier: Apache-2.0
// Look-up of functions: those that the layer implements itself, and those of the layer below.
#pragma once

#include <cstring>
#include <initializer_list>
#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

namespace losing {

struct Ours {
    const char* name;
    PFN_vkVoidFunction call;
};

// The layer's function of that name; null if it has none.
inline PFN_vkVoidFunction among(std::initializer_list<Ours> all, const char* name) {
    for (const Ours& one : all) {
        if (one.call != nullptr && std::strcmp(name, one.name) == 0) {
            return one.call;
        }
    }
    return nullptr;
}

// Key of a device: the dispatch table of the loader, which its queues share.
inline void* keyOf(void* handle) {
    return *static_cast<void**>(handle);
}

template <class Call>
Call find(PFN_vkGetDeviceProcAddr address, VkDevice device, const char* name) {
    return reinterpret_cast<Call>(address(device, name));
}

// The entry of the loader in a chain of creation infos; null if there is none.
template <class Link>
Link* linkOf(const void* chain, VkStructureType type) {
    for (auto* at = static_cast<const VkBaseInStructure*>(chain); at != nullptr; at = at->pNext) {
        auto* link = reinterpret_cast<Link*>(const_cast<VkBaseInStructure*>(at));
        if (at->sType == type && link->function == VK_LAYER_LINK_INFO) {
            return link;
        }
    }
    return nullptr;
}

} // namespace losing
