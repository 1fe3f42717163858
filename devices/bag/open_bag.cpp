// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/open_bag.h"

#include "devices/bag/bag_camera.h"
#include "devices/bag/cloud_camera.h"
#include "engine/types/error.h"

namespace fathom {

namespace {

// The Orbbec SDK (OrbbecViewer) calls its messages sensor_msgs/Image, too, but with fields of its own.
void refuseOrbbec(const MessageFile& file) {
    for (const MessageTopic& topic : file.topics()) {
        if (topic.name.starts_with("/cam/streamProfileType_")) {
            throw BadInput(file.file().string(), topic.name,
                           "a recording of the Orbbec SDK, whose messages are its own",
                           "a bag that a ROS driver of the camera recorded");
        }
    }
}

} // namespace

std::unique_ptr<Camera> openBag(const std::filesystem::path& file, const SourceOptions& options) {
    std::unique_ptr<MessageFile> messages = openMessageFile(file);
    refuseOrbbec(*messages);
    if (playsClouds(*messages, options)) {
        return std::make_unique<CloudCamera>(std::move(messages), options);
    }
    return std::make_unique<BagCamera>(std::move(messages), options);
}

} // namespace fathom
