// SPDX-License-Identifier: Apache-2.0
// An MP4 file, encoded by the program ffmpeg where it is installed (Debian: ffmpeg).
#pragma once

#include "apps/output/image.h"

#include <filesystem>
#include <optional>
#include <sys/types.h>

namespace fathom::operate {

// Path of the program in PATH; empty when it is not installed.
std::optional<std::filesystem::path> findEncoder();

// One thread. Images of one size, at 30 per second.
class VideoFile {
public:
    // Starts the encoder. Throws Error when that fails.
    VideoFile(const std::filesystem::path& encoder, const std::filesystem::path& file, int width, int height);
    ~VideoFile(); // as finish(), but ignores failures
    VideoFile(const VideoFile&) = delete;
    VideoFile& operator=(const VideoFile&) = delete;

    // Waits while the encoder is busy. Throws Error when it has ended, or for an image of another size.
    void add(const Image& image);
    // Waits for the encoder. Throws Error when it has failed.
    void finish();

private:
    std::filesystem::path file_;
    int width_, height_; // [pixels]
    int socket_ = -1;
    pid_t encoder_ = -1;
};

} // namespace fathom::operate
