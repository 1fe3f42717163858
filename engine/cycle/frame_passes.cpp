// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/frame_passes.h"

namespace fathom {

FramePasses::FramePasses(const cloud::CloudContext& c)
    : context_(c) {
    for (cloud::PassInfo& info : cloud::framePasses(c)) {
        if (names_.empty() || names_.back() != info.name) {
            names_.emplace_back(info.name);
        }
        passes_.emplace_back(c, std::move(info));
    }
    if (c.plan.delivers()) {
        deliver_ = std::make_unique<cloud::Pass>(c, cloud::deliverPass(c));
    }
    if (c.plan.passes) {
        names_.emplace_back("deliver");
    }
}

void FramePasses::bind(uint32_t upload, const cloud::UploadBuffers& buffers) {
    for (cloud::Pass& pass : passes_) {
        pass.bind(upload, buffers);
    }
    if (deliver_) {
        deliver_->bind(upload, buffers);
    }
    commands_[upload].clear();
    commands_[upload].resize(context_.sets.size());
    watches_[upload] =
        std::make_unique<gpu::Stopwatch>(context_.device, static_cast<uint32_t>(names_.size()) + 1);
}

const gpu::Commands& FramePasses::frame(uint32_t upload, uint32_t set) {
    std::unique_ptr<gpu::Commands>& commands = commands_[upload][set];
    if (commands) {
        watches_[upload]->resetForResubmit();
    } else {
        commands = std::make_unique<gpu::Commands>(context_.device);
        record(*commands, *watches_[upload], upload, set);
    }
    return *commands;
}

void FramePasses::record(gpu::Commands& commands, gpu::Stopwatch& watch, uint32_t upload,
                         uint32_t set) const {
    const bool timed = context_.plan.passTimes;
    commands.begin(gpu::Submissions::Many);
    watch.reset();
    if (timed) {
        watch.mark(commands.handle());
    }
    for (size_t i = 0; i < passes_.size(); ++i) {
        const cloud::PassInfo& info = passes_[i].info();
        passes_[i].record(commands, upload, set);
        if (info.after == cloud::After::IndirectBarrier) {
            commands.barrierBeforeIndirect();
        } else if (info.after == cloud::After::Barrier) {
            commands.barrier();
        }
        const bool last = i + 1 == passes_.size() || std::string(passes_[i + 1].info().name) != info.name;
        if (timed && last) {
            info.after == cloud::After::Nothing ? watch.markReached(commands.handle())
                                                : watch.mark(commands.handle());
        }
    }
    recordEnd(commands, upload, set);
    if (timed) {
        watch.mark(commands.handle());
    }
    commands.end();
}

void FramePasses::recordEnd(gpu::Commands& commands, uint32_t upload, uint32_t set) const {
    const cloud::WorkBuffers& work = context_.work;
    const cloud::SetBuffers& s = *context_.sets[set];
    const auto copy = [&](const gpu::Buffer& from, const gpu::Buffer& to) {
        if (from && to) {
            commands.copy(from, to, to.bytes());
        }
    };
    copy(work.points, s.points); // in addition to `deliver`
    copy(work.masks, s.masks);
    if (deliver_) {
        deliver_->record(commands, upload, set);
    } else {
        cloud::deliverByCopies(commands, work, s);
    }
}

} // namespace fathom
