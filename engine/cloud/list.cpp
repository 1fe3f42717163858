// SPDX-License-Identifier: Apache-2.0
#include "engine/cloud/list.h"

#include "shaders/list.h"

namespace fathom::cloud {

ListPass::ListPass(const CloudContext& c)
    : context_(c)
    , pipeline_(c.device, {"list", list_spv, 5, true, 0,
                           std::array{c.plan.subGroup, uint32_t{c.plan.hold}, uint32_t{c.plan.moments},
                                      c.plan.subGroup}}) {}

void ListPass::bind(uint32_t upload, const UploadBuffers& up) {
    const WorkBuffers& w = context_.work;
    bindings_[upload] = gpu::Bindings(context_.device, pipeline_,
                                      {&up.params, &w.listed, &w.live, &w.list, &w.counters}, w.unused);
}

void ListPass::record(gpu::Commands& commands, uint32_t upload) const {
    const uint32_t group = context_.plan.subGroup;
    commands.dispatch(pipeline_, bindings_[upload], {(context_.layout.patches() + group - 1) / group, 1, 1});
}

} // namespace fathom::cloud
