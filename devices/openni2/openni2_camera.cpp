// SPDX-License-Identifier: Apache-2.0
#include "devices/openni2/openni2_camera.h"

#include "devices/openni2/open_openni2.h"
#include "devices/recorded/recording_intrinsics.h"
#include "engine/types/clock.h"
#include "engine/types/error.h"
#include "engine/types/log.h"
#include "engine/types/number_text.h"
#include "engine/types/stand_in.h"

#include <chrono>
#include <cmath>
#include <cstring>
#include <sstream>
#include <thread>

namespace fathom {

namespace {

constexpr int kSilenceMs = 2000;
// Of the library's player thread, to end what it does to a stopped stream, also on a busy machine.
constexpr auto kPlayerPause = std::chrono::milliseconds(200);

bool isDepth(openni::PixelFormat format) {
    return format == openni::PIXEL_FORMAT_DEPTH_1_MM || format == openni::PIXEL_FORMAT_DEPTH_100_UM;
}

// Largest resolution first, then the highest rate.
template <class Wanted>
std::optional<openni::VideoMode> bestMode(const openni::VideoStream& stream, const Wanted& wanted) {
    const auto& modes = stream.getSensorInfo().getSupportedVideoModes();
    std::optional<openni::VideoMode> best;
    const auto worth = [](const openni::VideoMode& m) {
        return m.getResolutionX() * m.getResolutionY() * 1000 + m.getFps();
    };
    for (int i = 0; i < modes.getSize(); ++i) {
        if (wanted(modes[i]) && (!best || worth(modes[i]) > worth(*best))) {
            best = modes[i];
        }
    }
    return best;
}

} // namespace

void refuseOpenNi2(const std::string& uri, const std::string& field, const std::string& allowed) {
    std::string why = standInOf(uri).empty() ? openni::OpenNI::getExtendedError() : standInOf(uri);
    const size_t first = why.find_first_not_of(" \t\r\n"), last = why.find_last_not_of(" \t\r\n");
    why = first == std::string::npos ? "" : why.substr(first, last - first + 1);
    throw BadInput(uri.empty() ? "openni2" : uri, field, why.empty() ? "not to be had" : why, allowed);
}

OpenNi2Camera::Library::Library() {
    if (openni::OpenNI::initialize() != openni::STATUS_OK) {
        refuseOpenNi2("", "OpenNI2", "its drivers installed");
    }
}

OpenNi2Camera::Library::~Library() {
    openni::OpenNI::shutdown();
}

OpenNi2Camera::OpenNi2Camera(const std::string& uri, const std::filesystem::path& intrinsics,
                             bool registered) {
    open(uri);
    openDepth();
    openColour(registered);
    readLens(intrinsics);
    slots_.emplace(info_.slotPixels(), info_.hasColour, kFramesInFlight + 2);
    if (file_) {
        // Without repeat, the library's thread would spin at the end of the file.
        device_.getPlaybackControl()->setRepeatEnabled(true);
        device_.getPlaybackControl()->setSpeed(-1.0f); // frames on request
    }
    if (depth_.stream.start() != openni::STATUS_OK ||
        (hasColour_ && colour_.stream.start() != openni::STATUS_OK)) {
        refuseOpenNi2(uri, "stream", "a device that no other program uses");
    }
}

OpenNi2Camera::~OpenNi2Camera() {
    for (Stream* s : {&depth_, &colour_}) {
        s->newest.release();
        s->stream.stop();
    }
    if (file_) { // its player iterates the stream list without a lock, every 10 ms while all streams are
                 // stopped
        std::this_thread::sleep_for(kPlayerPause);
    }
    for (Stream* s : {&depth_, &colour_}) {
        s->stream.destroy();
    }
    device_.close();
}

void OpenNi2Camera::open(const std::string& uri) {
    if (device_.open(uri.empty() ? openni::ANY_DEVICE : uri.c_str()) != openni::STATUS_OK) {
        refuseOpenNi2(uri, "device", "an OpenNI2 device that is plugged in and accessible, or an .oni file");
    }
    file_ = device_.isFile();
    name_ = file_ ? "recorded " + uri
                  : "openni2 " + std::string(device_.getDeviceInfo().getName()) + " " +
                        device_.getDeviceInfo().getUri();
}

void OpenNi2Camera::openDepth() {
    if (!device_.hasSensor(openni::SENSOR_DEPTH) ||
        depth_.stream.create(device_, openni::SENSOR_DEPTH) != openni::STATUS_OK) {
        refuseOpenNi2(name_, "depth", "a source with depth");
    }
    if (const auto mode = bestMode(depth_.stream, [](const auto& m) { return isDepth(m.getPixelFormat()); });
        mode && !file_) {
        depth_.stream.setVideoMode(*mode);
    }
    const openni::VideoMode mode = depth_.stream.getVideoMode();
    if (!isDepth(mode.getPixelFormat())) {
        throw BadInput(name_, "depth", "pixel format " + std::to_string(mode.getPixelFormat()),
                       "mm or 0.1 mm");
    }
    info_.metresPerUnit = mode.getPixelFormat() == openni::PIXEL_FORMAT_DEPTH_1_MM ? 0.001 : 0.0001;
    info_.depth.width = static_cast<uint32_t>(mode.getResolutionX());
    info_.depth.height = static_cast<uint32_t>(mode.getResolutionY());
    period_ = mode.getFps() > 0 ? 1.0 / mode.getFps() : period_;
    depth_.mirrored = depth_.stream.getMirroringEnabled();
    left_ = file_ ? device_.getPlaybackControl()->getNumberOfFrames(depth_.stream) : 0;
}

// Colour that the device does not register to depth is skipped, because OpenNI2 has no extrinsics.
void OpenNi2Camera::openColour(bool registered) {
    info_.hasColour = false;
    info_.poseless = true;
    if (!device_.hasSensor(openni::SENSOR_COLOR) ||
        colour_.stream.create(device_, openni::SENSOR_COLOR) != openni::STATUS_OK) {
        return;
    }
    const auto fits = [&](const openni::VideoMode& m) {
        return m.getPixelFormat() == openni::PIXEL_FORMAT_RGB888 &&
               static_cast<uint32_t>(m.getResolutionX()) == info_.depth.width &&
               static_cast<uint32_t>(m.getResolutionY()) == info_.depth.height;
    };
    if (!file_) {
        if (const auto mode = bestMode(colour_.stream, fits)) {
            colour_.stream.setVideoMode(*mode);
        }
        const auto wanted = openni::IMAGE_REGISTRATION_DEPTH_TO_COLOR;
        registered = device_.isImageRegistrationModeSupported(wanted) &&
                     device_.setImageRegistrationMode(wanted) == openni::STATUS_OK;
        device_.setDepthColorSyncEnabled(true);
    }
    if (!registered || !fits(colour_.stream.getVideoMode())) {
        log::warn("{}: colour is not used: {}", name_,
                  registered ? "not RGB of the depth's size" : "not known to be registered to depth");
        colour_.stream.destroy();
        return;
    }
    colour_.mirrored = colour_.stream.getMirroringEnabled();
    info_.hasColour = hasColour_ = true;
    info_.colourFormat = ColourFormat::Rgb;
}

void OpenNi2Camera::readLens(const std::filesystem::path& intrinsics) {
    if (!intrinsics.empty()) {
        const Intrinsics lens = readIntrinsics(intrinsics).camera.depth;
        if (lens.width != info_.depth.width || lens.height != info_.depth.height) {
            throw BadInput(intrinsics.string(), "width, height", sizeText(lens.width, lens.height),
                           "the image's " + sizeText(info_.depth.width, info_.depth.height));
        }
        info_.depth = info_.colour = lens;
        return;
    }
    const double across = static_cast<double>(depth_.stream.getHorizontalFieldOfView()),
                 down = static_cast<double>(depth_.stream.getVerticalFieldOfView());
    if (!(across > 0.01 && across < 3.0 && down > 0.01 && down < 3.0)) {
        throw BadInput(name_, "field of view", "unknown", "a device that reports it, or intrinsics=FILE");
    }
    Intrinsics& lens = info_.depth;
    lens.fx = 0.5 * lens.width / std::tan(0.5 * across);
    lens.fy = 0.5 * lens.height / std::tan(0.5 * down);
    lens.cx = 0.5 * lens.width;
    lens.cy = 0.5 * lens.height;
    info_.colour = lens;
}

bool OpenNi2Camera::readAny() {
    openni::VideoStream* streams[] = {&depth_.stream, &colour_.stream};
    int which = 0;
    if (openni::OpenNI::waitForAnyStream(streams, hasColour_ ? 2 : 1, &which, kSilenceMs) !=
        openni::STATUS_OK) {
        return false;
    }
    Stream& s = which == 0 ? depth_ : colour_;
    if (s.stream.readFrame(&s.newest) != openni::STATUS_OK || !s.newest.isValid()) {
        return false;
    }
    const uint64_t stamp = s.newest.getTimestamp();
    if (file_ && s.any && stamp <= s.stamp) { // the file restarts
        ended_ = true;
        return false;
    }
    s.stamp = stamp;
    s.fresh = s.any = true;
    if (which == 0) {
        --left_;
        const int number = s.newest.getFrameIndex();
        lost_ += !file_ && lastNumber_ >= 0 && number > lastNumber_ + 1
                     ? static_cast<uint64_t>(number - lastNumber_ - 1)
                     : 0;
        lastNumber_ = number;
    }
    return true;
}

bool OpenNi2Camera::paired() const {
    if (!depth_.fresh || !hasColour_) {
        return depth_.fresh;
    }
    const auto apart = static_cast<double>(depth_.newest.getTimestamp()) -
                       static_cast<double>(colour_.newest.isValid() ? colour_.newest.getTimestamp() : 0);
    return colour_.fresh && std::abs(apart) * 1e-6 <= 0.5 * period_;
}

std::optional<Frame> OpenNi2Camera::next() {
    const uint32_t before = skipped_.count();
    for (const auto called = std::chrono::steady_clock::now(); !paired();) {
        if (ended_ || (file_ && left_ <= 0 && !(hasColour_ && depth_.fresh))) {
            return std::nullopt;
        }
        if (depth_.fresh && colour_.fresh) {
            skipped_.add(name_, "its colour is over half a frame from its depth");
        }
        const std::chrono::duration<double> waited = std::chrono::steady_clock::now() - called;
        skipped_.limit(name_, before, file_ ? 0.0 : waited.count(), 1e-3 * kSilenceMs);
        if (!readAny()) {
            if (file_) {
                return std::nullopt;
            }
            throw DeviceLost(name_ + ": no frame for two seconds");
        }
    }
    return deliver();
}

Frame OpenNi2Camera::deliver() {
    FrameSlot* slot = &slots_->acquireFor(name_);
    const uint32_t width = info_.depth.width;
    for (uint32_t v = 0; v < info_.depth.height; ++v) {
        const auto* z =
            reinterpret_cast<const uint16_t*>(static_cast<const uint8_t*>(depth_.newest.getData()) +
                                              size_t{v} * depth_.newest.getStrideInBytes());
        uint16_t* to = slot->depth().data() + size_t{v} * width;
        for (uint32_t u = 0; u < width; ++u) {
            to[u] = z[depth_.mirrored ? width - 1 - u : u];
        }
        const auto* c = hasColour_ ? static_cast<const uint8_t*>(colour_.newest.getData()) +
                                         size_t{v} * colour_.newest.getStrideInBytes()
                                   : nullptr;
        std::byte* rgb = slot->colourBytes().data() + size_t{3} * v * width;
        for (uint32_t u = 0; c != nullptr && u < width; ++u, rgb += 3) {
            std::memcpy(rgb, c + size_t{3} * (colour_.mirrored ? width - 1 - u : u), 3);
        }
    }
    Frame::Content content;
    content.index = index_++;
    content.sourceNumber = static_cast<uint64_t>(depth_.newest.getFrameIndex());
    content.captureTime =
        file_ ? 1e-6 * static_cast<double>(depth_.newest.getTimestamp()) : monotonicSeconds();
    content.depth = slot->depth().first(info_.depth.pixels());
    if (hasColour_) {
        content.raw = {info_.colourFormat, width, info_.depth.height,
                       slot->colourBytes().first(info_.colourBytes())};
    }
    depth_.fresh = colour_.fresh = false;
    return slot->lend(content);
}

std::unique_ptr<Camera> openOpenNi2(const std::string& source) {
    std::istringstream words(source);
    std::string uri, option;
    std::getline(words, uri, ',');
    std::filesystem::path intrinsics;
    bool registered = false;
    const std::string kind = "openni2", lens = "intrinsics=";
    while (std::getline(words, option, ',')) {
        if (option.starts_with(lens)) {
            intrinsics = option.substr(lens.size());
        } else if (option == "registered=yes") {
            registered = true;
        } else {
            throw BadInput("--source", kind, option, "intrinsics=FILE, registered=yes");
        }
    }
    if (uri == kind || uri.starts_with(kind + ":")) {
        uri.erase(0, std::min(uri.size(), kind.size() + 1));
    }
    return std::make_unique<OpenNi2Camera>(uri, intrinsics, registered);
}

} // namespace fathom
