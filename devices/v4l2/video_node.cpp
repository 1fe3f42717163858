// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/video_node.h"

#include "devices/v4l2/video_ioctl.h"
#include "engine/types/error.h"
#include "engine/types/number_text.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <linux/videodev2.h>
#include <sys/ioctl.h>
#include <unistd.h>
#include <utility>

namespace fathom {

namespace {

namespace fs = std::filesystem;

std::string readWord(const fs::path& file) {
    std::ifstream in(file);
    std::string word;
    std::getline(in, word);
    return word;
}

uint16_t readHex(const fs::path& file) {
    return static_cast<uint16_t>(std::strtoul(readWord(file).c_str(), nullptr, 16));
}

template <size_t N>
std::string text(const uint8_t (&field)[N]) {
    const auto* characters = reinterpret_cast<const char*>(field);
    return {characters, strnlen(characters, N)};
}

} // namespace

std::string fourccName(uint32_t fourcc) {
    std::string name;
    for (int i = 0; i < 4; ++i) {
        const char c = static_cast<char>(fourcc >> (8 * i) & 0x7f);
        name += c >= ' ' && c < 0x7f ? c : '?';
    }
    name.erase(name.find_last_not_of(' ') + 1);
    return name;
}

std::string sizeName(VideoSize size) {
    return sizeText(size.width, size.height);
}

VideoNode::VideoNode(const fs::path& file)
    : file_(file) {
    descriptor_ = ::open(file.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (descriptor_ < 0) {
        throw BadInput(file.string(), "device", std::strerror(errno),
                       "a video device with read and write access (group video)");
    }
    v4l2_capability capability{};
    const bool known = control(VIDIOC_QUERYCAP, &capability) == 0;
    const uint32_t wanted = V4L2_CAP_VIDEO_CAPTURE | V4L2_CAP_STREAMING;
    if (!known || (capability.device_caps & wanted) != wanted) {
        ::close(std::exchange(descriptor_, -1));
        throw BadInput(file.string(), "device",
                       known ? "does not support streaming capture" : "not a video device",
                       "a V4L2 device that captures and streams");
    }
    card_ = text(capability.card);
    identify(text(capability.bus_info));
}

VideoNode::~VideoNode() {
    if (descriptor_ >= 0) {
        ::close(descriptor_);
    }
}

VideoNode::VideoNode(VideoNode&& other) noexcept
    : file_(std::move(other.file_))
    , usbFolder_(std::move(other.usbFolder_))
    , card_(std::move(other.card_))
    , identity_(std::move(other.identity_))
    , vendor_(other.vendor_)
    , product_(other.product_)
    , descriptor_(std::exchange(other.descriptor_, -1)) {}

VideoNode& VideoNode::operator=(VideoNode&& other) noexcept {
    std::swap(file_, other.file_);
    std::swap(usbFolder_, other.usbFolder_);
    std::swap(card_, other.card_);
    std::swap(identity_, other.identity_);
    std::swap(vendor_, other.vendor_);
    std::swap(product_, other.product_);
    std::swap(descriptor_, other.descriptor_);
    return *this;
}

int VideoNode::control(unsigned long request, void* argument) const noexcept {
    return videoIoctl(descriptor_, request, argument);
}

void VideoNode::identify(const std::string& busInfo) {
    std::error_code failed;
    const fs::path interface = fs::canonical("/sys/class/video4linux" / file_.filename() / "device", failed);
    const fs::path device = interface.parent_path();
    if (failed || !fs::exists(device / "idVendor", failed)) {
        identity_ = busInfo;
        return;
    }
    usbFolder_ = device;
    vendor_ = readHex(device / "idVendor");
    product_ = readHex(device / "idProduct");
    const std::string serial = readWord(device / "serial");
    identity_ = readWord(device / "idVendor") + ":" + readWord(device / "idProduct") + ":" +
                (serial.empty() ? busInfo : serial);
}

std::vector<uint32_t> VideoNode::formats() const {
    std::vector<uint32_t> found;
    v4l2_fmtdesc description{};
    description.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    for (; control(VIDIOC_ENUM_FMT, &description) == 0; ++description.index) {
        found.push_back(description.pixelformat);
    }
    return found;
}

std::vector<VideoSize> VideoNode::sizes(uint32_t fourcc) const {
    std::vector<VideoSize> found;
    v4l2_frmsizeenum size{};
    size.pixel_format = fourcc;
    for (; control(VIDIOC_ENUM_FRAMESIZES, &size) == 0; ++size.index) {
        if (size.type != V4L2_FRMSIZE_TYPE_DISCRETE) {
            return {{size.stepwise.min_width, size.stepwise.min_height},
                    {size.stepwise.max_width, size.stepwise.max_height}};
        }
        found.push_back({size.discrete.width, size.discrete.height});
    }
    return found;
}

bool VideoNode::offers(uint32_t fourcc) const {
    const std::vector<uint32_t> all = formats();
    return std::find(all.begin(), all.end(), fourcc) != all.end();
}

std::string VideoNode::offer() const {
    constexpr size_t kMax = 8; // formats: a line that can be read
    std::string list;
    size_t count = 0;
    for (const uint32_t fourcc : formats()) {
        if (++count > kMax) {
            return list + ", ...";
        }
        list += (list.empty() ? "" : ", ") + fourccName(fourcc);
        for (const VideoSize size : sizes(fourcc)) {
            list += ' ';
            list += sizeName(size);
        }
    }
    return list.empty() ? "nothing" : list;
}

bool isMetadataNode(const fs::path& file) noexcept {
    const int descriptor = ::open(file.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
    v4l2_capability capability{};
    const bool known = descriptor >= 0 && ::ioctl(descriptor, VIDIOC_QUERYCAP, &capability) == 0;
    if (descriptor >= 0) {
        ::close(descriptor);
    }
    return known && (capability.device_caps & V4L2_CAP_META_CAPTURE) != 0;
}

std::vector<VideoNode> openVideoNodes(std::vector<std::string>* refused) {
    std::vector<std::pair<unsigned long, fs::path>> files;
    std::error_code failed;
    for (const fs::directory_entry& entry : fs::directory_iterator("/dev", failed)) {
        const std::string name = entry.path().filename().string();
        if (name.starts_with("video") && name.size() > 5 &&
            std::isdigit(static_cast<unsigned char>(name[5]))) {
            files.emplace_back(std::strtoul(name.c_str() + 5, nullptr, 10), entry.path());
        }
    }
    std::sort(files.begin(), files.end());
    std::vector<VideoNode> nodes;
    for (const auto& [number, file] : files) {
        try {
            nodes.emplace_back(file);
        } catch (const Error& e) {
            if (refused != nullptr && !isMetadataNode(file)) {
                refused->push_back(e.what());
            }
        }
    }
    return nodes;
}

} // namespace fathom
