// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/image_export.h"

#include "apps/operate/unused_name.h"
#include "engine/types/error.h"
#include "engine/types/printed.h"

#include <utility>

namespace fathom::operate {

namespace fs = std::filesystem;

void ImageExport::start(Console& console) {
    encoder_ = findEncoder();
    target_ = unusedName(in_, "export", {"", ".mp4"});
    target_ += encoder_ ? ".mp4" : "";
    std::error_code failed;
    fs::create_directories(encoder_ ? target_.parent_path() : target_, failed);
    if (failed && !target_.parent_path().empty()) {
        console.notify(target_.string() + ": cannot be written (" + failed.message() + ")");
        return;
    }
    running_ = true;
    next_ = 0;
    before_ = console.timeLine.t;
    console.timeLine.playing = false;
    console.messages.noticeUntil = 0.0; // it would be in the images
}

void ImageExport::end(Console& console, const std::string& why) {
    running_ = false;
    std::string problem = why;
    try {
        if (video_) {
            std::exchange(video_, nullptr)->finish();
        }
    } catch (const Error& e) {
        problem = problem.empty() ? e.what() : problem;
    }
    console.timeLine.t = before_;
    console.notify(printed("exported %u images to ", next_) + target_.string() +
                   (encoder_ ? "" : ": no ffmpeg, so PNG files") +
                   (problem.empty() ? "" : ", then: " + problem));
}

void ImageExport::step(Console& console, double period) {
    TimeLine& line = console.timeLine;
    const bool pressed = std::exchange(console.requests.exportImages, false);
    if (!running_ && pressed) {
        start(console);
    } else if (running_ && (pressed || std::exchange(console.requests.stopExport, false))) {
        end(console, "stopped");
    } else if (running_ && next_ >= line.frames) {
        end(console, "");
    }
    console.requests.stopExport = false;
    if (running_) {
        line.playing = false;
        line.t = std::min(line.duration, next_ * period);
    }
}

void ImageExport::add(Console& console, const Image* image) {
    if (image == nullptr) {
        return; // not drawn: the next step() shows the same frame again
    }
    try {
        if (!encoder_) {
            image->writePng(target_ / printed("%06u.png", next_));
        } else {
            if (!video_) {
                video_ = std::make_unique<VideoFile>(*encoder_, target_, image->width(), image->height());
            }
            video_->add(*image);
        }
        ++next_;
    } catch (const Error& e) {
        end(console, e.what());
    }
}

} // namespace fathom::operate
