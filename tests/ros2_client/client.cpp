// SPDX-License-Identifier: Apache-2.0
// A client of a service of ROS 2 for tests: a process of its own that calls it as rmw_cyclonedds does, with
// the code that idlc generated.
//   ros2_client DOMAIN SERVICE SetBool|Trigger
// It writes "ready" once the service is there. Each line of its standard input is a call (SetBool: 0 or 1),
// and is answered by a line "NUMBER SUCCESS MESSAGE". "short": a request that ends within its header,
// answered by "ok".
#include "messages.h"
#include "tests/ros2_listener/said.h"
#include "tests/ros2_talker/join_loopback.h"

#include <cstdlib>
#include <dds/dds.h>
#include <iostream>
#include <string>

namespace {

struct Type {
    const dds_topic_descriptor_t *request, *response;
};

dds_qos_t* rmwQos() {
    constexpr int kRmwDepth = 10;
    dds_qos_t* qos = dds_create_qos();
    dds_qset_reliability(qos, DDS_RELIABILITY_RELIABLE, DDS_MSECS(100));
    dds_qset_history(qos, DDS_HISTORY_KEEP_LAST, kRmwDepth);
    return qos;
}

// The two ends of a client.
struct Ends {
    dds_entity_t requests = 0, replies = 0;

    Ends(dds_entity_t participant, const std::string& service, const Type& type) {
        requests = writer(participant, service, *type.request);
        const dds_entity_t topic = dds_create_topic(participant, type.response,
                                                    ("rr" + service + "Reply").c_str(), nullptr, nullptr);
        dds_qos_t* qos = rmwQos();
        replies = dds_create_reader(participant, topic, qos, nullptr);
        dds_delete_qos(qos);
    }
    static dds_entity_t writer(dds_entity_t participant, const std::string& service,
                               const dds_topic_descriptor_t& type) {
        const dds_entity_t topic =
            dds_create_topic(participant, &type, ("rq" + service + "Request").c_str(), nullptr, nullptr);
        dds_qos_t* qos = rmwQos();
        const dds_entity_t made = dds_create_writer(participant, topic, qos, nullptr);
        dds_delete_qos(qos);
        return made;
    }
    bool matched() const {
        dds_publication_matched_status_t to{};
        dds_subscription_matched_status_t from{};
        dds_get_publication_matched_status(requests, &to);
        dds_get_subscription_matched_status(replies, &from);
        return to.current_count > 0 && from.current_count > 0;
    }
};

// Sends the request and returns its number.
int64_t ask(const Ends& ends, bool sets, const std::string& line) {
    static int64_t number = 0;
    dds_instance_handle_t client = 0;
    dds_get_instance_handle(ends.requests, &client);
    ++number;
    if (sets) {
        const std_srvs_srv_dds__SetBool_Request_ request{client, number, line == "1"};
        dds_write(ends.requests, &request);
    } else {
        const std_srvs_srv_dds__Trigger_Request_ request{client, number, 0};
        dds_write(ends.requests, &request);
    }
    return number;
}

// Replies of both types are alike. False: it is another client's, or answers another request.
bool isReply(const Ends& ends, int64_t number, const void* message) {
    const auto& reply = *static_cast<const std_srvs_srv_dds__SetBool_Response_*>(message);
    dds_instance_handle_t client = 0;
    dds_get_instance_handle(ends.requests, &client);
    if (reply.client != client || reply.number != number) {
        return false;
    }
    Said().number(static_cast<double>(number)).number(reply.success ? 1 : 0).word(reply.message).print();
    return true;
}

void await(const Ends& ends, int64_t number) {
    for (bool answered = false; !answered && !inputEnded(); dds_sleepfor(DDS_MSECS(1))) {
        void* sample[1] = {};
        dds_sample_info_t info[1];
        while (dds_take(ends.replies, sample, info, 1, 1) > 0) {
            answered = answered || (info[0].valid_data && isReply(ends, number, sample[0]));
            dds_return_loan(ends.replies, sample, 1);
        }
    }
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        return 2;
    }
    const bool sets = std::string(argv[3]) == "SetBool";
    const Type type =
        sets ? Type{&std_srvs_srv_dds__SetBool_Request__desc, &std_srvs_srv_dds__SetBool_Response__desc}
             : Type{&std_srvs_srv_dds__Trigger_Request__desc, &std_srvs_srv_dds__Trigger_Response__desc};
    const dds_entity_t participant = joinLoopback(static_cast<dds_domainid_t>(std::atoi(argv[1])));
    const Ends ends(participant, argv[2], type);
    while (!ends.matched() && !inputEnded()) {
        dds_sleepfor(DDS_MSECS(1));
    }
    Said().word("ready").print();
    const dds_topic_descriptor_t shorter = shortType(type.request->m_typename);
    for (std::string line; std::getline(std::cin, line);) {
        if (line == "short") {
            static const dds_entity_t kBroken = Ends::writer(participant, argv[2], shorter);
            const builtin_interfaces_msg_dds__Time_ few{1, 2};
            dds_write(kBroken, &few);
            Said().word("ok").print();
        } else {
            await(ends, ask(ends, sets, line));
        }
    }
    return 0;
}
