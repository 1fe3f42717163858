// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/ros2_graph.h"

#include "devices/ros2/dds_library.h"
#include "engine/types/error.h"
#include "engine/types/joined.h"
#include "engine/types/printable.h"

#include <cstdlib>
#include <mutex>
#include <set>

namespace fathom {

namespace {

// Limits the size of messages. Cyclone's own default is 2 GiB.
std::string limits() {
    return "<Internal><MaxSampleSize>" + std::to_string(kMaxMessage) + "B</MaxSampleSize></Internal>";
}

// The user's own configuration, with our limits. Later parts override earlier ones.
std::string userConfiguration() {
    const char* given = std::getenv("CYCLONEDDS_URI");
    return (given != nullptr && *given != '\0' ? std::string(given) + "," : "") + "<CycloneDDS><Domain>" +
           limits() + "</Domain></CycloneDDS>";
}

// Multicast and unicast discovery, because rmw implementations that are confined to one machine use the one
// or the other. Data goes by unicast.
std::string configuration(const Ros2Place& place) {
    if (place.network == "any") {
        return userConfiguration();
    }
    std::string peers;
    if (place.network == "lo") {
        peers = "<Peers><Peer address=\"127.0.0.1\"/></Peers>";
    }
    return "<CycloneDDS><Domain><General><Interfaces><NetworkInterface name=\"" + place.network +
           "\" multicast=\"true\"/></Interfaces><AllowMulticast>spdp</AllowMulticast>"
           "<MaxMessageSize>65500B</MaxMessageSize></General>"
           "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
           "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>" +
           peers + "</Discovery>" + limits() +
           "<Internal><SocketReceiveBufferSize min=\"default\" max=\"16MB\"/></Internal>"
           "<Tracing><Verbosity>none</Verbosity></Tracing></Domain></CycloneDDS>";
}

std::string ros2TypeName(std::string name) { // "a::msg::dds_::B_" to "a/msg/B"
    for (const auto& [from, to] : {std::pair("::dds_::", "/"), std::pair("::", "/")}) {
        for (size_t at = name.find(from); at != std::string::npos; at = name.find(from)) {
            name.replace(at, std::string_view(from).size(), to);
        }
    }
    if (name.ends_with('_')) {
        name.pop_back();
    }
    return printable(name);
}

} // namespace

std::shared_ptr<Ros2Graph> Ros2Graph::join(const Ros2Place& place) {
    static std::mutex mutex;
    static std::weak_ptr<Ros2Graph> joined;
    const std::lock_guard lock(mutex);
    std::shared_ptr<Ros2Graph> graph = joined.lock();
    if (graph && graph->place_ != place) {
        throw BadInput("ros2", "domain, network", std::to_string(place.domain) + ", " + place.network,
                       "domain " + std::to_string(graph->place_.domain) + " and network " +
                           graph->place_.network + ", which this program uses already");
    }
    if (!graph) {
        graph.reset(new Ros2Graph(place));
        joined = graph;
    }
    return graph;
}

Ros2Graph::Ros2Graph(const Ros2Place& place)
    : place_(place) {
    domain_ = dds().createDomain(place.domain, configuration(place).c_str());
    participant_ = domain_ < 0 ? domain_ : dds().createParticipant(place.domain, nullptr, nullptr);
    if (participant_ < 0) {
        const std::string why = dds().text(participant_);
        dds().destroy(domain_);
        throw BadInput(
            "ros2", "network", place.network + " (" + why + ")",
            "a network interface of this machine that is up: lo, or as `ip link` lists them; or any");
    }
}

Ros2Graph::~Ros2Graph() {
    dds().destroy(participant_);
    dds().destroy(domain_);
}

std::string Ros2Graph::publications() const {
    std::set<std::string> names;
    const dds_entity_t reader =
        dds().createReader(participant_, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr);
    constexpr size_t kMaxSeen = 256;
    void* samples[kMaxSeen] = {};
    dds_sample_info_t infos[kMaxSeen];
    const dds_return_t count = reader < 0 ? 0 : dds().take(reader, samples, infos, kMaxSeen, kMaxSeen);
    for (dds_return_t i = 0; i < count; ++i) {
        const auto* seen = static_cast<const dds_builtintopic_endpoint_t*>(samples[i]);
        const std::string topic = infos[i].valid_data ? seen->topic_name : "";
        if (topic.starts_with("rt/")) {
            names.insert(printable(topic.substr(2)) + " (" + ros2TypeName(seen->type_name) + ")");
        }
    }
    if (count > 0) {
        dds().returnLoan(reader, samples, count);
    }
    if (reader > 0) {
        dds().destroy(reader);
    }
    return names.empty() ? "none" : joined(names);
}

} // namespace fathom
