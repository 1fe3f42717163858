// SPDX-License-Identifier: Apache-2.0
// Cyclone DDS is loaded when the first graph is joined, so the program also starts without it.
#pragma once

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

namespace fathom {

// The functions of libddsc that are used, under their own names without dds_.
class DdsLibrary {
    class Symbol { // converts to the type of the function that it is
    public:
        explicit Symbol(void* address)
            : address_(address) {}
        template <class T>
        operator T*() const {
            return reinterpret_cast<T*>(address_);
        }

    private:
        void* address_;
    };
    static Symbol find(const char* name); // throws BadInput

public:
    const decltype(&::dds_create_domain) createDomain = find("dds_create_domain");
    const decltype(&::dds_create_participant) createParticipant = find("dds_create_participant");
    const decltype(&::dds_create_topic_sertype) createTopic = find("dds_create_topic_sertype");
    const decltype(&::dds_create_reader) createReader = find("dds_create_reader");
    const decltype(&::dds_create_writer) createWriter = find("dds_create_writer");
    const decltype(&::dds_create_waitset) createWaitset = find("dds_create_waitset");
    const decltype(&::dds_delete) destroy = find("dds_delete");
    const decltype(&::dds_strretcode) text = find("dds_strretcode");

    const decltype(&::dds_create_qos) createQos = find("dds_create_qos");
    const decltype(&::dds_delete_qos) deleteQos = find("dds_delete_qos");
    const decltype(&::dds_qset_reliability) setReliability = find("dds_qset_reliability");
    const decltype(&::dds_qset_durability) setDurability = find("dds_qset_durability");
    const decltype(&::dds_qset_history) setHistory = find("dds_qset_history");
    const decltype(&::dds_qset_data_representation) setRepresentation = find("dds_qset_data_representation");

    const decltype(&::dds_take) take = find("dds_take");
    const decltype(&::dds_takecdr) takeCdr = find("dds_takecdr");
    const decltype(&::dds_return_loan) returnLoan = find("dds_return_loan");
    const decltype(&::dds_writecdr) writeCdr = find("dds_writecdr");
    const decltype(&::dds_set_status_mask) setStatusMask = find("dds_set_status_mask");
    const decltype(&::dds_waitset_attach) attach = find("dds_waitset_attach");
    const decltype(&::dds_waitset_wait) wait = find("dds_waitset_wait");
    const decltype(&::dds_get_sample_lost_status) lostStatus = find("dds_get_sample_lost_status");
    const decltype(&::dds_get_publication_matched_status) publicationStatus =
        find("dds_get_publication_matched_status");
    const decltype(&::dds_get_subscription_matched_status) subscriptionStatus =
        find("dds_get_subscription_matched_status");

    const decltype(&::ddsi_serdata_init) initSample = find("ddsi_serdata_init");
    const decltype(&::ddsi_sertype_init_flags) initType = find("ddsi_sertype_init_flags");
    const decltype(&::ddsi_sertype_v0) typeVersion = find("ddsi_sertype_v0");
    const decltype(&::ddsi_sertype_fini) endType = find("ddsi_sertype_fini");
    const decltype(&::ddsi_sertype_unref) releaseType = find("ddsi_sertype_unref");
};

// Loads the library at the first call and keeps it. Any thread. Throws BadInput that names the package to
// install; never after it has returned once.
const DdsLibrary& dds();

} // namespace fathom
