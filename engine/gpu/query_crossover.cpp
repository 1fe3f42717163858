// SPDX-License-Identifier: Apache-2.0
#include "engine/gpu/query_crossover.h"

#include "engine/types/cache_file.h"
#include "engine/types/cache_folder.h"

#include <exception>
#include <filesystem>
#include <fstream>

namespace fathom::gpu {

std::string cacheFileOf(VkPhysicalDevice device, const std::string& extension) {
    const std::filesystem::path folder = cacheFolder();
    if (folder.empty()) {
        return {};
    }
    VkPhysicalDeviceProperties p;
    vkGetPhysicalDeviceProperties(device, &p);
    return (folder / (std::to_string(p.vendorID) + "-" + std::to_string(p.deviceID) + "-" +
                      std::to_string(p.driverVersion) + extension))
        .string();
}

uint32_t storedQueryCrossover(VkPhysicalDevice device, uint32_t fallback) noexcept {
    try {
        std::ifstream file(cacheFileOf(device, ".crossover"));
        uint32_t leaves = 0;
        return file >> leaves && leaves > 0 ? leaves : fallback;
    } catch (const std::exception&) {
        return fallback;
    }
}

bool storeQueryCrossover(VkPhysicalDevice device, uint32_t leaves) noexcept {
    try {
        const std::filesystem::path target(cacheFileOf(device, ".crossover"));
        if (target.empty()) {
            return false;
        }
        storeCacheFile(target, std::to_string(leaves) + "\n");
        return true;
    } catch (const std::exception&) {
        return false;
    }
}

} // namespace fathom::gpu
