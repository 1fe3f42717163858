// SPDX-License-Identifier: Apache-2.0
#include "engine/types/output_file.h"

#include "engine/types/error.h"
#include "engine/types/input_files.h"
#include "engine/types/replaceable.h"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <utility>

namespace fathom {

namespace {

constexpr size_t kBufferBytes = size_t{1} << 20;

void removeOld(const std::filesystem::path& file, const char* purpose) {
    if (::unlink(file.c_str()) != 0 && errno != ENOENT) {
        const char* reason = std::strerror(errno);
        throw Error(file.string() + ": cannot " + purpose + ": " + reason);
    }
}

} // namespace

bool isOpenAs(int descriptor, const std::filesystem::path& name) noexcept {
    struct stat open {
    }, named{};
    return ::fstat(descriptor, &open) == 0 && ::lstat(name.c_str(), &named) == 0 &&
           open.st_dev == named.st_dev && open.st_ino == named.st_ino;
}

OutputFile::OutputFile(std::filesystem::path path, Replaces replaces)
    : path_(std::move(path))
    , temporary_(path_)
    , replaces_(replaces) {
    if (!isReplaceable(path_)) {
        throw Error(path_.string() + ": cannot replace: a folder, a device or a pipe");
    }
    refuseReplacing();
    temporary_ += ".partial";
    refuseInput(temporary_);
    ::unlink(temporary_.c_str()); // left by a killed run, or a link, which must not be followed
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0644);
    if (descriptor_ < 0) {
        fail("cannot create");
    }
    buffer_.reserve(kBufferBytes);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_))
    , temporary_(std::move(other.temporary_))
    , replaces_(other.replaces_)
    , descriptor_(std::exchange(other.descriptor_, -1))
    , buffer_(std::move(other.buffer_)) {}

OutputFile::~OutputFile() {
    if (descriptor_ >= 0) {
        if (isOpenAs(descriptor_, temporary_)) {
            ::unlink(temporary_.c_str());
        }
        ::close(descriptor_);
    }
}

void OutputFile::write(const void* bytes, size_t count) {
    if (buffer_.size() + count > kBufferBytes) {
        flush();
    }
    const char* first = static_cast<const char*>(bytes);
    if (count > kBufferBytes) {
        writeAll(first, count);
    } else {
        buffer_.insert(buffer_.end(), first, first + count);
    }
}

void OutputFile::complete() {
    refuseReplacing(); // also a file that was read since
    flush();
    if (!isOpenAs(descriptor_, temporary_)) {
        ::close(std::exchange(descriptor_, -1));
        throw Error(path_.string() + ": cannot write: another program writes the same file");
    }
    // A network file system reports a full disk at close(), also of a duplicate.
    if (const int duplicate = ::dup(descriptor_); duplicate >= 0 && ::close(duplicate) != 0) {
        fail("cannot write");
    }
}

void OutputFile::commit() {
    complete();
    // No retry: the descriptor is closed either way.
    if (::close(std::exchange(descriptor_, -1)) != 0 || ::rename(temporary_.c_str(), path_.c_str()) != 0) {
        const int reason = errno;
        ::unlink(temporary_.c_str());
        errno = reason;
        fail("cannot write");
    }
}

void OutputFile::refuseReplacing() const {
    if (replaces_ == Replaces::NoInput) {
        refuseInput(path_);
    }
}

void OutputFile::flush() {
    writeAll(buffer_.data(), buffer_.size());
    buffer_.clear();
}

void OutputFile::writeAll(const char* bytes, size_t count) {
    if (descriptor_ < 0) {
        errno = EBADF;
        fail("cannot write");
    }
    while (count > 0) {
        const ssize_t written = ::write(descriptor_, bytes, count);
        if (written < 0 && errno == EINTR) {
            continue;
        }
        if (written <= 0) {
            fail("cannot write");
        }
        bytes += written;
        count -= static_cast<size_t>(written);
    }
}

void OutputFile::fail(const char* what) const {
    throw Error(path_.string() + ": " + what + ": " + std::strerror(errno));
}

void commitTogether(std::span<OutputFile* const> files, std::span<const std::filesystem::path> outdated) {
    for (OutputFile* file : files) {
        file->complete();
    }
    if (!files.empty()) {
        removeOld(files.back()->path(), "replace");
    }
    for (const std::filesystem::path& file : outdated) {
        removeOld(file, "remove");
    }
    for (OutputFile* file : files) {
        file->commit();
    }
}

} // namespace fathom
