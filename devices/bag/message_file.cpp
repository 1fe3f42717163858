// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/message_file.h"

#include "devices/bag/bag_file.h"
#include "devices/bag/matroska_file.h"
#include "devices/bag/mcap_file.h"
#include "devices/bag/orbbec_recording.h"
#include "devices/bag/realsense_recording.h"
#include "devices/bag/ros2_database.h"
#include "devices/bag/split_recording.h"
#include "engine/types/input_files.h"
#include "engine/types/log.h"
#include "engine/types/read_file.h"
#include "engine/types/stand_in.h"

namespace fathom {

const MessageTopic* MessageFile::find(const std::string& name) const {
    const auto topic = std::ranges::find(topics_, name, &MessageTopic::name);
    return topic == topics_.end() ? nullptr : &*topic;
}

std::string MessageFile::faultOf(const std::string& topic) const {
    const auto fault = faults_.find(topic);
    return fault == faults_.end() ? "" : fault->second;
}

size_t MessageFile::topicAt(const std::string& name, std::string type, bool cdr) {
    const auto topic = std::ranges::find(topics_, name, &MessageTopic::name);
    if (topic != topics_.end()) {
        return static_cast<size_t>(topic - topics_.begin());
    }
    if (const size_t middle = type.find("/msg/"); middle != std::string::npos) {
        type.erase(middle, 4);
    }
    topics_.push_back({name, std::move(type), {}, cdr});
    return topics_.size() - 1;
}

void MessageFile::sortByTime() {
    for (MessageTopic& topic : topics_) {
        std::ranges::stable_sort(topic.messages, {}, &MessageEntry::time);
    }
}

void MessageFile::warn(const std::string& warning) {
    log::warn("{}: {}", file_.string(), warning);
    warnings_.push_back(warning);
}

namespace {

// The file, or its messages as those of ROS where a camera maker's SDK recorded it.
std::unique_ptr<MessageFile> asRos(std::unique_ptr<MessageFile> file) {
    const std::string name = file->file().string();
    try {
        if (OrbbecRecording::recognises(*file)) {
            return std::make_unique<OrbbecRecording>(std::move(file));
        }
        if (RealSenseRecording::recognises(*file)) {
            return std::make_unique<RealSenseRecording>(std::move(file));
        }
    } catch (const BadInput&) {
        throw;
    } catch (const Error& e) {
        throw BadInput(name, "content", e.what(), "whole messages");
    }
    return file;
}

} // namespace

std::unique_ptr<MessageFile> openMessageFile(const std::filesystem::path& file) {
    std::error_code failed;
    if (std::filesystem::is_directory(file, failed)) {
        return std::make_unique<SplitRecording>(file);
    }
    noteInput(file);
    const std::string begin = firstBytes(file, 16), ending = endingOf(file);
    const bool bag = begin.starts_with("#ROSBAG"), database = begin.starts_with("SQLite format 3"),
               mcap = begin.starts_with("\x89MCAP"), matroska = begin.starts_with("\x1a\x45\xdf\xa3"),
               known = bag || database || mcap || matroska;
    if (!known) {
        refuseStandIn(file, "a ROS bag, an MCAP file, a ROS 2 database or an Azure Kinect recording");
    }
    if (matroska || (!known && ending == ".mkv")) { // the first bytes decide, not the name
        return std::make_unique<MatroskaFile>(file);
    }
    if (mcap || (!known && ending == ".mcap")) {
        return asRos(std::make_unique<McapFile>(file));
    }
    if (database || (!known && ending == ".db3")) {
        return asRos(std::make_unique<Ros2Database>(file));
    }
    return asRos(std::make_unique<BagFile>(file));
}

} // namespace fathom
