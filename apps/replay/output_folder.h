// SPDX-License-Identifier: Apache-2.0
// The folder of --out: locked by one program at a time.
#pragma once

#include <filesystem>

namespace fathom {

// Holds the folder for this process. The kernel ends the lock with the process, however it ends, so a lock
// file that was left behind does not count.
class OutputLock {
public:
    // Creates the folder. Throws BadInput while another process holds it, Error when it cannot be written.
    explicit OutputLock(const std::filesystem::path& folder);
    OutputLock(OutputLock&& other) noexcept;
    OutputLock& operator=(OutputLock&&) = delete;
    ~OutputLock(); // removes the lock file

private:
    std::filesystem::path file_;
    int descriptor_ = -1;
};

// Creates `folder` (and fixtures/ in it if requested), locks it and deletes the frame and fault files of an
// earlier run, so that sets of two runs never mix. Throws Error that names the folder.
OutputLock prepareOutputFolder(const std::filesystem::path& folder, bool withFixtures);

} // namespace fathom
