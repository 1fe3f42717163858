// SPDX-License-Identifier: Apache-2.0
// A program of ROS 2 on another implementation of DDS, Fast DDS, with messages that are read and written here
// by Fast CDR. QoS as rmw's default.
//   ros2_fast DOMAIN TOPIC TYPE [say]
// Without "say" it prints each message as ros2_listener does; with it, it publishes lines as ros2_speaker
// does.
#include "tests/ros2_fast_peer/fast_messages.h"

#include <chrono>
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
#include <vector>

namespace fast = eprosima::fastdds::dds;
namespace rtps = eprosima::fastrtps::rtps;

namespace {

constexpr size_t kMostBytes = 4u << 20;

// A type whose samples are their own bytes.
class BytesType final : public fast::TopicDataType {
public:
    explicit BytesType(const std::string& name) {
        setName(name.c_str());
        m_typeSize = kMostBytes;
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

void hear(fast::DomainParticipant& participant, fast::Topic* topic, const Type& type) {
    fast::DataReader* reader = participant.create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT)
                                   ->create_datareader(topic, reliable<fast::DataReaderQos>());
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
                type.tell(cdr);
            }
        }
    }
}

void say(fast::DomainParticipant& participant, fast::Topic* topic, const Type& type) {
    fast::DataWriter* writer = participant.create_publisher(fast::PUBLISHER_QOS_DEFAULT)
                                   ->create_datawriter(topic, reliable<fast::DataWriterQos>());
    Said().word("ready").print();
    for (std::string line; std::getline(std::cin, line);) {
        Bytes bytes = messageOf(type, line);
        writer->write(&bytes);
        Said().word("ok").print();
    }
}

} // namespace

int main(int argc, char** argv) {
    if (argc < 4 || kTypes.count(argv[3]) == 0) {
        return 2;
    }
    const Type& type = kTypes.at(argv[3]);
    fast::DomainParticipant* participant = join(static_cast<uint32_t>(std::atoi(argv[1])));
    fast::TypeSupport(new BytesType(type.name)).register_type(participant);
    fast::Topic* topic =
        participant->create_topic("rt" + std::string(argv[2]), type.name, fast::TOPIC_QOS_DEFAULT);
    argc > 4 ? say(*participant, topic, type) : hear(*participant, topic, type);
    std::_Exit(0); // without the library's own cleaning, which waits
}
