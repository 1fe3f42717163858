// SPDX-License-Identifier: Apache-2.0
// Subscriptions and publications of ros2_graph.h.
#include "devices/ros2/dds_library.h"
#include "devices/ros2/raw_type.h"
#include "devices/ros2/ros2_graph.h"
#include "engine/types/error.h"

#include <array>

namespace fathom {

namespace {

using QosPtr = std::unique_ptr<dds_qos_t, void (*)(dds_qos_t*)>;

constexpr int32_t kSensorDepth = 8, kStreamDepth = 500, kReliableDepth = 10, kLatchedDepth = 100;

int32_t depthOf(Ros2Qos kind) {
    return kind == Ros2Qos::Sensor    ? kSensorDepth
           : kind == Ros2Qos::Stream  ? kStreamDepth
           : kind == Ros2Qos::Latched ? kLatchedDepth
                                      : kReliableDepth;
}

QosPtr qosOf(Ros2Qos kind) {
    QosPtr qos(dds().createQos(), dds().deleteQos);
    const bool lossy = kind == Ros2Qos::Sensor || kind == Ros2Qos::Stream, latched = kind == Ros2Qos::Latched;
    dds().setReliability(qos.get(), lossy ? DDS_RELIABILITY_BEST_EFFORT : DDS_RELIABILITY_RELIABLE,
                         DDS_MSECS(10));
    dds().setDurability(qos.get(), latched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
    dds().setHistory(qos.get(), DDS_HISTORY_KEEP_LAST, depthOf(kind));
    const dds_data_representation_id_t cdr = DDS_DATA_REPRESENTATION_XCDR1;
    dds().setRepresentation(qos.get(), 1, &cdr);
    return qos;
}

// "sensor_msgs/msg/Image" to "sensor_msgs::msg::dds_::Image_".
std::string ddsTypeName(const std::string& type) {
    const size_t first = type.find('/'), last = type.rfind('/');
    return type.substr(0, first) + "::" + type.substr(first + 1, last - first - 1) +
           "::dds_::" + type.substr(last + 1) + "_";
}

std::string ddsTopicName(const std::string& topic, Ros2Part part) {
    switch (part) {
    case Ros2Part::Request:
        return "rq" + topic + "Request";
    case Ros2Part::Reply:
        return "rr" + topic + "Reply";
    case Ros2Part::Topic:
        break;
    }
    return "rt" + topic;
}

void checkMade(dds_return_t made, const std::string& topic, const std::string& type) {
    if (made < 0) {
        throw Error("ros2:" + topic + " (" + type + "): " + dds().text(made));
    }
}

// A topic belongs to its reader or writer once those are made.
dds_entity_t makeTopic(const Ros2Graph& graph, const std::string& topic, Ros2Part part,
                       const std::string& type, ddsi_sertype*& raw) {
    raw = newRawType(ddsTypeName(type));
    ddsi_sertype* const own = raw;
    const dds_entity_t made = dds().createTopic(graph.participant(), ddsTopicName(topic, part).c_str(), &raw,
                                                nullptr, nullptr, nullptr);
    if (made < 0) {
        dds().releaseType(own);
    }
    checkMade(made, topic, type);
    return made;
}

} // namespace

Ros2Inbox::Ros2Inbox(std::shared_ptr<Ros2Graph> graph)
    : graph_(std::move(graph))
    , waiting_(dds().createWaitset(graph_->participant())) {
    checkMade(waiting_, "", "waitset");
}

Ros2Inbox::~Ros2Inbox() {
    dds().destroy(waiting_);
    for (const dds_entity_t reader : readers_) {
        dds().destroy(reader);
    }
}

size_t Ros2Inbox::subscribe(const std::string& topic, const std::string& type, Ros2Qos qos, Ros2Part part) {
    ddsi_sertype* raw = nullptr;
    const dds_entity_t made = makeTopic(*graph_, topic, part, type, raw);
    const dds_entity_t reader = dds().createReader(graph_->participant(), made, qosOf(qos).get(), nullptr);
    dds().destroy(made);
    checkMade(reader, topic, type);
    readers_.push_back(reader);
    dds().setStatusMask(reader, DDS_DATA_AVAILABLE_STATUS);
    checkMade(dds().attach(waiting_, reader, static_cast<dds_attach_t>(readers_.size())), topic, type);
    return readers_.size() - 1;
}

bool Ros2Inbox::wait(double seconds) {
    dds_attach_t which = 0;
    return dds().wait(waiting_, &which, 1, static_cast<dds_duration_t>(1e9 * seconds)) > 0;
}

std::vector<Ros2Message> Ros2Inbox::take(size_t topic) {
    std::array<ddsi_serdata*, 32> samples{};
    std::array<dds_sample_info_t, 32> infos;
    const dds_return_t count =
        dds().takeCdr(readers_[topic], samples.data(), samples.size(), infos.data(), DDS_ANY_STATE);
    std::vector<Ros2Message> taken;
    for (dds_return_t i = 0; i < count; ++i) {
        const std::shared_ptr<ddsi_serdata> sample(samples[i], ddsi_serdata_unref);
        const RawMessage* content = infos[i].valid_data ? rawContent(samples[i]) : nullptr;
        if (content != nullptr) {
            taken.push_back({RawMessagePtr(sample, content), infos[i].publication_handle});
        }
    }
    return taken;
}

uint64_t Ros2Inbox::lost(size_t topic) const {
    dds_sample_lost_status_t status{};
    return dds().lostStatus(readers_[topic], &status) == DDS_RETCODE_OK ? status.total_count : 0;
}

uint32_t Ros2Inbox::publishers(size_t topic) const {
    dds_subscription_matched_status_t status{};
    return dds().subscriptionStatus(readers_[topic], &status) == DDS_RETCODE_OK ? status.current_count : 0;
}

Ros2Writer::Ros2Writer(std::shared_ptr<Ros2Graph> graph, const std::string& topic, const std::string& type,
                       Ros2Qos qos, Ros2Part part)
    : graph_(std::move(graph)) {
    ddsi_sertype* raw = nullptr;
    const dds_entity_t made = makeTopic(*graph_, topic, part, type, raw);
    writer_ = dds().createWriter(graph_->participant(), made, qosOf(qos).get(), nullptr);
    dds().destroy(made);
    checkMade(writer_, topic, type);
    type_ = raw;
}

Ros2Writer::~Ros2Writer() {
    dds().destroy(writer_);
}

bool Ros2Writer::write(std::span<const uint8_t> message) noexcept {
    try {
        return dds().writeCdr(writer_, newRawSample(type_, message)) == DDS_RETCODE_OK;
    } catch (const std::bad_alloc&) {
        return false;
    }
}

uint32_t Ros2Writer::subscribers() const noexcept {
    dds_publication_matched_status_t status{};
    return dds().publicationStatus(writer_, &status) == DDS_RETCODE_OK ? status.current_count : 0;
}

} // namespace fathom
