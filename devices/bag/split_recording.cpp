// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/split_recording.h"

#include "devices/images/depth_image.h"
#include "devices/recorded/text_file.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/read_file.h"
#include "engine/types/yaml_document.h"

#include <algorithm>
#include <array>
#include <optional>
#include <tuple>

namespace fathom {

namespace {

namespace fs = std::filesystem;

constexpr const char* kMetadata = "metadata.yaml";
constexpr const char* kBagInformation = "rosbag2_bagfile_information";
constexpr unsigned kTopicBits = 40; // an entry's offset: topic of its file, and message of that topic

// "rec_10.mcap" after "rec_9.mcap".
std::tuple<size_t, std::string> fileOrder(const fs::path& file) {
    const std::string stem = file.stem().string();
    const size_t digit = stem.find_last_not_of("0123456789") + 1;
    return {stem.size() - digit, stem};
}

constexpr std::array<std::string_view, 2> kMessageEndings{".mcap", ".db3"};
constexpr std::array<std::string_view, 1> kPackedEnding{".zstd"};

bool isPacked(const fs::path& file) {
    return endsAs(file, kPackedEnding);
}

[[noreturn]] void refusePacked(const fs::path& file) {
    throw BadInput(file.string(), "compression", "of the whole file",
                   "files without it: zstd -d, or ros2 bag convert");
}

// Files of messages in the folder, packed or not, that are not hidden as those of an archive of macOS.
std::vector<fs::path> messageFiles(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code failed;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, failed)) {
        const fs::path& file = entry.path();
        if (!file.filename().string().starts_with('.') && (endsAs(file, kMessageEndings) || isPacked(file))) {
            files.push_back(file);
        }
    }
    std::ranges::sort(files, [](const auto& a, const auto& b) { return fileOrder(a) < fileOrder(b); });
    return files;
}

// relative_file_paths of metadata.yaml, each once and in the folder: versions before 4 write
// "folder/folder_0.db3". None where the file has no such list or is damaged.
std::vector<fs::path> listedFiles(const fs::path& folder) {
    const fs::path metadata = folder / kMetadata;
    std::vector<fs::path> files;
    try {
        const YAML::Node root = onlyYamlDocument(metadata.string(), readTextFile(metadata));
        for (const YAML::Node& name : root[kBagInformation]["relative_file_paths"]) {
            const fs::path file = folder / fs::path(name.as<std::string>()).filename();
            if (file.has_filename() && std::ranges::find(files, file) == files.end()) {
                files.push_back(file);
            }
        }
    } catch (const YAML::Exception& e) {
        log::warn("{}: {}: all files of the folder are played", metadata.string(), e.what());
        files.clear();
    }
    return files;
}

// The listed file, or the same without compression. A file that is only there packed is refused.
std::optional<fs::path> presentFile(const fs::path& listed) {
    const fs::path plain = isPacked(listed) ? fs::path(listed).replace_extension() : listed;
    if (fs::exists(plain)) {
        return plain;
    }
    const fs::path packed = plain.string() + std::string(kPackedEnding[0]);
    if (fs::exists(packed)) {
        refusePacked(packed);
    }
    return std::nullopt;
}

// All files of the folder, of one kind.
std::vector<fs::path> unlistedFiles(const fs::path& folder, const std::vector<fs::path>& files) {
    if (files.empty()) {
        throw BadInput(folder.string(), "files", "none", "metadata.yaml with .mcap or .db3 files");
    }
    if (const auto packed = std::ranges::find_if(files, isPacked); packed != files.end()) {
        refusePacked(*packed);
    }
    for (const fs::path& file : files) {
        if (endingOf(file) != endingOf(files.front())) {
            throw BadInput(folder.string(), "files",
                           files.front().filename().string() + " and " + file.filename().string(),
                           "files of one kind, or a metadata.yaml that lists those of the recording");
        }
    }
    return files;
}

// Names a folder's files that its metadata.yaml does not list.
void logUnlisted(const fs::path& folder, const std::vector<fs::path>& there,
                 const std::vector<fs::path>& listed) {
    std::string others;
    for (const fs::path& file : there) {
        if (std::ranges::find(listed, file) == listed.end()) {
            others += (others.empty() ? "" : ", ") + file.filename().string();
        }
    }
    if (!others.empty()) {
        log::warn("{}: not played, as metadata.yaml does not list it: {}", folder.string(), others);
    }
}

} // namespace

bool isRos2Recording(const fs::path& folder) {
    if (!fs::exists(folder / kMetadata)) {
        return false;
    }
    return !messageFiles(folder).empty() ||
           readTextFile(folder / kMetadata).find(kBagInformation) != std::string::npos;
}

SplitRecording::SplitRecording(const fs::path& folder)
    : MessageFile(folder) {
    std::string first;
    for (const fs::path& file : chooseFiles()) {
        try {
            add(openMessageFile(file));
        } catch (const BadInput& e) { // a part that is damaged does not lose the others
            first = first.empty() ? e.what() : first;
            warn(std::string("a part is not played: ") + e.what());
        }
    }
    if (files_.empty()) {
        throw BadInput(first);
    }
    sortByTime();
}

// Those that metadata.yaml lists. If none of them is there, their names were changed: all of the folder.
std::vector<fs::path> SplitRecording::chooseFiles() {
    const std::vector<fs::path> there = messageFiles(file()), listed = listedFiles(file());
    std::vector<fs::path> chosen;
    for (const fs::path& part : listed) {
        if (const auto present = presentFile(part)) {
            chosen.push_back(*present);
        } else {
            warn("metadata.yaml lists " + part.filename().string() + ", which is missing");
        }
    }
    if (chosen.empty()) {
        return unlistedFiles(file(), there);
    }
    logUnlisted(file(), there, chosen);
    return chosen;
}

void SplitRecording::add(std::unique_ptr<MessageFile> file) {
    files_.push_back(std::move(file));
    for (const std::string& warning : files_.back()->warnings()) {
        warnings_.push_back(files_.back()->file().filename().string() + ": " + warning);
    }
    const std::vector<MessageTopic>& parts = files_.back()->topics();
    for (uint64_t t = 0; t < parts.size(); ++t) {
        MessageTopic& whole = topics_[topicAt(parts[t].name, parts[t].type, parts[t].cdr)];
        for (uint64_t i = 0; i < parts[t].messages.size(); ++i) {
            whole.messages.push_back({parts[t].messages[i].time, files_.size() - 1, t << kTopicBits | i});
        }
    }
}

MessageBytes SplitRecording::bytes(const MessageEntry& entry) {
    MessageFile& file = *files_[entry.chunk];
    const MessageTopic& topic = file.topics()[entry.offset >> kTopicBits];
    return file.bytes(topic.messages[entry.offset & ((uint64_t{1} << kTopicBits) - 1)]);
}

} // namespace fathom
