// SPDX-License-Identifier: Apache-2.0
#include "devices/ros2/raw_type.h"

#include "devices/ros2/dds_library.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <dds/ddsi/q_radmin.h>
#include <new>

namespace fathom {

namespace {

struct RawSample : ddsi_serdata {
    RawMessage content;
};

double secondsOf(auto time) {
    return std::chrono::duration<double>(time.time_since_epoch()).count();
}

// Null when there is no memory, or too much is asked for: these functions are called by C code.
RawSample* newSample(const ddsi_sertype* type, ddsi_serdata_kind kind, size_t size) noexcept {
    if (size > kMaxMessage) {
        return nullptr;
    }
    auto* sample = new (std::nothrow) RawSample();
    if (sample == nullptr) {
        return nullptr;
    }
    dds().initSample(sample, type, kind);
    const size_t padded = (size + 3) / 4 * 4;
    sample->content.memory.reset(new (std::nothrow) uint8_t[padded]);
    if (!sample->content.memory) {
        delete sample;
        return nullptr;
    }
    std::fill(sample->content.memory.get() + size, sample->content.memory.get() + padded, uint8_t{0});
    sample->content.size = static_cast<uint32_t>(size);
    sample->content.arrival = secondsOf(std::chrono::steady_clock::now());
    sample->content.arrivalUtc = secondsOf(std::chrono::system_clock::now());
    return sample;
}

const RawSample* rawOf(const ddsi_serdata* sample) {
    return static_cast<const RawSample*>(sample);
}

// Fragments come in order and may overlap.
ddsi_serdata* fromFragments(const ddsi_sertype* type, ddsi_serdata_kind kind, const nn_rdata* chain,
                            size_t size) {
    RawSample* sample = newSample(type, kind, size);
    size_t filled = 0;
    for (; sample != nullptr && chain != nullptr; chain = chain->nextfrag) {
        const size_t end = std::min<size_t>(chain->maxp1, size);
        if (end <= filled || chain->min > filled) {
            continue;
        }
        const uint8_t* payload = NN_RMSG_PAYLOADOFF(chain->rmsg, NN_RDATA_PAYLOAD_OFF(chain));
        std::memcpy(sample->content.memory.get() + filled, payload + (filled - chain->min), end - filled);
        filled = end;
    }
    if (sample != nullptr && filled < size) {
        std::fill(sample->content.memory.get() + filled, sample->content.memory.get() + size, uint8_t{0});
    }
    return sample;
}

ddsi_serdata* fromPieces(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* pieces, size_t size) {
    RawSample* sample = newSample(type, kind, size);
    size_t filled = 0;
    for (ddsrt_msg_iovlen_t i = 0; sample != nullptr && i < count; ++i) {
        const size_t more = std::min<size_t>(pieces[i].iov_len, size - filled);
        std::memcpy(sample->content.memory.get() + filled, pieces[i].iov_base, more);
        filled += more;
    }
    return sample;
}

// ROS 2 topics have no keys: all samples are of one instance.
ddsi_serdata* withoutKey(const ddsi_sertype* type, const ddsi_keyhash*) {
    return newSample(type, SDK_KEY, 0);
}

ddsi_serdata* untyped(const ddsi_serdata* sample) {
    RawSample* key = newSample(sample->type, SDK_KEY, 0);
    if (key != nullptr) {
        key->type = nullptr;
    }
    return key;
}

ddsi_serdata* reference(const ddsi_serdata* sample, size_t offset, size_t size, ddsrt_iovec_t* piece) {
    piece->iov_base = rawOf(sample)->content.memory.get() + offset;
    piece->iov_len = size;
    return ddsi_serdata_ref(sample);
}

ddsi_serdata_ops sampleOperations() {
    ddsi_serdata_ops ops{};
    ops.eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; };
    ops.get_size = [](const ddsi_serdata* sample) { return rawOf(sample)->content.size; };
    ops.from_ser = fromFragments;
    ops.from_ser_iov = fromPieces;
    ops.from_keyhash = withoutKey;
    // Samples are bytes, so there is no other form of them.
    ops.from_sample = [](const ddsi_sertype*, ddsi_serdata_kind, const void*) -> ddsi_serdata* {
        return nullptr;
    };
    ops.to_sample = [](const ddsi_serdata*, void*, void**, void*) { return false; };
    ops.untyped_to_sample = [](const ddsi_sertype*, const ddsi_serdata*, void*, void**, void*) {
        return true;
    };
    ops.to_ser = [](const ddsi_serdata* sample, size_t offset, size_t size, void* to) {
        std::memcpy(to, rawOf(sample)->content.memory.get() + offset, size);
    };
    ops.to_ser_ref = reference;
    ops.to_ser_unref = [](ddsi_serdata* sample, const ddsrt_iovec_t*) { ddsi_serdata_unref(sample); };
    ops.to_untyped = untyped;
    ops.free = [](ddsi_serdata* sample) { delete static_cast<RawSample*>(sample); };
    ops.print = [](const ddsi_sertype*, const ddsi_serdata*, char* to, size_t size) -> size_t {
        if (size > 0) {
            *to = '\0';
        }
        return 0;
    };
    ops.get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* to, bool) { *to = {}; };
    return ops;
}

ddsi_sertype_ops typeOperations() {
    ddsi_sertype_ops ops{};
    ops.version = dds().typeVersion;
    ops.free = [](ddsi_sertype* type) {
        dds().endType(type);
        delete type;
    };
    ops.zero_samples = [](const ddsi_sertype*, void*, size_t) {};
    ops.realloc_samples = [](void**, const ddsi_sertype*, void*, size_t, size_t) {};
    ops.free_samples = [](const ddsi_sertype*, void**, size_t, dds_free_op_t) {};
    ops.equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; }; // the names are equal
    ops.hash = [](const ddsi_sertype*) { return uint32_t{0}; };
    ops.derive_sertype = [](const ddsi_sertype* type, dds_data_representation_id_t,
                            dds_type_consistency_enforcement_qospolicy_t) {
        return const_cast<ddsi_sertype*>(type);
    };
    return ops;
}

} // namespace

ddsi_sertype* newRawType(const std::string& name) {
    static const ddsi_serdata_ops kSamples = sampleOperations();
    static const ddsi_sertype_ops kTypes = typeOperations();
    auto* type = new ddsi_sertype{};
    dds().initType(type, name.c_str(), &kTypes, &kSamples, DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
    type->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
    return type;
}

const RawMessage* rawContent(const ddsi_serdata* sample) {
    return sample != nullptr && sample->kind == SDK_DATA ? &rawOf(sample)->content : nullptr;
}

ddsi_serdata* newRawSample(const ddsi_sertype* type, std::span<const uint8_t> bytes) {
    RawSample* sample = newSample(type, SDK_DATA, bytes.size());
    if (sample == nullptr) {
        throw std::bad_alloc();
    }
    std::copy(bytes.begin(), bytes.end(), sample->content.memory.get());
    return sample;
}

} // namespace fathom
