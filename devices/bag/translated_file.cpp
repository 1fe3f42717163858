// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/translated_file.h"

#include "engine/types/log.h"

namespace fathom {

namespace {

constexpr uint64_t kMadeChunk = UINT64_MAX; // no original has one of this number
constexpr size_t kMaxTranslated = 10'000;   // messages of one topic

} // namespace

TranslatedFile::TranslatedFile(std::unique_ptr<MessageFile> original)
    : MessageFile(original->file())
    , original_(std::move(original)) {
    topics_ = original_->topics();
    warnings_ = original_->warnings();
}

MessageBytes TranslatedFile::bytes(const MessageEntry& entry) {
    return entry.chunk == kMadeChunk ? MessageBytes{made_[entry.offset], nullptr} : original_->bytes(entry);
}

std::vector<MessageEntry> TranslatedFile::begin(MessageTopic& topic, const std::string& type) {
    if (topic.messages.size() > kMaxTranslated) {
        throw Error(topic.name + ": " + std::to_string(topic.messages.size()) +
                    " messages (allowed: at most " + std::to_string(kMaxTranslated) + ")");
    }
    topic.type = type;
    return std::exchange(topic.messages, {});
}

void TranslatedFile::put(MessageTopic& topic, uint64_t time, Bytes message) {
    made_.push_back(std::move(message));
    topic.messages.push_back({time, kMadeChunk, made_.size() - 1});
}

void TranslatedFile::add(const std::string& topic, const std::string& type, Bytes message) {
    MessageTopic& added = topics_[topicAt(topic, type, true)];
    added = {topic, type, {}, true}; // also where the original has one of this name
    put(added, 0, std::move(message));
}

void TranslatedFile::logSkipped(const MessageTopic& topic, const Error& why) {
    faults_.emplace(topic.name, why.what());
    log::warn("{}: a message of {} is skipped: {}", file().string(), topic.name, why.what());
}

} // namespace fathom
