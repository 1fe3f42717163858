// SPDX-License-Identifier: Apache-2.0
// A subscriber of ROS 2 for tests: a process of its own that prints each message of one topic as a line, read
// with the code that idlc generated. It has the QoS of rmw's default subscribers.
//   ros2_listener DOMAIN TOPIC TYPE [N]
// "ready" is its first line; it ends with its standard input. With a fourth argument N it prints instead,
// after N messages or at its end, how old they are on arrival by their stamps, and how far apart.
#include "messages.h"
#include "tests/ros2_listener/said.h"
#include "tests/ros2_talker/join_loopback.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <dds/dds.h>
#include <map>
#include <unistd.h>
#include <vector>

namespace {

Said said(const std_msgs_msg_dds__Header_& header) {
    return Said().stamp(header.stamp.sec, header.stamp.nanosec).word(header.frame_id);
}

template <class V>
void vector(Said& said, const V& v) {
    said.number(v.x).number(v.y).number(v.z);
}

void pose(Said& said, const geometry_msgs_msg_dds__Pose_& pose) {
    vector(said, pose.position);
    vector(said, pose.orientation);
    said.number(pose.orientation.w);
}

void print(const geometry_msgs_msg_dds__PoseStamped_& m) {
    Said line = said(m.header);
    pose(line, m.pose);
    line.print();
}

void print(const geometry_msgs_msg_dds__WrenchStamped_& m) {
    Said line = said(m.header);
    vector(line, m.wrench.force);
    vector(line, m.wrench.torque);
    line.print();
}

void print(const geometry_msgs_msg_dds__TwistStamped_& m) {
    Said line = said(m.header);
    vector(line, m.twist.linear);
    vector(line, m.twist.angular);
    line.print();
}

// Fields, count of points, and the first point.
void print(const sensor_msgs_msg_dds__PointCloud2_& m) {
    Said line = said(m.header);
    std::string fields;
    for (uint32_t i = 0; i < m.fields._length; ++i) {
        fields += (i == 0 ? "" : ",") + std::string(m.fields._buffer[i].name);
    }
    line.word(fields).number(m.width).number(m.height).number(m.point_step).number(m.data._length);
    for (uint32_t i = 0; i < 5 && m.data._length >= 20; ++i) {
        float value = 0.0f;
        std::memcpy(&value, m.data._buffer + 4 * i, 4);
        line.number(static_cast<double>(value));
    }
    line.print();
}

void print(const visualization_msgs_msg_dds__MarkerArray_& m) {
    for (uint32_t i = 0; i < m.markers._length; ++i) {
        const visualization_msgs_msg_dds__Marker_& marker = m.markers._buffer[i];
        Said line = said(marker.header);
        line.word(marker.ns).number(marker.id).number(marker.type).number(marker.action);
        pose(line, marker.pose);
        vector(line, marker.scale);
        line.number(static_cast<double>(marker.color.a)).number(marker.points._length);
        line.word(marker.text).number(marker.mesh_use_embedded_materials ? 1 : 0).print();
    }
}

void print(const diagnostic_msgs_msg_dds__DiagnosticArray_& m) {
    for (uint32_t i = 0; i < m.status._length; ++i) {
        const diagnostic_msgs_msg_dds__DiagnosticStatus_& part = m.status._buffer[i];
        Said line = said(m.header);
        line.number(part.level).word(part.name).word(part.message);
        for (uint32_t k = 0; k < part.values._length; ++k) {
            line.word(part.values._buffer[k].key + std::string("=") + part.values._buffer[k].value);
        }
        line.print();
    }
}

void print(const sensor_msgs_msg_dds__JointState_& m) {
    Said line = said(m.header);
    for (uint32_t i = 0; i < m.name._length && i < m.position._length; ++i) {
        line.word(m.name._buffer[i]).number(m.position._buffer[i]);
    }
    line.print();
}

void print(const trajectory_msgs_msg_dds__JointTrajectory_& m) {
    Said line = said(m.header);
    for (uint32_t i = 0; i < m.points._length; ++i) {
        const trajectory_msgs_msg_dds__JointTrajectoryPoint_& point = m.points._buffer[i];
        line.stamp(point.time_from_start.sec, point.time_from_start.nanosec);
        for (uint32_t k = 0; k < m.joint_names._length && k < point.positions._length; ++k) {
            line.word(m.joint_names._buffer[k]).number(point.positions._buffer[k]);
        }
    }
    line.print();
}

void print(const tf2_msgs_msg_dds__TFMessage_& m) {
    for (uint32_t i = 0; i < m.transforms._length; ++i) {
        const geometry_msgs_msg_dds__TransformStamped_& link = m.transforms._buffer[i];
        Said line = said(link.header);
        line.word(link.child_frame_id);
        vector(line, link.transform.translation);
        vector(line, link.transform.rotation);
        line.number(link.transform.rotation.w).print();
    }
}

struct Type {
    const dds_topic_descriptor_t* descriptor;
    void (*print)(const void* message);
};

template <class M>
Type typeOf(const dds_topic_descriptor_t& descriptor) {
    return {&descriptor, [](const void* message) { print(*static_cast<const M*>(message)); }};
}

const std::map<std::string, Type> kTypes{
    {"PoseStamped", typeOf<geometry_msgs_msg_dds__PoseStamped_>(geometry_msgs_msg_dds__PoseStamped__desc)},
    {"WrenchStamped",
     typeOf<geometry_msgs_msg_dds__WrenchStamped_>(geometry_msgs_msg_dds__WrenchStamped__desc)},
    {"TwistStamped", typeOf<geometry_msgs_msg_dds__TwistStamped_>(geometry_msgs_msg_dds__TwistStamped__desc)},
    {"PointCloud2", typeOf<sensor_msgs_msg_dds__PointCloud2_>(sensor_msgs_msg_dds__PointCloud2__desc)},
    {"MarkerArray",
     typeOf<visualization_msgs_msg_dds__MarkerArray_>(visualization_msgs_msg_dds__MarkerArray__desc)},
    {"DiagnosticArray",
     typeOf<diagnostic_msgs_msg_dds__DiagnosticArray_>(diagnostic_msgs_msg_dds__DiagnosticArray__desc)},
    {"TFMessage", typeOf<tf2_msgs_msg_dds__TFMessage_>(tf2_msgs_msg_dds__TFMessage__desc)},
    {"JointState", typeOf<sensor_msgs_msg_dds__JointState_>(sensor_msgs_msg_dds__JointState__desc)},
    {"JointTrajectory",
     typeOf<trajectory_msgs_msg_dds__JointTrajectory_>(trajectory_msgs_msg_dds__JointTrajectory__desc)}};

dds_entity_t readerOf(dds_entity_t participant, const std::string& topic, const Type& type) {
    constexpr int kRmwDepth = 10;
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_INFINITY);
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, kRmwDepth);
    const dds_entity_t made =
        dds_create_topic(participant, type.descriptor, ("rt" + topic).c_str(), nullptr, nullptr);
    const dds_entity_t reader = dds_create_reader(participant, made, qos, nullptr);
    dds_delete_qos(qos);
    if (reader < 0) {
        std::fprintf(stderr, "ros2_listener: %s: %s\n", topic.c_str(), dds_strretcode(reader));
        std::exit(1);
    }
    return reader;
}

// Of messages that begin with a header.
class Ages {
public:
    explicit Ages(size_t count)
        : left_(count) {}
    // False once there are enough.
    bool add(const void* message) {
        const auto& stamp = static_cast<const std_msgs_msg_dds__Header_*>(message)->stamp;
        const double now =
            std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count();
        ages_.push_back(1e3 * (now - stamp.sec - 1e-9 * stamp.nanosec));
        if (last_ > 0.0) {
            gaps_.push_back(1e3 * (now - last_));
        }
        last_ = now;
        return --left_ > 0;
    }
    void print() {
        printOne("age", ages_);
        printOne("gap", gaps_);
    }

private:
    static void printOne(const char* what, std::vector<double>& millis) {
        if (millis.empty()) {
            return;
        }
        std::sort(millis.begin(), millis.end());
        const auto at = [&](double share) {
            return millis[static_cast<size_t>(share * static_cast<double>(millis.size() - 1))];
        };
        std::printf("%s p50 %.2f p99 %.2f max %.2f ms of %zu\n", what, at(0.5), at(0.99), at(1.0),
                    millis.size());
    }

    size_t left_;
    double last_ = 0.0; // [s]
    std::vector<double> ages_, gaps_;
};

} // namespace

int main(int argc, char** argv) {
    if (argc < 4 || kTypes.count(argv[3]) == 0) {
        return 2;
    }
    const Type& type = kTypes.at(argv[3]);
    const dds_entity_t participant = joinLoopback(static_cast<dds_domainid_t>(std::atoi(argv[1])));
    const dds_entity_t reader = readerOf(participant, argv[2], type);
    Said().word("ready").print();
    const dds_entity_t waiting = dds_create_waitset(participant);
    dds_set_status_mask(reader, DDS_DATA_AVAILABLE_STATUS);
    dds_waitset_attach(waiting, reader, 0);
    Ages ages(argc > 4 ? static_cast<size_t>(std::max(2, std::atoi(argv[4]))) : 0);
    while (!inputEnded()) {
        dds_attach_t which = 0;
        dds_waitset_wait(waiting, &which, 1, DDS_MSECS(100));
        void* sample[1] = {};
        dds_sample_info_t info[1];
        while (dds_take(reader, sample, info, 1, 1) > 0) {
            if (info[0].valid_data && argc == 4) {
                type.print(sample[0]);
            } else if (info[0].valid_data && !ages.add(sample[0])) {
                ages.print();
                return 0;
            }
            dds_return_loan(reader, sample, 1);
        }
    }
    ages.print();
    return 0;
}
