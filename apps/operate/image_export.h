// SPDX-License-Identifier: Apache-2.0
// Exports a recording as the window shows it, image by image: a video, or PNG files without an encoder.
#pragma once

#include "apps/operate/console.h"
#include "apps/operate/video_file.h"

#include <memory>

namespace fathom::operate {

// Window thread. While it runs, the window shows one frame of the recording after the other, and each is
// written once it is drawn.
class ImageExport {
public:
    // in: folder for the results.
    explicit ImageExport(std::filesystem::path in)
        : in_(std::move(in)) {}

    bool running() const { return running_; }
    // Before a frame is drawn: starts and ends as the console requests, and sets the shown moment.
    void step(Console& console, double period);
    // After it was drawn. image: null = none was drawn.
    void add(Console& console, const Image* image);

private:
    void start(Console& console);
    void end(Console& console, const std::string& why);

    std::filesystem::path in_, target_; // folder of the PNG files, or the video
    std::optional<std::filesystem::path> encoder_;
    std::unique_ptr<VideoFile> video_; // null: PNG files, or none yet
    bool running_ = false;
    uint32_t next_ = 0;   // frame to show
    double before_ = 0.0; // [s] the moment that was shown
};

} // namespace fathom::operate
