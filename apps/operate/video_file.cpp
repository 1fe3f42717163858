// SPDX-License-Identifier: Apache-2.0
#include "apps/operate/video_file.h"

#include "engine/types/error.h"
#include "engine/types/number_text.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <span>
#include <spawn.h>
#include <sstream>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

extern char** environ;

namespace fathom::operate {

namespace fs = std::filesystem;

namespace {

std::vector<std::string> encoderArguments(const fs::path& encoder, const fs::path& file,
                                          const std::string& size) {
    return {encoder.string(),
            "-hide_banner",
            "-loglevel",
            "error",
            "-y",
            "-f",
            "rawvideo",
            "-pix_fmt",
            "bgra",
            "-s",
            size,
            "-r",
            "30",
            "-i",
            "pipe:0",
            "-vf",
            "pad=ceil(iw/2)*2:ceil(ih/2)*2",
            "-pix_fmt",
            "yuv420p",
            file.string()};
}

} // namespace

std::optional<fs::path> findEncoder() {
    const char* places = std::getenv("PATH");
    std::istringstream in(places == nullptr ? "" : places);
    for (std::string folder; std::getline(in, folder, ':');) {
        const fs::path program = fs::path(folder) / "ffmpeg";
        if (!folder.empty() && ::access(program.c_str(), X_OK) == 0) {
            return program;
        }
    }
    return std::nullopt;
}

// A socket, not a pipe: writing to an encoder that has ended must not raise SIGPIPE.
VideoFile::VideoFile(const fs::path& encoder, const fs::path& file, int width, int height)
    : file_(file)
    , width_(width)
    , height_(height) {
    std::vector<std::string> words = encoderArguments(encoder, file, sizeText(width, height));
    std::vector<char*> argv;
    for (std::string& word : words) {
        argv.push_back(word.data());
    }
    argv.push_back(nullptr);
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        throw Error(file_.string() + ": no socket for ffmpeg (" + std::strerror(errno) + ")");
    }
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, ends[1], 0);
    ::posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
    const int failed = ::posix_spawn(&encoder_, encoder.c_str(), &actions, nullptr, argv.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(ends[1]);
    socket_ = ends[0];
    if (failed != 0) {
        encoder_ = -1;
        ::close(std::exchange(socket_, -1));
        throw Error(encoder.string() + ": cannot be started (" + std::strerror(failed) + ")");
    }
}

VideoFile::~VideoFile() {
    try {
        finish();
    } catch (const Error&) { // the export has reported its own failure
    }
}

void VideoFile::add(const Image& image) {
    if (image.width() != width_ || image.height() != height_) {
        throw Error("the images' size changed from " + sizeText(width_, height_) + " to " +
                    sizeText(image.width(), image.height()) + ", which a video cannot");
    }
    image.beginPixels();
    for (int v = 0; v < image.height(); ++v) {
        std::span<const std::byte> rest =
            std::as_bytes(std::span(image.row(v), static_cast<size_t>(image.width())));
        while (!rest.empty()) {
            const ssize_t sent = ::send(socket_, rest.data(), rest.size(), MSG_NOSIGNAL);
            if (sent < 0 && errno != EINTR) {
                throw Error(file_.string() + ": ffmpeg has ended before the video");
            }
            rest = rest.subspan(sent < 0 ? 0 : static_cast<size_t>(sent));
        }
    }
    image.endPixels();
}

void VideoFile::finish() {
    if (socket_ >= 0) {
        ::close(std::exchange(socket_, -1));
    }
    if (encoder_ < 0) {
        return;
    }
    int status = 0;
    while (::waitpid(encoder_, &status, 0) < 0 && errno == EINTR) {
    }
    encoder_ = -1;
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0) {
        throw Error(file_.string() + ": ffmpeg could not write it");
    }
}

} // namespace fathom::operate
