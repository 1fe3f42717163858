// SPDX-License-Identifier: Apache-2.0
// A program of ROS 2 on another implementation of DDS, Fast DDS, with messages that are read and written here
// by Fast CDR. QoS as rmw's default.
//   ros2_fast DOMAIN TOPIC TYPE [say|call]
// It prints each message as ros2_listener does. With "say" it publishes lines as ros2_speaker does, and with
// "call" it calls a service as ros2_client does; "rmw_fastrtps" is a request as that rmw would send it,
// answered by "ok".
#include "tests/ros2_fast_peer/fast_messages.h"

#include <cstdlib>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <iostream>
#include <memory>
#include <string>
#include <unistd.h>

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

namespace {

constexpr size_t kMaxBytes = 4u << 20;

// A type whose samples are their own bytes.
class BytesType final : public fast::TopicDataType {
public:
    explicit BytesType(const std::string& name) {
        setName(name.c_str());
        m_typeSize = kMaxBytes;
        auto_fill_type_object(false);
        auto_fill_type_information(false);
    }
    bool serialize(void* data, rtps::SerializedPayload_t* payload) override {
        const Bytes& bytes = *static_cast<Bytes*>(data);
        payload->encapsulation = CDR_LE;
        payload->length = static_cast<uint32_t>(bytes.size());
        std::copy(bytes.begin(), bytes.end(), reinterpret_cast<char*>(payload->data));
        return true;
    }
    bool deserialize(rtps::SerializedPayload_t* payload, void* data) override {
        const char* first = reinterpret_cast<const char*>(payload->data);
        static_cast<Bytes*>(data)->assign(first, first + payload->length);
        return true;
    }
    std::function<uint32_t()> getSerializedSizeProvider(void* data) override {
        return [data] { return static_cast<uint32_t>(static_cast<Bytes*>(data)->size()); };
    }
    void* createData() override { return new Bytes(); }
    void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
    bool getKey(void*, rtps::InstanceHandle_t*, bool) override { return false; }
};

// On loopback only.
fast::DomainParticipant* join(uint32_t domain) {
    constexpr int kParticipants = 20; // of the domain that may be there already
    fast::DomainParticipantQos qos;
    auto loopback = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    loopback->interfaceWhiteList.push_back("127.0.0.1");
    qos.transport().use_builtin_transports = false;
    qos.transport().user_transports.push_back(loopback);
    for (int i = 0; i < kParticipants; ++i) {
        rtps::Locator_t locator;
        rtps::IPLocator::setIPv4(locator, "127.0.0.1");
        locator.port = 7400 + 250 * domain + 10 + 2 * static_cast<uint32_t>(i); // by the RTPS specification
        qos.wire_protocol().builtin.initialPeersList.push_back(locator);
    }
    return fast::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
}

template <class Qos>
Qos reliable() {
    Qos qos;
    qos.reliability().kind = fast::RELIABLE_RELIABILITY_QOS;
    qos.history().depth = 10;
    qos.endpoint().history_memory_policy = rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    return qos;
}

fast::Topic* topicOf(fast::DomainParticipant& participant, const std::string& name, const std::string& type) {
    fast::TypeSupport(new BytesType(type)).register_type(&participant);
    return participant.create_topic(name, type, fast::TOPIC_QOS_DEFAULT);
}

fast::DataReader* readerOf(fast::DomainParticipant& participant, fast::Topic* topic) {
    return participant.create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT)
        ->create_datareader(topic, reliable<fast::DataReaderQos>());
}

fast::DataWriter* writerOf(fast::DomainParticipant& participant, fast::Topic* topic) {
    return participant.create_publisher(fast::PUBLISHER_QOS_DEFAULT)
        ->create_datawriter(topic, reliable<fast::DataWriterQos>());
}

void hear(fast::DomainParticipant& participant, fast::Topic* topic, const Type& type) {
    fast::DataReader* reader = readerOf(participant, topic);
    Said().word("ready").print();
    Bytes bytes;
    fast::SampleInfo info;
    while (!inputEnded()) {
        reader->wait_for_unread_message(eprosima::fastrtps::Duration_t(0, 100'000'000));
        while (reader->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
            if (info.valid_data) {
                FastBuffer buffer(bytes.data(), bytes.size());
                Cdr cdr(buffer, Cdr::DEFAULT_ENDIAN, Cdr::DDS_CDR);
                cdr.read_encapsulation();
                type.print(cdr);
            }
        }
    }
}

void say(fast::DomainParticipant& participant, fast::Topic* topic, const Type& type) {
    fast::DataWriter* writer = writerOf(participant, topic);
    Said().word("ready").print();
    for (std::string line; std::getline(std::cin, line);) {
        Bytes bytes = messageOf(type, line);
        writer->write(&bytes);
        Said().word("ok").print();
    }
}

void await(fast::DataReader& replies, uint64_t client, int64_t number) {
    Bytes bytes;
    fast::SampleInfo info;
    for (bool answered = false; !answered && !inputEnded();) {
        replies.wait_for_unread_message(eprosima::fastrtps::Duration_t(0, 100'000'000));
        while (replies.take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK) {
            answered = answered || (info.valid_data && printReply(bytes, client, number));
        }
    }
}

void call(fast::DomainParticipant& participant, const std::string& service, const Type& type) {
    const std::string name = type.name;
    fast::DataWriter* requests =
        writerOf(participant, topicOf(participant, "rq" + service + "Request", name + "Request_"));
    fast::DataReader* replies =
        readerOf(participant, topicOf(participant, "rr" + service + "Reply", name + "Response_"));
    fast::PublicationMatchedStatus to;
    fast::SubscriptionMatchedStatus from;
    for (; (to.current_count == 0 || from.current_count == 0) && !inputEnded(); ::usleep(1000)) {
        requests->get_publication_matched_status(to);
        replies->get_subscription_matched_status(from);
    }
    Said().word("ready").print();
    const auto client = static_cast<uint64_t>(::getpid()) << 32;
    int64_t number = 0;
    for (std::string line; std::getline(std::cin, line);) {
        Bytes bytes = requestOf(line, client, ++number);
        requests->write(&bytes);
        line == "rmw_fastrtps" ? Said().word("ok").print() : await(*replies, client, number);
    }
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 4 || kTypes.count(argv[3]) == 0) {
        return 2;
    }
    const Type& type = kTypes.at(argv[3]);
    fast::DomainParticipant* participant = join(static_cast<uint32_t>(std::atoi(argv[1])));
    const std::string name = argv[2], mode = argc > 4 ? argv[4] : "";
    if (mode == "call") {
        call(*participant, name, type);
    } else {
        fast::Topic* topic = topicOf(*participant, "rt" + name, type.name);
        mode == "say" ? say(*participant, topic, type) : hear(*participant, topic, type);
    }
    std::_Exit(0); // without the library's own cleaning, which waits
}
