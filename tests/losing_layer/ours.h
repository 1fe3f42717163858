// SPDX-License-Identifier: Apache-2.0
// Which of the calls that an application looks up are the layer's own.
#pragma once

#include <cstring>
#include <initializer_list>
#include <vulkan/vulkan.h>

namespace losing {

struct Ours {
    const char* name;
    PFN_vkVoidFunction call;
};

// Ours of that name; null: none.
inline PFN_vkVoidFunction among(std::initializer_list<Ours> all, const char* name) {
    for (const Ours& one : all) {
        if (one.call != nullptr && std::strcmp(name, one.name) == 0) {
            return one.call;
        }
    }
    return nullptr;
}

} // namespace losing
