// SPDX-License-Identifier: Apache-2.0
#include "tests/losing_layer/asked.h"

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <set>

namespace losing {

namespace {

VkSurfaceKHR newest = VK_NULL_HANDLE;
std::set<VkSurfaceKHR> lost;

} // namespace

long number(const char* name) {
    const char* text = std::getenv(name);
    return text == nullptr ? 0 : std::strtol(text, nullptr, 10);
}

VkResult lossOf() {
    const char* by = std::getenv("FATHOM_LOSE_BY");
    return by != nullptr && std::strcmp(by, "memory") == 0 ? VK_ERROR_OUT_OF_DEVICE_MEMORY
                                                           : VK_ERROR_DEVICE_LOST;
}

bool askedFor(const char* call) {
    const char* name = std::getenv("FATHOM_LOSE_FILE");
    char word[32] = {};
    std::FILE* file = name == nullptr ? nullptr : std::fopen(name, "r");
    if (file == nullptr) {
        return false;
    }
    const bool read = std::fscanf(file, "%31s", word) == 1;
    std::fclose(file);
    return read && std::strcmp(word, call) == 0 && std::remove(name) == 0;
}

void hasImages(VkSurfaceKHR surface) {
    newest = surface;
}

void loseSurface() {
    lost.insert(newest);
}

VkResult refusalOf(VkSurfaceKHR surface) {
    if (lost.count(surface) != 0) {
        return VK_ERROR_SURFACE_LOST_KHR;
    }
    return askedFor("window-used") ? VK_ERROR_NATIVE_WINDOW_IN_USE_KHR : VK_SUCCESS;
}

void forget(VkSurfaceKHR surface) {
    lost.erase(surface);
}

} // namespace losing
