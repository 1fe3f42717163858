// SPDX-License-Identifier: Apache-2.0
// A text file that grows by whole lines.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>

namespace fathom {

// What is written is kept until flush(), which hands it over in one piece: a process that is killed leaves
// whole lines, and a disk that is full leaves those that had room. One thread.
class LineFile {
public:
    // With this first line; empty = none. Throws Error that names the file when it cannot be written.
    void open(const std::filesystem::path& file, const char* head = "");
    bool isOpen() const { return out_.is_open(); }
    std::ostream& lines() { return waiting_; } // 17 digits
    // Throws Error when not all lines had room; what was cut is taken back. Nothing where no file is open.
    void flush();
    void close(); // as flush()

private:
    std::filesystem::path name_;
    std::ofstream out_;
    std::ostringstream waiting_;
    uintmax_t size_ = 0; // [bytes] of whole lines in the file
};

} // namespace fathom
