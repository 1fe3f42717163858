// SPDX-License-Identifier: Apache-2.0
#include "apps/replay/output_file.h"

#include "engine/types/error.h"
#include "engine/types/replaceable.h"

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <unistd.h>
#include <utility>

namespace fathom {

namespace {

constexpr size_t kBufferBytes = size_t{1} << 20;

bool isFixtureFile(const std::filesystem::path& file) {
    const std::string stem = file.stem().string();
    return file.extension() == ".ply" && stem.size() >= 6 &&
           std::all_of(stem.begin(), stem.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

// Left by FaultTrace in an earlier run.
bool isFaultFile(const std::filesystem::path& file) {
    constexpr std::string_view kStart = "fault-";
    const std::string stem = file.stem().string();
    return file.extension() == ".csv" && stem.size() > kStart.size() &&
           stem.compare(0, kStart.size(), kStart) == 0 &&
           stem.find_first_not_of("0123456789.", kStart.size()) == std::string::npos;
}

void removeAll(const std::filesystem::path& folder, bool (*wanted)(const std::filesystem::path&)) {
    std::vector<std::filesystem::path> old;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (wanted(entry.path())) {
            old.push_back(entry.path());
        }
    }
    for (const auto& file : old) {
        std::filesystem::remove(file);
    }
}

} // namespace

OutputFile::OutputFile(std::filesystem::path path)
    : path_(std::move(path))
    , temporary_(path_) {
    if (!isReplaceable(path_)) {
        throw Error(path_.string() + ": cannot replace: a folder, a device or a pipe");
    }
    temporary_ += ".partial";
    descriptor_ = ::open(temporary_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor_ < 0) {
        fail("cannot create");
    }
    buffer_.reserve(kBufferBytes);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : path_(std::move(other.path_))
    , temporary_(std::move(other.temporary_))
    , descriptor_(std::exchange(other.descriptor_, -1))
    , buffer_(std::move(other.buffer_)) {}

OutputFile::~OutputFile() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
        ::unlink(temporary_.c_str());
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

void OutputFile::commit() {
    flush();
    // A network file system reports a full disk at close(). No retry: the descriptor is closed either way.
    if (::close(std::exchange(descriptor_, -1)) != 0 || ::rename(temporary_.c_str(), path_.c_str()) != 0) {
        const int reason = errno;
        ::unlink(temporary_.c_str());
        errno = reason;
        fail("cannot write");
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

void prepareOutputFolder(const std::filesystem::path& folder, bool withFixtures) {
    const std::filesystem::path fixtures = folder / "fixtures";
    try {
        std::filesystem::create_directories(withFixtures ? fixtures : folder);
        removeAll(folder, isFaultFile);
        if (std::filesystem::is_directory(fixtures)) {
            removeAll(fixtures, isFixtureFile);
        }
    } catch (const std::filesystem::filesystem_error& error) {
        throw Error(folder.string() + ": cannot use as output folder: " + error.code().message());
    }
}

} // namespace fathom
