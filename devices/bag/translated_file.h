// SPDX-License-Identifier: Apache-2.0
// A file of messages in which a camera maker's own messages are replaced by those of ROS.
#pragma once

#include "devices/bag/message_file.h"
#include "engine/types/error.h"

namespace fathom {

// Has the topics of the original, and those that are added. One thread.
class TranslatedFile : public MessageFile {
public:
    MessageBytes bytes(const MessageEntry& entry) override;

protected:
    using Bytes = std::vector<uint8_t>; // of a message in CDR

    explicit TranslatedFile(std::unique_ptr<MessageFile> original);
    // The messages of a topic become those of the type, each make(message). One for which make() throws Error
    // is skipped and named in the log. Throws Error when there are more than 10,000.
    template <class Make>
    void replace(MessageTopic& topic, const std::string& type, Make&& make) {
        const std::vector<MessageEntry> entries = begin(topic, type);
        for (const MessageEntry& entry : entries) {
            try {
                put(topic, entry.time, make(MessageCursor(original_->bytes(entry), topic.cdr)));
            } catch (const Error& e) {
                logSkipped(topic, e);
            }
        }
        topic.cdr = true;
    }
    // A new topic with one message.
    void add(const std::string& topic, const std::string& type, Bytes message);

private:
    // Checks the number of messages and takes them out.
    static std::vector<MessageEntry> begin(MessageTopic& topic, const std::string& type);
    void put(MessageTopic& topic, uint64_t time, Bytes message);
    void logSkipped(const MessageTopic& topic, const Error& why);

    std::unique_ptr<MessageFile> original_;
    std::vector<Bytes> made_;
};

} // namespace fathom
