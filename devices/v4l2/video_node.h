// SPDX-License-Identifier: Apache-2.0
// One /dev/videoN of Video4Linux2: identity, formats and file descriptor.
// Source: docs.kernel.org/userspace-api/media/v4l.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fathom {

// Size of an image.
struct VideoSize {
    uint32_t width = 0, height = 0; // [pixels]
    bool operator==(const VideoSize&) const = default;
};

// "Z16 " for the four-character code of that format; "640x480".
std::string fourccName(uint32_t fourcc);
std::string sizeName(VideoSize size);
constexpr uint32_t fourccOf(const char (&name)[5]) {
    uint32_t code = 0;
    for (int i = 3; i >= 0; --i) {
        code = code << 8 | static_cast<uint8_t>(name[i]);
    }
    return code;
}

// Owns an open descriptor (read-write, non-blocking, closed on exec). Move-only.
class VideoNode {
public:
    // Throws BadInput when the file is missing, cannot be opened, or is not a streaming capture device.
    explicit VideoNode(const std::filesystem::path& file);
    ~VideoNode();
    VideoNode(VideoNode&& other) noexcept;
    VideoNode& operator=(VideoNode&& other) noexcept;

    // ioctl with retry on EINTR; 0 or -1 with errno.
    int control(unsigned long request, void* argument) const noexcept;

    int descriptor() const { return descriptor_; }
    const std::filesystem::path& file() const { return file_; }
    const std::string& card() const { return card_; } // the camera's name
    // Equal for all nodes of one camera and after replugging: USB vendor:product:serial, or the bus path
    // without a serial number.
    const std::string& identity() const { return identity_; }
    // USB vendor and product number, 0 when it is not a USB device; the folder of the USB device in /sys.
    uint16_t vendor() const { return vendor_; }
    uint16_t product() const { return product_; }
    const std::filesystem::path& usbFolder() const { return usbFolder_; }

    std::vector<uint32_t> formats() const;               // four-character codes
    std::vector<VideoSize> sizes(uint32_t fourcc) const; // discrete ones, or smallest and largest
    bool offers(uint32_t fourcc) const;
    // "Z16 640x480 320x240, YUYV 640x480": for a refusal.
    std::string offer() const;

private:
    void identify(const std::string& busInfo);

    std::filesystem::path file_, usbFolder_;
    std::string card_, identity_;
    uint16_t vendor_ = 0, product_ = 0;
    int descriptor_ = -1;
};

// True for a metadata node, which delivers no images (UVC cameras have one per stream).
bool isMetadataNode(const std::filesystem::path& file) noexcept;

// All capture nodes that can be opened, in order of their numbers. `refused`, when given, gets one line per
// node that cannot be opened, except metadata nodes.
std::vector<VideoNode> openVideoNodes(std::vector<std::string>* refused = nullptr);

} // namespace fathom
