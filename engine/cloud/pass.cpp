// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/pass.h"

#include "shaders/shared/constants.h"

namespace fathom::cloud {

namespace {

gpu::BindingKind kindOf(const PassBinding& binding) {
    if (binding.texels != VK_FORMAT_UNDEFINED) {
        return {VK_DESCRIPTOR_TYPE_UNIFORM_TEXEL_BUFFER, binding.texels};
    }
    return binding.of == PassBinding::Of(&UploadBuffers::params) ? gpu::kUniform : gpu::kStorage;
}

gpu::PipelineInfo pipelineOf(const PassInfo& pass) {
    gpu::PipelineInfo info{pass.name, pass.spirv, {}, pass.constants, 0};
    for (const PassBinding& binding : pass.bindings) {
        info.bindings.push_back(kindOf(binding));
    }
    info.pushBytes = pass.push ? sizeof(*pass.push) : 0;
    return info;
}

// Finds the buffer that a binding names.
struct BufferIn {
    const UploadBuffers& upload;
    const WorkBuffers& work;
    const SetBuffers& set;

    const gpu::Buffer* operator()(gpu::Buffer UploadBuffers::*member) const { return &(upload.*member); }
    const gpu::Buffer* operator()(gpu::Buffer WorkBuffers::*member) const { return &(work.*member); }
    const gpu::Buffer* operator()(gpu::Buffer SetBuffers::*member) const { return &(set.*member); }
};

} // namespace

PassBinding depthOf(const Plan& plan, VkFormat texels) {
    return plan.keepDepth ? PassBinding(&WorkBuffers::depth, texels)
                          : PassBinding(&UploadBuffers::depth, texels);
}

uint32_t lensModelOf(const Intrinsics& lens) {
    if (!lens.distorted()) {
        return shared::kLensNone;
    }
    switch (lens.model) {
    case LensModel::Equidistant:
        return shared::kLensEquidistant;
    case LensModel::ScaledTangential:
        return shared::kLensScaledTangential;
    case LensModel::Polynomial:
        break;
    }
    return lens.divisor == std::array<double, 3>{} ? shared::kLensPlain : shared::kLensRational;
}

Pass::Pass(const CloudContext& context, PassInfo info)
    : context_(context)
    , info_(std::move(info))
    , pipeline_(context.device, pipelineOf(info_)) {}

void Pass::bind(uint32_t upload, const UploadBuffers& buffers) {
    bindings_[upload].clear();
    for (const SetBuffers* set : context_.sets) {
        std::vector<const gpu::Buffer*> bound;
        for (const PassBinding& binding : info_.bindings) {
            bound.push_back(std::visit(BufferIn{buffers, context_.work, *set}, binding.of));
        }
        bindings_[upload].emplace_back(context_.device, pipeline_, bound, context_.work.unused);
    }
}

void Pass::record(gpu::Commands& commands, uint32_t upload, uint32_t set) const {
    const gpu::Bindings& bindings = bindings_[upload][set];
    const void* push = info_.push ? &*info_.push : nullptr;
    if (info_.filled != nullptr) {
        commands.fill(context_.work.*info_.filled, info_.fill);
        commands.barrier();
    }
    if (const auto* groups = std::get_if<Groups>(&info_.groups)) {
        commands.dispatch(pipeline_, bindings, *groups, push);
    } else {
        commands.dispatchIndirect(pipeline_, bindings, context_.work.counters,
                                  std::get<GroupsCounted>(info_.groups).offset, push);
    }
}

} // namespace fathom::cloud
