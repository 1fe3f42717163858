// SPDX-License-Identifier: Apache-2.0
#include "devices/bag/file_bytes.h"

#include "engine/types/error.h"
#include "engine/types/read_file.h"

#include <cerrno>
#include <fcntl.h>
#include <string>
#include <unistd.h>

namespace fathom {

FileBytes::FileBytes(const std::filesystem::path& file)
    : file_(isRegularFile(file) ? ::open(file.c_str(), O_RDONLY | O_CLOEXEC) : -1) {
    std::error_code failed;
    size_ = open() ? std::filesystem::file_size(file, failed) : 0;
    size_ = failed ? 0 : size_;
}

FileBytes::~FileBytes() {
    if (open()) {
        ::close(file_);
    }
}

void FileBytes::readAhead(bool wanted) const {
    if (open()) {
        ::posix_fadvise(file_, 0, 0, wanted ? POSIX_FADV_NORMAL : POSIX_FADV_RANDOM); // advice: may fail
    }
}

void FileBytes::read(uint64_t at, std::span<uint8_t> to) {
    if (at > size_ || to.size() > size_ - at) {
        throw Error("truncated");
    }
    while (!to.empty()) {
        const ssize_t got = ::pread(file_, to.data(), to.size(), static_cast<off_t>(at));
        if (got < 0 && errno == EINTR) {
            continue;
        }
        if (got <= 0) { // an error of the disk, or the file became shorter
            throw Error("truncated");
        }
        to = to.subspan(static_cast<size_t>(got));
        at += static_cast<uint64_t>(got);
        read_ += static_cast<uint64_t>(got);
    }
}

std::vector<uint8_t> FileBytes::read(uint64_t at, uint64_t count, uint64_t most) {
    if (at > size_ || count > size_ - at || count > most) {
        throw Error("a record of " + std::to_string(count) + " bytes");
    }
    std::vector<uint8_t> bytes(count);
    read(at, bytes);
    return bytes;
}

} // namespace fathom
