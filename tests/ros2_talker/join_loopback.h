// SPDX-License-Identifier: Apache-2.0
// Where the test's own programs of Cyclone DDS meet the program under test.
#pragma once

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
