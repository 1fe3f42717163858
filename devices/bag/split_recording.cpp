// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/split_recording.h"

#include "engine/types/error.h"

#include <tuple>

namespace fathom {

namespace {

namespace fs = std::filesystem;

constexpr unsigned kTopicBits = 40; // an entry's offset: topic of its file, and message of that topic

// "rec_10.mcap" after "rec_9.mcap".
std::tuple<size_t, std::string> fileOrder(const fs::path& file) {
    const std::string stem = file.stem().string();
    const size_t digit = stem.find_last_not_of("0123456789") + 1;
    return {stem.size() - digit, stem};
}

std::vector<fs::path> filesOf(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code failed;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
        if (entry.path().filename().string().starts_with('.')) { // of an archive of macOS
            continue;
        }
        const std::string ending = entry.path().extension().string();
        if (ending == ".zstd") {
            throw BadInput(entry.path().string(), "compression", "of the whole file",
                           "files without it: zstd -d, or ros2 bag convert");
        }
        if (ending == ".mcap" || ending == ".db3") {
            files.push_back(entry.path());
        }
    }
    if (files.empty()) {
        throw BadInput(folder.string(), "files", "none", "metadata.yaml with .mcap or .db3 files");
    }
    std::sort(files.begin(), files.end(),
              [](const auto& a, const auto& b) { return fileOrder(a) < fileOrder(b); });
    return files;
}

} // namespace

SplitRecording::SplitRecording(const fs::path& folder)
    : MessageFile(folder) {
    for (const fs::path& file : filesOf(folder)) {
        files_.push_back(openMessageFile(file));
        const std::vector<MessageTopic>& parts = files_.back()->topics();
        for (uint64_t t = 0; t < parts.size(); ++t) {
            MessageTopic& whole = topics_[topicAt(parts[t].name, parts[t].type, parts[t].cdr)];
            for (uint64_t i = 0; i < parts[t].messages.size(); ++i) {
                whole.messages.push_back({parts[t].messages[i].time, files_.size() - 1, t << kTopicBits | i});
            }
        }
    }
    sortByTime();
}

MessageBytes SplitRecording::bytes(const MessageEntry& entry) {
    MessageFile& file = *files_[entry.chunk];
    const MessageTopic& topic = file.topics()[entry.offset >> kTopicBits];
    return file.bytes(topic.messages[entry.offset & ((uint64_t{1} << kTopicBits) - 1)]);
}

} // namespace fathom
