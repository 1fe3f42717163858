// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/camera_request.h"

#include "engine/types/error.h"
#include "engine/types/parse_number.h"

namespace fathom {

namespace {

constexpr std::string_view kPrefix = "v4l2:";

[[noreturn]] void refuse(const std::string& text, const std::string& field, const std::string& value,
                         const std::string& allowed) {
    throw BadInput(text, field, value.empty() ? "empty" : value, allowed);
}

VideoSize parseSize(const std::string& all, const std::string& name, const std::string& value) {
    const size_t cross = value.find('x');
    VideoSize size;
    const bool good = cross != std::string::npos &&
                      parseWhole(std::string_view(value).substr(0, cross), size.width) &&
                      parseWhole(std::string_view(value).substr(cross + 1), size.height);
    if (!good || size.width < 1 || size.height < 1 || size.width > 3840 || size.height > 2160) {
        refuse(all, name, value, "WIDTHxHEIGHT, at most 3840x2160");
    }
    return size;
}

uint32_t parseFourcc(const std::string& all, const std::string& name, const std::string& value) {
    if (value.empty() || value.size() > 4) {
        refuse(all, name, value, "a V4L2 format of one to four characters, e.g. Z16, Y16, YUYV, MJPG");
    }
    uint32_t code = 0;
    for (int i = 3; i >= 0; --i) {
        const size_t at = static_cast<size_t>(i);
        code = code << 8 | static_cast<uint8_t>(at < value.size() ? value[at] : ' ');
    }
    return code;
}

double parseRate(const std::string& all, const std::string& name, const std::string& value) {
    double rate = 0.0;
    if (!parseWhole(value, rate) || !(rate >= 1.0 && rate <= 300.0)) {
        refuse(all, name, value, "1 to 300 frames per second");
    }
    return rate;
}

void set(CameraRequest& request, const std::string& name, const std::string& value) {
    if (name == "colour" || name == "color") {
        request.colour = value;
    } else if (name == "format") {
        request.format = parseFourcc(request.text, name, value);
    } else if (name == "colour_format" || name == "color_format") {
        request.colourFormat = parseFourcc(request.text, name, value);
    } else if (name == "size") {
        request.size = parseSize(request.text, name, value);
    } else if (name == "colour_size" || name == "color_size") {
        request.colourSize = parseSize(request.text, name, value);
    } else if (name == "rate") {
        request.rate = parseRate(request.text, name, value);
    } else if (name == "colour_rate" || name == "color_rate") {
        request.colourRate = parseRate(request.text, name, value);
    } else if (name == "intrinsics") {
        request.intrinsics = value;
    } else if (name == "frames") {
        if (!parseWhole(value, request.frames) || request.frames == 0) {
            refuse(request.text, name, value, "1 or more");
        }
    } else {
        refuse(request.text, name, value, CameraRequest::kAllowed);
    }
}

} // namespace

bool isCameraRequest(const std::string& text) {
    return text.starts_with(kPrefix) || text == "v4l2";
}

CameraRequest parseCameraRequest(const std::string& text) {
    CameraRequest request;
    request.text = text;
    std::string rest = text == "v4l2" ? "auto" : text;
    if (rest.starts_with(kPrefix)) {
        rest.erase(0, kPrefix.size());
    }
    bool first = true;
    for (size_t at = 0; at <= rest.size();) {
        const size_t end = std::min(rest.find(',', at), rest.size());
        const std::string word = rest.substr(at, end - at);
        const size_t equals = word.find('=');
        if (first && equals == std::string::npos && (word == "auto" || word.starts_with("/dev/"))) {
            request.device = word;
        } else if (!first && equals != std::string::npos) {
            set(request, word.substr(0, equals), word.substr(equals + 1));
        } else {
            refuse(text, first ? "device" : "option", word, CameraRequest::kAllowed);
        }
        first = false;
        at = end + 1;
    }
    return request;
}

} // namespace fathom
