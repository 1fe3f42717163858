// SPDX-License-Identifier: Apache-2.0
#include "devices/v4l2/v4l2_controls.h"

#include "engine/types/error.h"
#include "engine/types/lower_case.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <linux/videodev2.h>
#include <optional>
#include <utility>

namespace fathom {

namespace {

struct Known {
    uint32_t number;
    const char* name;
    const char* unit;
    const char* automatic; // the switch that keeps it fixed
};
constexpr std::array kKnown = {
    Known{V4L2_CID_EXPOSURE_AUTO, "auto exposure", "", ""},
    Known{V4L2_CID_EXPOSURE_ABSOLUTE, "exposure", "x 0.1 ms", "auto exposure"},
    Known{V4L2_CID_AUTOGAIN, "auto gain", "", ""},
    Known{V4L2_CID_GAIN, "gain", "", "auto gain or auto exposure"},
    Known{V4L2_CID_AUTO_WHITE_BALANCE, "auto white balance", "", ""},
    Known{V4L2_CID_WHITE_BALANCE_TEMPERATURE, "white balance", "K", "auto white balance"},
};
constexpr const char* kLaser = "laser or emitter";

std::optional<v4l2_query_ext_ctrl> described(const VideoNode& node, uint32_t number) {
    v4l2_query_ext_ctrl query{};
    query.id = number;
    if (node.control(VIDIOC_QUERY_EXT_CTRL, &query) != 0 || (query.flags & V4L2_CTRL_FLAG_DISABLED) != 0) {
        return std::nullopt;
    }
    return query;
}

int exchange(const VideoNode& node, unsigned long request, v4l2_ext_control& control) {
    v4l2_ext_controls all{};
    all.which = V4L2_CTRL_WHICH_CUR_VAL;
    all.count = 1;
    all.controls = &control;
    return node.control(request, &all);
}

// The manual mode, and the automatic one that this camera offers.
int64_t exposureMode(const VideoNode& node, bool automatic) {
    for (const uint32_t mode : {V4L2_EXPOSURE_AUTO, V4L2_EXPOSURE_APERTURE_PRIORITY}) {
        v4l2_querymenu item{};
        item.id = V4L2_CID_EXPOSURE_AUTO;
        item.index = mode;
        if (automatic && node.control(VIDIOC_QUERYMENU, &item) == 0) {
            return mode;
        }
    }
    return V4L2_EXPOSURE_MANUAL;
}

std::string whyFixed(const v4l2_query_ext_ctrl& query, const char* automatic) {
    if ((query.flags & V4L2_CTRL_FLAG_READ_ONLY) != 0) {
        return "read only";
    }
    if ((query.flags & V4L2_CTRL_FLAG_INACTIVE) != 0) {
        return *automatic != 0 ? std::string("switch off ") + automatic : "inactive in this mode";
    }
    return (query.flags & V4L2_CTRL_FLAG_GRABBED) != 0 ? "in use by another program" : "";
}

bool isNumber(const v4l2_query_ext_ctrl& query) {
    return query.type == V4L2_CTRL_TYPE_INTEGER || query.type == V4L2_CTRL_TYPE_BOOLEAN ||
           query.type == V4L2_CTRL_TYPE_MENU || query.type == V4L2_CTRL_TYPE_INTEGER_MENU;
}

CameraControl valued(const VideoNode& node, const std::string& stream, const v4l2_query_ext_ctrl& query,
                     const Known& known) {
    CameraControl control{stream, known.name, known.unit};
    const bool exposure = query.id == V4L2_CID_EXPOSURE_AUTO;
    control.number = query.id;
    control.isSwitch = exposure || query.type == V4L2_CTRL_TYPE_BOOLEAN;
    control.least = control.isSwitch ? 0 : query.minimum;
    control.most = control.isSwitch ? 1 : query.maximum;
    control.step = std::max<int64_t>(1, static_cast<int64_t>(query.step));
    control.fixed = whyFixed(query, known.automatic);
    v4l2_ext_control value{};
    value.id = query.id;
    if (exchange(node, VIDIOC_G_EXT_CTRLS, value) != 0) {
        control.fixed = std::string("cannot be read: ") + std::strerror(errno);
    }
    control.value = exposure ? (value.value != V4L2_EXPOSURE_MANUAL ? 1 : 0) : value.value;
    return control;
}

CameraControl absent(const std::string& stream, const char* name) {
    CameraControl control{stream, name, ""};
    control.fixed = "not offered by the camera's driver";
    return control;
}

// Vendors' own controls, which have names only.
bool isLaser(const v4l2_query_ext_ctrl& query) {
    const std::string name = lowerCase({query.name, strnlen(query.name, sizeof query.name)});
    return isNumber(query) &&
           (name.find("laser") != std::string::npos || name.find("emitter") != std::string::npos);
}

void appendLasers(const VideoNode& node, const std::string& stream, std::vector<CameraControl>& controls) {
    const size_t before = controls.size();
    constexpr int kMax = 512; // controls of one driver
    v4l2_query_ext_ctrl query{};
    query.id = V4L2_CTRL_FLAG_NEXT_CTRL;
    for (int i = 0; i < kMax && node.control(VIDIOC_QUERY_EXT_CTRL, &query) == 0; ++i) {
        if (isLaser(query) && (query.flags & V4L2_CTRL_FLAG_DISABLED) == 0) {
            const std::string name(query.name, strnlen(query.name, sizeof query.name));
            controls.push_back(valued(node, stream, query, {query.id, name.c_str(), "", ""}));
        }
        query.id |= V4L2_CTRL_FLAG_NEXT_CTRL;
    }
    if (controls.size() == before) {
        controls.push_back(absent(stream, kLaser));
    }
}

} // namespace

void V4l2Controls::moveTo(std::vector<Node> nodes) {
    const std::lock_guard lock(mutex_);
    nodes_ = std::move(nodes);
}

std::vector<V4l2Controls::Node> V4l2Controls::nodes() const {
    const std::lock_guard lock(mutex_);
    return nodes_;
}

std::vector<CameraControl> V4l2Controls::read() {
    std::vector<CameraControl> controls;
    for (const auto& [stream, file] : nodes()) {
        try {
            const VideoNode node(file);
            for (const Known& known : kKnown) {
                const auto query = described(node, known.number);
                controls.push_back(query ? valued(node, stream, *query, known) : absent(stream, known.name));
            }
            if (stream == "depth") {
                appendLasers(node, stream, controls);
            }
        } catch (const BadInput&) {
            return {}; // unplugged
        }
    }
    return controls;
}

std::string V4l2Controls::set(const CameraControl& control, int64_t value) {
    for (const auto& [stream, file] : nodes()) {
        if (stream != control.stream) {
            continue;
        }
        try {
            const VideoNode node(file);
            v4l2_ext_control wanted{};
            wanted.id = control.number;
            wanted.value = static_cast<int32_t>(
                control.number == V4L2_CID_EXPOSURE_AUTO ? exposureMode(node, value != 0) : value);
            if (exchange(node, VIDIOC_S_EXT_CTRLS, wanted) == 0) {
                return "";
            }
            return stream + " " + control.name + " was not set: " + std::strerror(errno);
        } catch (const BadInput& e) {
            return e.what();
        }
    }
    return "the camera has no " + control.stream + " stream";
}

} // namespace fathom
