// SPDX-License-Identifier: Apache-2.0
// The newest messages of live topics, in the form in which streams and lenses of recordings are chosen.
#pragma once

#include "devices/bag/message_file.h"
#include "devices/ros2/raw_message.h"

#include <vector>

namespace fathom {

// One thread.
class NewestMessages final : public MessageFile {
public:
    // name: of the source, for messages.
    explicit NewestMessages(std::string name)
        : MessageFile(std::move(name)) {}

    // Appends a topic without messages. The topic's newest `most` messages are kept. Returns its place.
    size_t add(const std::string& topic, const std::string& type, size_t most);
    void keep(size_t topic, RawMessagePtr message);
    MessageBytes bytes(const MessageEntry& entry) override {
        const RawMessagePtr& message = kept_[entry.chunk][entry.offset];
        return {message->bytes(), message};
    }

private:
    std::vector<std::vector<RawMessagePtr>> kept_; // per topic, oldest first
    std::vector<size_t> most_;
};

} // namespace fathom
