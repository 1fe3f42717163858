// SPDX-License-Identifier: Apache-2.0
// A compute pass: its descriptor, and the pipeline and bindings built from it.
#pragma once

#include "engine/cloud/cloud_buffers.h"
#include "engine/gpu/pipeline.h"

#include "shaders/shared/frame_params.h"

#include <array>
#include <optional>
#include <variant>
#include <vector>

namespace fathom::cloud {

// A buffer that a pass binds: uploaded with the frame, shared between passes, or part of a fixture set.
struct PassBinding {
    using Of =
        std::variant<gpu::Buffer UploadBuffers::*, gpu::Buffer WorkBuffers::*, gpu::Buffer SetBuffers::*>;

    template <class Owner>
    PassBinding(gpu::Buffer Owner::*member, VkFormat texelFormat = VK_FORMAT_UNDEFINED)
        : of(member)
        , texels(texelFormat) {}

    Of of;
    VkFormat texels; // undefined: FrameParams is bound as a uniform buffer, all others as storage buffers
};

// Depth for the passes after classify.
PassBinding depthOf(const Plan& plan, VkFormat texels);
// Value of kSpecLens.
uint32_t lensModelOf(const Intrinsics& lens);

// Number of groups along x, y and z.
using Groups = std::array<uint32_t, 3>;
// The device reads the number of groups from FrameCounters, at this offset [bytes].
struct GroupsCounted {
    size_t offset;
};

// The barrier between this pass and the next one.
enum class After {
    Barrier,         // the next pass may read the results of this one
    IndirectBarrier, // the same; the next pass may also read its number of groups
    Nothing,         // the next pass is independent of this one
};

// Descriptor of a pass: what `Pass` builds and records.
struct PassInfo {
    const char* name; // consecutive passes of the same name are timed together
    std::span<const uint32_t> spirv;
    std::vector<PassBinding> bindings; // 0..n-1
    std::vector<gpu::Constant> constants;
    std::variant<Groups, GroupsCounted> groups;
    After after = After::Barrier;
    std::optional<shared::TreeParams> push = {};
    // Filled with `fill` before the dispatch, with a barrier.
    gpu::Buffer WorkBuffers::*filled = nullptr;
    uint32_t fill = 0;
};

// One thread. Objects that the context refers to must outlive the pass.
class Pass {
public:
    Pass(const CloudContext& context, PassInfo info);

    const PassInfo& info() const { return info_; }
    void bind(uint32_t upload, const UploadBuffers& buffers); // before record() with that upload slot
    void record(gpu::Commands& commands, uint32_t upload, uint32_t set) const;

private:
    CloudContext context_;
    PassInfo info_;
    gpu::Pipeline pipeline_;
    PerUpload<std::vector<gpu::Bindings>> bindings_; // per set
};

} // namespace fathom::cloud
