// SPDX-License-Identifier: Apache-2.0
// The folder of --out: locked by one program at a time.
#pragma once

#include <filesystem>
#include <vector>

namespace fathom {

// Creates the folder where it is missing; true = it was. Throws BadInput when it is a file or cannot be made.
bool makeOutputFolder(const std::filesystem::path& folder);

// Holds the folder for this process. The kernel ends the lock with the process, however it ends, so a lock
// file that was left behind does not count.
class OutputLock {
public:
    // Creates the folder as makeOutputFolder(). Throws BadInput while another process holds it and when it
    // must not be written, Error for other failures such as a full disk.
    explicit OutputLock(const std::filesystem::path& folder);
    OutputLock(OutputLock&& other) noexcept;
    OutputLock& operator=(OutputLock&&) = delete;
    ~OutputLock(); // removes the lock file, and the folder if it is new and still empty

private:
    std::filesystem::path file_;
    bool made_ = false; // the folder is new
    int descriptor_ = -1;
};

// Creates `folder` (and fixtures/ in it if requested), locks it and deletes the frame and fault files of an
// earlier replay, so that sets of two runs never mix. Only for a replay, which writes such files. Throws
// Error that names the folder.
OutputLock prepareReplayFolder(const std::filesystem::path& folder, bool withFixtures);

// The arm.csv that an earlier replay left in `folder`, for commitTogether() of a replay without an arm; a
// file of this name that no replay wrote is not listed.
std::vector<std::filesystem::path> outdatedArmFile(const std::filesystem::path& folder);

} // namespace fathom
