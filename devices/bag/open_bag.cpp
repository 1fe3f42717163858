// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/open_bag.h"

#include "devices/bag/bag_camera.h"
#include "devices/bag/cloud_camera.h"

namespace fathom {

std::unique_ptr<Camera> openBag(const std::filesystem::path& file, const SourceOptions& options) {
    std::unique_ptr<MessageFile> messages = openMessageFile(file);
    if (playsClouds(*messages, options)) {
        return std::make_unique<CloudCamera>(std::move(messages), options);
    }
    return std::make_unique<BagCamera>(std::move(messages), options);
}

} // namespace fathom
