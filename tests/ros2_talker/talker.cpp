// SPDX-License-Identifier: Apache-2.0
// A ROS 2 camera driver for tests: a process of its own that publishes 8 x 6 images with the messages that
// idlc generated. Lines on its standard input change what it does, and each is answered by "ok".
//   ros2_talker DOMAIN
//   KEY VALUE: a number or a word of `Settings`; "quit" ends it.
#include "messages.h"
#include "tests/ros2_talker/join_loopback.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <dds/dds.h>
#include <iostream>
#include <map>
#include <poll.h>
#include <string>
#include <unistd.h>
#include <vector>

namespace {

using Clock = std::chrono::system_clock;

dds_entity_t participant = 0;

// rate [1/s]; on: publishes depth; shift [s]: added to the stamps; encoding 0: 16UC1, 1: 32FC1, 2: "64FC1";
// broken: that many malformed messages; moving 1: /tf and /tf_static lead from "base" to the camera; width,
// height [pixels]; value: of depth, in millimetres.
std::map<std::string, double> settings{{"rate", 30}, {"on", 1},           {"colour", 1},  {"info", 1},
                                       {"tf", 0},    {"encoding", 0},     {"shift", 0},   {"broken", 0},
                                       {"width", 8}, {"height", 6},       {"value", 500}, {"fx", 7},
                                       {"claim", 0}, {"colour_shift", 0}, {"moving", 0}};

int setting(const std::string& key) {
    return static_cast<int>(settings.at(key));
}

dds_entity_t writerOf(const char* topic, const dds_topic_descriptor_t& type, bool latched = false) {
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
    dds_qset_durability(qos, latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, 5);
    const dds_entity_t made = dds_create_topic(participant, &type, topic, nullptr, nullptr);
    const dds_entity_t writer = dds_create_writer(participant, made, qos, nullptr);
    dds_delete_qos(qos);
    if (writer < 0) {
        std::fprintf(stderr, "ros2_talker: %s: %s\n", topic, dds_strretcode(writer));
        std::exit(1);
    }
    return writer;
}

std_msgs_msg_dds__Header_ header(double shift, const char* frame) {
    const double now = std::chrono::duration<double>(Clock::now().time_since_epoch()).count() + shift;
    std_msgs_msg_dds__Header_ out{};
    out.stamp.sec = static_cast<int32_t>(now);
    out.stamp.nanosec = static_cast<uint32_t>(1e9 * (now - out.stamp.sec));
    out.frame_id = const_cast<char*>(frame);
    return out;
}

void publishImage(dds_entity_t writer, const char* frame, const char* encoding, double shift,
                  std::vector<uint8_t> bytes, uint32_t perPixel) {
    sensor_msgs_msg_dds__Image_ image{};
    image.header = header(shift, frame);
    image.width = static_cast<uint32_t>(setting("width"));
    image.height = static_cast<uint32_t>(setting("height"));
    image.encoding = const_cast<char*>(encoding);
    image.step = perPixel * image.width;
    if (settings.at("claim") > 0) { // more pixels than there are bytes
        image.height = static_cast<uint32_t>(settings.at("claim"));
    }
    image.data = {static_cast<uint32_t>(bytes.size()), static_cast<uint32_t>(bytes.size()), bytes.data(),
                  false};
    dds_write(writer, &image);
}

void publishDepth(dds_entity_t writer) {
    const auto pixels = static_cast<size_t>(setting("width")) * static_cast<size_t>(setting("height"));
    const bool metres = setting("encoding") == 1;
    std::vector<uint8_t> bytes(pixels * (metres ? 4 : 2));
    const auto millimetres = static_cast<uint16_t>(setting("value"));
    const float value = 0.001f * static_cast<float>(millimetres);
    for (size_t i = 0; i < pixels; ++i) {
        metres ? std::memcpy(bytes.data() + 4 * i, &value, 4)
               : std::memcpy(bytes.data() + 2 * i, &millimetres, 2);
    }
    const char* names[] = {"16UC1", "32FC1", "64FC1"};
    publishImage(writer, "depth_frame", names[setting("encoding")], settings.at("shift"), bytes,
                 metres ? 4 : 2);
}

void publishColour(dds_entity_t writer) {
    const auto pixels = static_cast<size_t>(setting("width")) * static_cast<size_t>(setting("height"));
    std::vector<uint8_t> bytes(3 * pixels);
    for (size_t i = 0; i < pixels; ++i) {
        bytes[3 * i] = 200;
    }
    publishImage(writer, setting("tf") != 0 ? "colour_frame" : "depth_frame", "rgb8",
                 settings.at("shift") + settings.at("colour_shift"), bytes, 3);
}

void publishInfo(dds_entity_t writer) {
    sensor_msgs_msg_dds__CameraInfo_ info{};
    info.header = header(settings.at("shift"), "depth_frame");
    info.width = static_cast<uint32_t>(setting("width"));
    info.height = static_cast<uint32_t>(setting("height"));
    info.distortion_model = const_cast<char*>("plumb_bob");
    double d[5] = {};
    info.d = {5, 5, d, false};
    const double f = settings.at("fx"), cx = 0.5 * settings.at("width") - 0.5,
                 cy = 0.5 * settings.at("height") - 0.5;
    const double k[9] = {f, 0, cx, 0, f, cy, 0, 0, 1}, r[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    const double p[12] = {f, 0, cx, 0, 0, f, cy, 0, 0, 0, 1, 0};
    std::copy_n(k, 9, info.k);
    std::copy_n(r, 9, info.r);
    std::copy_n(p, 12, info.p);
    dds_write(writer, &info);
}

void publishTransform(dds_entity_t writer, const char* parent, const char* child, double x) {
    geometry_msgs_msg_dds__TransformStamped_ link{};
    link.header = header(settings.at("shift"), parent);
    link.child_frame_id = const_cast<char*>(child);
    link.transform.translation.x = x;
    link.transform.rotation.w = 1.0;
    tf2_msgs_msg_dds__TFMessage_ message{};
    message.transforms = {1, 1, &link, false};
    dds_write(writer, &message);
}

// Both cameras are 25 mm apart. A moving one is 0.5 m from its wrist, which moves by 0.1 m/s.
void publishTransforms(dds_entity_t fixed, dds_entity_t moving) {
    if (setting("tf") == 1) {
        publishTransform(fixed, "depth_frame", "colour_frame", 0.025);
        settings["tf"] = 2;
    }
    if (setting("moving") == 1) {
        const double now = std::chrono::duration<double>(Clock::now().time_since_epoch()).count();
        publishTransform(fixed, "wrist", "depth_frame", 0.5);
        publishTransform(moving, "base", "wrist", 0.1 * std::fmod(now, 1000.0));
    }
}

void obey(const std::string& line) {
    if (line == "quit") {
        std::exit(0);
    }
    const size_t space = line.find(' ');
    settings.at(line.substr(0, space)) = std::strtod(line.c_str() + std::min(space, line.size()), nullptr);
    std::cout << "ok" << std::endl;
}

// Until the next image is due.
void listen() {
    static std::string rest;
    static auto due = std::chrono::steady_clock::now();
    due = std::max(due + std::chrono::microseconds(static_cast<int>(1e6 / settings.at("rate"))),
                   std::chrono::steady_clock::now() - std::chrono::milliseconds(100)); // keeps its rate
    for (;;) {
        const auto left =
            std::chrono::duration_cast<std::chrono::milliseconds>(due - std::chrono::steady_clock::now())
                .count();
        pollfd in{STDIN_FILENO, POLLIN, 0};
        if (left <= 0 || ::poll(&in, 1, static_cast<int>(left)) <= 0) {
            return;
        }
        char bytes[256];
        const ssize_t count = ::read(STDIN_FILENO, bytes, sizeof bytes);
        if (count <= 0) {
            std::exit(0); // the test has ended
        }
        rest.append(bytes, static_cast<size_t>(count));
        for (size_t end = rest.find('\n'); end != std::string::npos; end = rest.find('\n')) {
            obey(rest.substr(0, end));
            rest.erase(0, end + 1);
        }
    }
}

} // namespace

int main(int argc, char** argv) {
    const auto domain = static_cast<dds_domainid_t>(argc > 1 ? std::atoi(argv[1]) : 0);
    participant = joinLoopback(domain);
    const dds_topic_descriptor_t broken = shortType("sensor_msgs::msg::dds_::Image_");
    const dds_entity_t depth = writerOf("rt/camera/depth/image_rect_raw", sensor_msgs_msg_dds__Image__desc),
                       colour = writerOf("rt/camera/color/image_raw", sensor_msgs_msg_dds__Image__desc),
                       depthInfo =
                           writerOf("rt/camera/depth/camera_info", sensor_msgs_msg_dds__CameraInfo__desc),
                       colourInfo =
                           writerOf("rt/camera/color/camera_info", sensor_msgs_msg_dds__CameraInfo__desc),
                       transforms = writerOf("rt/tf_static", tf2_msgs_msg_dds__TFMessage__desc, true),
                       moving = writerOf("rt/tf", tf2_msgs_msg_dds__TFMessage__desc);
    std::cout << "ok" << std::endl;
    for (int i = 0;; ++i) {
        listen();
        publishTransforms(transforms, moving);
        if (setting("broken") > 0) {
            static const dds_entity_t kBrokenWriter = writerOf("rt/camera/depth/image_rect_raw", broken);
            const builtin_interfaces_msg_dds__Time_ few{1, 2};
            dds_write(kBrokenWriter, &few);
        }
        if (setting("colour") != 0) {
            publishColour(colour);
        }
        if (setting("on") != 0) {
            publishDepth(depth);
        }
        if (setting("info") != 0) {
            publishInfo(depthInfo);
            publishInfo(colourInfo);
        }
    }
}
