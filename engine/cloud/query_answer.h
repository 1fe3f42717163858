// SPDX-License-Identifier: Apache-2.0
// The answer of a contact query: device memory that the query fills, and the host's copy of it.
#pragma once

#include "engine/gpu/buffer.h"
#include "engine/gpu/commands.h"
#include "shaders/shared/query_params.h"

#include <span>

namespace fathom::cloud {

// Whether the leaves that the spheres list are exactly those of the answer. The device counts in 32 bits: a
// set with more pairs than that gives numbers that do not agree.
bool agree(std::span<const shared::FoundSphere> spheres, uint64_t leaves) noexcept;

// One thread. The answer is a header with two counts, then spheres, then leaves.
class QueryAnswer {
public:
    // Number of spheres and of leaves.
    struct Counts {
        uint32_t spheres = 0, leaves = 0;
        bool fits(const Counts& capacity) const {
            return spheres <= capacity.spheres && leaves <= capacity.leaves;
        }
    };

    QueryAnswer(const gpu::Device& device, const Counts& capacity);

    const gpu::Buffer& buffer() const { return answer_; }
    const Counts& capacity() const { return capacity_; }
    bool isNew() const { return isNew_; }
    // Makes room for an answer. False when the device's buffers cannot hold it. The buffer is a new one.
    bool growTo(const Counts& count);

    void clear(gpu::Commands& commands); // a new buffer, before its first query
    // Sets the parameters that say where the query writes.
    void setOutputRange(shared::QueryParams& params) const;

    // Copies to the host a little more than the last answer had, so that one copy usually suffices.
    void copy(gpu::Commands& commands);
    // After that copy: what the query found, which may exceed capacity(). found(): the last result.
    Counts read();
    const Counts& found() const { return last_; }
    bool isComplete() const { return last_.fits(copied_); }
    void copyAll(gpu::Commands& commands); // when it is not

    // The host's copy.
    std::span<const shared::FoundSphere> spheres() const;
    std::span<const uint32_t> buckets() const; // of the leaves

private:
    uint64_t leafOffset() const;
    void copyPart(gpu::Commands& commands, const Counts& part);

    const gpu::Device& device_;
    gpu::Buffer answer_, back_;
    Counts capacity_, copied_, last_;
    Counts used_; // found since the buffer is new, modulo 2^32
    bool isNew_ = false;
};

} // namespace fathom::cloud
