// SPDX-License-Identifier: Apache-2.0
#include "engine/model/reader_pipe.h"

#include <algorithm>
#include <cerrno>

#include <poll.h>
#include <unistd.h>

namespace fathom {

namespace {

constexpr uint64_t kMaxText = 4096;

} // namespace

bool writeAll(int pipe, const void* data, size_t size) {
    const auto* at = static_cast<const char*>(data);
    while (size > 0) {
        const ssize_t done = ::write(pipe, at, size);
        if (done < 0 && errno == EINTR) {
            continue;
        }
        if (done <= 0) {
            return false;
        }
        at += done;
        size -= static_cast<size_t>(done);
    }
    return true;
}

bool writeText(int pipe, const std::string& text) {
    const uint64_t size = std::min<uint64_t>(text.size(), kMaxText);
    return writeAll(pipe, &size, sizeof size) && writeAll(pipe, text.data(), size);
}

// Waits for bytes or the end; false once the time is over.
bool ReaderPipe::await() {
    for (;;) {
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(until_ - Time::clock::now()).count();
        pollfd wanted{pipe_, POLLIN, 0};
        const int found =
            left > 0 ? ::poll(&wanted, 1, static_cast<int>(std::min<int64_t>(left, 60'000))) : 0;
        late_ = left <= 0;
        if (found > 0 || late_) {
            return !late_;
        }
    }
}

bool ReaderPipe::read(void* data, size_t size) {
    auto* at = static_cast<char*>(data);
    while (size > 0) {
        if (!await()) {
            return false;
        }
        const ssize_t done = ::read(pipe_, at, size);
        if (done < 0 && errno == EINTR) {
            continue;
        }
        ended_ = done <= 0;
        if (ended_) {
            return false;
        }
        at += done;
        size -= static_cast<size_t>(done);
    }
    return true;
}

bool ReaderPipe::readText(std::string& text) {
    uint64_t size = 0;
    if (!read(&size, sizeof size) || size > kMaxText) {
        return false;
    }
    text.resize(size);
    return read(text.data(), size);
}

} // namespace fathom
