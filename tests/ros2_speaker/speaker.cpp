// SPDX-License-Identifier: Apache-2.0
// A publisher of ROS 2 for tests: a process of its own that publishes one message for each line of its
// standard input, written with the code that idlc generated. It has the QoS of rmw's default publishers.
//   ros2_speaker DOMAIN TOPIC TYPE
// PoseStamped: x y z qx qy qz qw; Joy: one number per button; JointState: NAME POSITION...; Bool: 0 or 1;
// Empty: nothing; "short": a message that ends within its header. A first word "age=S" dates the message S
// seconds before now. It writes "ready", and then "ok" after each line.
#include "messages.h"
#include "tests/ros2_talker/join_loopback.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <iostream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

namespace {

std::vector<double> numbersOf(const std::string& line) {
    std::istringstream words(line);
    std::vector<double> numbers;
    for (std::string word; words >> word;) {
        numbers.push_back(std::strtod(word.c_str(), nullptr));
    }
    return numbers;
}

double age = -1.0; // [s] of the next message; negative: a stamp of long ago, on which readers must not depend

// Takes the age from the line.
std::string takeAge(const std::string& line) {
    const std::string word = "age=";
    const bool given = line.starts_with(word);
    age = given ? std::strtod(line.c_str() + word.size(), nullptr) : -1.0;
    return given ? line.substr(std::min(line.size(), line.find(' ') + 1)) : line;
}

std_msgs_msg_dds__Header_ header() {
    static int32_t second = 17;
    const double now =
        std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
    std_msgs_msg_dds__Header_ out{};
    out.stamp.sec = age < 0.0 ? second++ : static_cast<int32_t>(now - age);
    out.stamp.nanosec = age < 0.0 ? 0 : static_cast<uint32_t>(1e9 * (now - age - out.stamp.sec));
    out.frame_id = const_cast<char*>("handle_base");
    return out;
}

void publishPose(dds_entity_t writer, const std::string& line) {
    const std::vector<double> n = numbersOf(line);
    geometry_msgs_msg_dds__PoseStamped_ m{};
    m.header = header();
    m.pose.position = {n.at(0), n.at(1), n.at(2)};
    m.pose.orientation = {n.at(3), n.at(4), n.at(5), n.at(6)};
    dds_write(writer, &m);
}

void publishJoy(dds_entity_t writer, const std::string& line) {
    const std::vector<double> n = numbersOf(line);
    std::vector<int32_t> buttons(n.begin(), n.end());
    float axes[2] = {0.5f, -0.5f};
    sensor_msgs_msg_dds__Joy_ m{};
    m.header = header();
    m.axes = {2, 2, axes, false};
    m.buttons = {static_cast<uint32_t>(buttons.size()), static_cast<uint32_t>(buttons.size()), buttons.data(),
                 false};
    dds_write(writer, &m);
}

// NAME POSITION NAME POSITION ...
void publishJoints(dds_entity_t writer, const std::string& line) {
    std::istringstream words(line);
    std::vector<std::string> names;
    std::vector<double> positions;
    for (std::string name, position; words >> name >> position;) {
        names.push_back(name);
        positions.push_back(std::strtod(position.c_str(), nullptr));
    }
    std::vector<char*> texts;
    for (std::string& name : names) {
        texts.push_back(name.data());
    }
    const auto count = static_cast<uint32_t>(names.size());
    sensor_msgs_msg_dds__JointState_ m{};
    m.header = header();
    m.name = {count, count, texts.data(), false};
    m.position = {count, count, positions.data(), false};
    dds_write(writer, &m);
}

void publishBool(dds_entity_t writer, const std::string& line) {
    const std::vector<double> n = numbersOf(line);
    const std_msgs_msg_dds__Bool_ m{n.at(0) != 0.0};
    dds_write(writer, &m);
}

void publishEmpty(dds_entity_t writer, const std::string&) {
    const std_msgs_msg_dds__Empty_ m{0};
    dds_write(writer, &m);
}

struct Type {
    const dds_topic_descriptor_t* descriptor;
    void (*publish)(dds_entity_t writer, const std::string& line);
};

const std::map<std::string, Type> kTypes{
    {"PoseStamped", {&geometry_msgs_msg_dds__PoseStamped__desc, publishPose}},
    {"JointState", {&sensor_msgs_msg_dds__JointState__desc, publishJoints}},
    {"Joy", {&sensor_msgs_msg_dds__Joy__desc, publishJoy}},
    {"Bool", {&std_msgs_msg_dds__Bool__desc, publishBool}},
    {"Empty", {&std_msgs_msg_dds__Empty__desc, publishEmpty}}};

dds_entity_t writerOf(dds_entity_t participant, const std::string& topic,
                      const dds_topic_descriptor_t& type) {
    constexpr int kRmwDepth = 10;
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, kRmwDepth);
    const dds_entity_t made = dds_create_topic(participant, &type, ("rt" + topic).c_str(), nullptr, nullptr);
    const dds_entity_t writer = dds_create_writer(participant, made, qos, nullptr);
    dds_delete_qos(qos);
    if (writer < 0) {
        std::cerr << "ros2_speaker: " << topic << ": " << dds_strretcode(writer) << "\n";
        std::exit(1);
    }
    return writer;
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 4 || kTypes.count(argv[3]) == 0) {
        return 2;
    }
    const Type& type = kTypes.at(argv[3]);
    const dds_entity_t participant = joinLoopback(static_cast<dds_domainid_t>(std::atoi(argv[1])));
    const dds_entity_t writer = writerOf(participant, argv[2], *type.descriptor);
    const dds_topic_descriptor_t shorter = shortType(type.descriptor->m_typename);
    dds_entity_t shortWriter = 0;
    std::cout << "ready" << std::endl;
    for (std::string line; std::getline(std::cin, line);) {
        if (line == "short") {
            shortWriter = shortWriter != 0 ? shortWriter : writerOf(participant, argv[2], shorter);
            const builtin_interfaces_msg_dds__Time_ few{1, 2};
            dds_write(shortWriter, &few);
        } else {
            type.publish(writer, takeAge(line));
        }
        std::cout << "ok" << std::endl;
    }
    return 0;
}
