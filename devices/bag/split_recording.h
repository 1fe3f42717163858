// SPDX-License-Identifier: Apache-2.0
// A ROS 2 recording as a folder: metadata.yaml and one or more files, played as one.
#pragma once

#include "devices/bag/message_file.h"

namespace fathom {

// Whether a folder has a metadata.yaml of ROS 2, or any with .mcap or .db3 files, packed or not. Data sets of
// images may have a metadata.yaml of their own.
bool isRos2Recording(const std::filesystem::path& folder);

class SplitRecording final : public MessageFile {
public:
    // The files that metadata.yaml lists, in its order. A file that is missing or cannot be opened is logged
    // and among warnings(), others in the folder are logged. Without a list, or if none of its files is
    // there: all .mcap or all .db3 files that are not hidden, in order of the number that ends their name.
    // Throws BadInput when there are none, and for files that are compressed as a whole.
    explicit SplitRecording(const std::filesystem::path& folder);
    MessageBytes bytes(const MessageEntry& entry) override;

private:
    std::vector<std::filesystem::path> chooseFiles();
    void add(std::unique_ptr<MessageFile> file);

    std::vector<std::unique_ptr<MessageFile>> files_;
};

} // namespace fathom
