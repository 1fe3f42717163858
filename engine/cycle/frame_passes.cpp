// SPDX-License-Identifier: Apache-2.0
#include "engine/cycle/frame_passes.h"

#include "shaders/shared/frame_params.h"

namespace fathom {

FramePasses::FramePasses(const cloud::CloudContext& c)
    : work_(c.work)
    , sets_(c.sets)
    , device_(c.device)
    , timed_(c.plan.passTimes) {
    const auto add = [&](bool in, auto& pass, const char* name) {
        if (in) {
            pass.emplace(c);
            names_.push_back(name);
        }
    };
    add(c.plan.occlusion, occlusion_, "occlusion");
    add(c.plan.cloud, classify_, "classify");
    add(c.plan.lists(), list_, "list");
    add(c.plan.cloud, surface_, "surface");
    add(c.plan.thins(), thin_, "thin");
    add(c.plan.moments, moments_, "moments");
    add(c.plan.spheres, spheres_, "spheres");
    add(c.plan.tree, tree_, "tree");
    add(c.plan.cloud, deliver_, "deliver");
}

void FramePasses::bind(uint32_t upload, const cloud::UploadBuffers& buffers) {
    const auto in = [&](auto& pass) {
        if (pass) {
            pass->bind(upload, buffers);
        }
    };
    in(occlusion_), in(classify_), in(list_), in(surface_), in(thin_), in(moments_), in(spheres_);
    commands_[upload].clear();
    commands_[upload].resize(sets_.size());
    watches_[upload] = std::make_unique<gpu::Stopwatch>(device_, static_cast<uint32_t>(names_.size()) + 1);
}

const gpu::Commands& FramePasses::frame(uint32_t upload, uint32_t set) {
    std::unique_ptr<gpu::Commands>& commands = commands_[upload][set];
    if (commands) {
        watches_[upload]->again();
    } else {
        commands = std::make_unique<gpu::Commands>(device_);
        record(*commands, *watches_[upload], upload, set);
    }
    return *commands;
}

void FramePasses::record(gpu::Commands& commands, gpu::Stopwatch& watch, uint32_t upload,
                         uint32_t set) const {
    const auto mark = [&] {
        if (timed_) {
            watch.mark(commands.handle());
        }
    };
    commands.begin(gpu::Submissions::Many);
    watch.reset();
    mark();
    const auto run = [&](const auto& pass, auto... arguments) {
        if (pass) {
            pass->record(commands, arguments...);
            commands.barrier();
            mark();
        }
    };
    const auto runListing = [&](const auto& pass) { // what comes next is dispatched over its lists
        pass->record(commands, upload);
        commands.barrierBeforeIndirect();
        mark();
    };
    run(occlusion_, upload);
    if (list_) {
        run(classify_, upload);
        runListing(list_);
    } else {
        runListing(classify_);
    }
    run(surface_, upload);
    run(thin_, upload);
    if (moments_ && spheres_) { // neither reads what the other writes: they overlap
        moments_->record(commands, upload, set);
        if (timed_) {
            watch.markReached(commands.handle());
        }
    } else {
        run(moments_, upload, set);
    }
    run(spheres_, upload, set);
    run(tree_, set);
    recordCopies(commands, set); // beside what comes last
    deliver_->record(commands, set);
    mark();
    commands.end();
}

void FramePasses::recordCopies(gpu::Commands& commands, uint32_t set) const {
    const cloud::SetBuffers& s = *sets_[set];
    const auto copy = [&](const gpu::Buffer& from, const gpu::Buffer& to) {
        if (from && to) {
            commands.copy(from, to, to.bytes());
        }
    };
    copy(work_.points, s.points);
    copy(work_.masks, s.masks);
}

} // namespace fathom
