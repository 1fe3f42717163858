// SPDX-License-Identifier: Apache-2.0
// Makes small databases of ROS 2 by the tables of rosbag2_storage_sqlite3, and messages in CDR.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fathom::testing {

// One row of the table of messages.
struct DatabaseMessage {
    std::string topic, type; // type as ROS 2 has it: package/msg/Name
    int64_t time = 0;        // [ns]
    std::string bytes;
};

// An existing file is replaced.
void writeDatabase(const std::filesystem::path& file, const std::vector<DatabaseMessage>& messages);
// Each as a zstd frame.
std::vector<DatabaseMessage> packedOneByOne(std::vector<DatabaseMessage> messages);

std::string textCdr(const std::string& text); // std_msgs/msg/String
struct CdrImage {
    std::string frame, encoding;
    uint32_t width = 0, height = 0, step = 0;
    std::string pixels;
};
std::string imageCdr(int64_t time, const CdrImage& image); // sensor_msgs/msg/Image

} // namespace fathom::testing
