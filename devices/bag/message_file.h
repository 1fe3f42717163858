// SPDX-License-Identifier: Apache-2.0
// A file of timed messages on topics: a ROS 1 bag, an MCAP file or a ROS 2 database.
#pragma once

#include "devices/bag/message_cursor.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace fathom {

// Location of one message. What chunk and offset mean is the file's affair.
struct MessageEntry {
    uint64_t time = 0; // [ns] when it was recorded
    uint64_t chunk = 0, offset = 0;
};

// One topic with all of its messages.
struct MessageTopic {
    std::string name, type;             // type as in ROS 1: package/Name
    std::vector<MessageEntry> messages; // in order of time
    bool cdr = false;                   // serialised as in ROS 2, else as in ROS 1
};

// One thread.
class MessageFile {
public:
    virtual ~MessageFile() = default;
    const std::vector<MessageTopic>& topics() const { return topics_; }
    // Null when there is no such topic.
    const MessageTopic* find(const std::string& name) const;
    // The serialised message. Throws Error.
    MessageCursor read(const MessageTopic& topic, size_t index) {
        return {bytes(topic.messages[index]), topic.cdr};
    }
    // What was wrong with a message of the topic when the file was opened; empty = nothing.
    std::string faultOf(const std::string& topic) const;
    const std::filesystem::path& file() const { return file_; }
    // Faults of the file as a whole that were logged when it was opened.
    const std::vector<std::string>& warnings() const { return warnings_; }
    virtual MessageBytes bytes(const MessageEntry& entry) = 0; // as read()

protected:
    explicit MessageFile(std::filesystem::path file)
        : file_(std::move(file)) {}
    // The topic's place in topics_; appended when new. "package/msg/Name" becomes "package/Name".
    size_t topicAt(const std::string& name, std::string type, bool cdr);
    void sortByTime();
    void warn(const std::string& warning); // logs a fault of the file, and adds it to warnings()

    std::vector<MessageTopic> topics_;
    std::map<std::string, std::string> faults_; // by topic
    std::vector<std::string> warnings_;

private:
    std::filesystem::path file_;
};

// By the file's name and first bytes; a folder is that of a ROS 2 recording (metadata.yaml). Throws BadInput.
std::unique_ptr<MessageFile> openMessageFile(const std::filesystem::path& file);

} // namespace fathom
