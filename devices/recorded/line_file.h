// SPDX-License-Identifier: Apache-2.0
// A text file that is extended by whole lines.
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>

namespace fathom {

// Buffers lines until flush() writes them in one piece: a killed process leaves whole lines, and a full disk
// leaves those that fitted. One thread.
class LineFile {
public:
    // header: first line; empty = none. Throws Error that names the file when it cannot be written.
    void open(const std::filesystem::path& file, const char* header = "");
    bool isOpen() const { return out_.is_open(); }
    uintmax_t size() const { return size_; }   // [bytes] of whole lines in the file
    std::ostream& lines() { return waiting_; } // 17 digits
    // Throws Error when not all lines fit, and removes the partial line. No effect when no file is open.
    void flush();
    void close(); // as flush()

private:
    std::filesystem::path name_;
    std::ofstream out_;
    std::ostringstream waiting_;
    uintmax_t size_ = 0; // [bytes] of whole lines in the file
};

} // namespace fathom
