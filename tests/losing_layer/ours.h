// SPDX-License-Identifier: Apache-2.0
// Look-up of the functions that the layer implements itself.
#pragma once

#include <cstring>
#include <initializer_list>
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

} // namespace losing
