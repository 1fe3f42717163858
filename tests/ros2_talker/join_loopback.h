// SPDX-License-Identifier: Apache-2.0
// What the test's own programs of Cyclone DDS share.
#pragma once

#include "messages.h"

#include <dds/dds.h>

// The participant of this process, on loopback only and without multicast.
inline dds_entity_t joinLoopback(dds_domainid_t domain) {
    dds_create_domain(
        domain, "<General><Interfaces><NetworkInterface name=\"lo\" multicast=\"false\"/></Interfaces>"
                "</General><Discovery><ParticipantIndex>auto</ParticipantIndex><MaxAutoParticipantIndex>32"
                "</MaxAutoParticipantIndex><Peers><Peer "
                "address=\"127.0.0.1\"/></Peers></Discovery><Tracing><Verbosity>none</Verbosity></Tracing>");
    return dds_create_participant(domain, nullptr, nullptr);
}

// Another type of few bytes under the name of a message: its bytes end within the header.
inline dds_topic_descriptor_t shortType(const char* name) {
    const dds_topic_descriptor_t& time = builtin_interfaces_msg_dds__Time__desc;
    return {time.m_size, time.m_align, DDS_TOPIC_FIXED_SIZE,
            0,           name,         nullptr,
            time.m_nops, time.m_ops,   "",
            {},          {},           0};
}
